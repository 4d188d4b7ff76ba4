"""Results folders side by side: differences by hand, and nothing is compared that cannot be."""

import csv
import json
import math
import re

import pytest
from synthetic_results import save_results, write_results

from hemma.errors import HemmaError
from hemma.report.comparison.compare import compare
from hemma.report.comparison.files import comparison_document, write_comparison
from hemma.report.comparison.page import comparison_page
from hemma.results.results import load_results

HOMES = ("home-1", "home-2")
METHODS = ("HA-1", "Rule", "optimum")


@pytest.fixture
def two(tmp_path):
    """Two folders; in the second HA-1 costs 2 less in every run and has one seed less."""
    folders = tmp_path / "before", tmp_path / "after"
    for folder, seeds in zip(folders, (3, 2), strict=True):
        folder.mkdir()
        content = write_results(folder, HOMES, seeds, METHODS)
    for home in content["homes"].values():
        cheaper(home["methods"]["HA-1"], 2.0)
    save_results(folders[1], content)
    return *folders, content


def cheaper(method, amount):
    for run in method["runs"]:
        run["energy_cost"] -= amount
        run["regret"] -= amount
    method["mean"]["energy_cost"] -= amount
    method["mean"]["share_of_savings"] += 0.25


def found(comparison, home, method):
    by_folder = comparison.homes[home].methods[method]
    return [by_folder.get(folder) for folder in comparison.folders]


def test_differences_are_those_of_the_files(two):
    before, after, _ = two
    comparison = compare([before, after])
    first, second = found(comparison, "home-1", "HA-1")
    one, other = (load_results(folder).homes["home-1"].methods["HA-1"] for folder in (before, after))
    assert (first.runs, second.runs, first.difference) == (3, 2, None)
    assert first.mean == one.mean
    assert second.interval == other.interval
    difference = second.difference
    assert difference.energy_cost == pytest.approx(other.mean.energy_cost - one.mean.energy_cost)
    assert difference.share_of_savings == pytest.approx(
        other.mean.share_of_savings - one.mean.share_of_savings
    )
    assert difference.gap_to_optimum == pytest.approx(other.mean.gap_to_optimum - one.mean.gap_to_optimum)
    assert difference.mean_temperature_deviation == pytest.approx(
        other.mean.mean_temperature_deviation - one.mean.mean_temperature_deviation
    )


def test_improvement_is_that_of_the_second_folder_over_the_first(two):
    before, after, _ = two
    cheaper_one = found(compare([before, after]), "home-1", "HA-1")[1].improvement
    assert cheaper_one.probability == 1.0
    assert 0.3 < cheaper_one.interval[0] < 1.0
    dearer_one = found(compare([after, before]), "home-1", "HA-1")[1].improvement
    assert dearer_one.probability == 0.0
    rule = found(compare([before, after]), "home-1", "Rule")[1].improvement
    assert (rule.probability, rule.interval) == (0.5, None)


def test_over_homes_by_hand(two):
    before, after, content = two
    content["homes"]["home-2"]["methods"]["HA-1"]["mean"]["share_of_savings"] += 0.1
    save_results(after, content)
    comparison = compare([before, after])
    by_home = [found(comparison, home, "HA-1")[1].difference.share_of_savings for home in HOMES]
    [over] = [one for one in comparison.over_homes if one.method == "HA-1"]
    assert over.homes == HOMES
    assert over.share_of_savings.difference == pytest.approx(sum(by_home) / 2)
    half = 12.7062 * abs(by_home[1] - by_home[0]) / 2
    assert over.share_of_savings.interval[1] == pytest.approx(sum(by_home) / 2 + half, abs=1e-5)
    assert over.improvement.probability == 1.0


def test_what_differs_is_named(two):
    before, after, content = two
    content["settings"] |= {"airl": {"rounds": 99, "discount": 0.99}, "extra": 3}
    save_results(after, content | {"code": "ab" * 32, "hemma": "0.2.0"})
    rows = {row.key: row.values for row in compare([before, after]).disagreements}
    assert rows == {
        "hemma": ("0.1.0", "0.2.0"),
        "code": (None, "ab" * 6),
        "seeds": ([0, 1, 2], [0, 1]),
        "airl.rounds": (1800, 99),
        "extra": (None, 3),
    }


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"traces_sha256": "cd" * 32}, r"different traces \(SHA-256 abababababab and cdcdcdcdcdcd\)"),
        ({"traces_sha256": ""}, "do not both say on which traces"),
        ({"test": {"start": "2021-08-15T00:00:00-06:00", "slots": 384}}, "different test periods"),
        ({"currency": "SEK"}, "different currencies"),
    ],
)
def test_on_other_data_only_ratios_are_compared(two, change, reason):
    before, after, content = two
    content["homes"]["home-1"] |= change
    save_results(after, content)
    comparison = compare([before, after])
    [note] = comparison.homes["home-1"].notes
    assert note.endswith("only ratios can be compared")
    assert re.search(reason, note)
    second = found(comparison, "home-1", "HA-1")[1]
    difference = second.difference
    assert difference.share_of_savings is not None
    assert difference.gap_to_optimum is not None
    assert difference.energy_cost is difference.mean_temperature_deviation is second.improvement is None
    assert comparison.homes["home-2"].notes == ()
    assert found(comparison, "home-2", "HA-1")[1].difference.energy_cost is not None
    assert all(one.improvement is None for one in comparison.over_homes)


def test_homes_and_methods_that_some_folders_lack(two, tmp_path):
    before, after, content = two
    del content["homes"]["home-2"]
    del content["homes"]["home-1"]["methods"]["Rule"]
    content["homes"]["home-3"] = content["homes"]["home-1"]
    save_results(after, content)
    third = tmp_path / "third"
    third.mkdir()
    write_results(third, HOMES[1:], 2, METHODS)
    comparison = compare([before, after, third])
    assert list(comparison.homes) == list(HOMES)
    assert found(comparison, "home-1", "Rule")[1] is None
    assert [one is None for one in found(comparison, "home-2", "HA-1")] == [False, True, False]
    assert comparison.over_homes == ()
    assert f"home-1 has no results in {third}" in comparison.notes
    assert f"home-3 has no results in {before}, {third}" in comparison.notes


def test_a_missing_metric_has_no_difference(two):
    before, after, content = two
    method = content["homes"]["home-1"]["methods"]["HA-1"]
    method["mean"]["gap_to_optimum"] = None
    method["runs"][0]["regret"] = None
    save_results(after, content)
    second = found(compare([before, after]), "home-1", "HA-1")[1]
    assert second.difference.gap_to_optimum is second.improvement.probability is None


def test_what_cannot_be_compared_is_refused(two, tmp_path):
    before, after, content = two
    with pytest.raises(HemmaError, match=r"at least two results folders to compare, got 1\."):
        compare([before])
    with pytest.raises(HemmaError, match="before twice"):
        compare([before, before / ".." / "before"])
    with pytest.raises(HemmaError, match=r"nowhere: expected a results folder .* no such folder"):
        compare([before, tmp_path / "nowhere"])
    (tmp_path / "empty").mkdir()
    with pytest.raises(HemmaError, match=r"empty.results\.json: .* no such file"):
        compare([before, tmp_path / "empty"])
    content["homes"] = {"another": content["homes"]["home-1"]}
    save_results(after, content)
    with pytest.raises(HemmaError, match=r"in common .*before has home-1, home-2; .*after has another"):
        compare([before, after])


def test_a_results_file_stands_for_its_folder(two):
    before, after, _ = two
    assert compare([before / "results.json", after]) == compare([before, after])


def test_the_json_says_everything(two, tmp_path):
    before, after, _ = two
    comparison = compare([before, after])
    write_comparison(tmp_path / "c.json", comparison)
    content = json.loads((tmp_path / "c.json").read_text())
    assert content == comparison_document(comparison)
    entry = content["homes"]["home-1"]["methods"]["HA-1"][str(after)]
    assert entry["runs"] == 2
    assert entry["difference"]["energy_cost"] < -1
    assert entry["probability_of_improvement"]["probability"] == 1.0
    assert content["homes"]["home-1"]["methods"]["HA-1"][str(before)]["difference"] is None
    assert content["disagreements"] == [{"key": "seeds", "values": [[0, 1, 2], [0, 1]]}]
    assert [one["method"] for one in content["over_homes"]] == list(METHODS)


def test_the_csv_has_a_row_for_each_method_and_folder(two, tmp_path):
    before, after, _ = two
    comparison = compare([before, after])
    write_comparison(tmp_path / "c.csv", comparison)
    with (tmp_path / "c.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(HOMES) * len(METHODS) * 2
    [row] = [r for r in rows if (r["home"], r["method"], r["folder"]) == ("home-2", "HA-1", str(after))]
    second = found(comparison, "home-2", "HA-1")[1]
    assert float(row["energy_cost"]) == second.mean.energy_cost
    assert float(row["energy_cost_difference"]) == second.difference.energy_cost
    assert math.isclose(float(row["share_of_savings_high"]), second.interval.share_of_savings[1])
    assert float(row["probability_low"]) == second.improvement.interval[0]
    assert rows[0]["energy_cost_difference"] == ""


def test_the_page_stands_alone(two, tmp_path):
    before, after, content = two
    content["homes"]["home-1"]["methods"] = {
        "<b>": content["homes"]["home-1"]["methods"]["HA-1"],
        **content["homes"]["home-1"]["methods"],
    }
    save_results(after, content)
    comparison = compare([before, after])
    write_comparison(tmp_path / "c.html", comparison)
    html = (tmp_path / "c.html").read_text()
    assert html == comparison_page(comparison)
    assert "&lt;b&gt;" in html
    assert "<b>" not in html
    assert not re.search("https?:", html)
    for text in ("home-2", "All homes", "Better than A", str(before)):
        assert text in html


def test_another_ending_is_refused(two, tmp_path):
    before, after, _ = two
    with pytest.raises(HemmaError, match=r"c\.pdf: expected a file name that ends in \.html, \.csv, \.json"):
        write_comparison(tmp_path / "c.pdf", compare([before, after]))
