"""``hemma compare``, and the table over homes that the results end with."""

import json

import pytest
from synthetic_results import save_results, write_results

from hemma import report

METHODS = ("HA-1", "Rule", "optimum")


@pytest.fixture
def folders(tmp_path):
    for name, seeds in (("before", 3), ("after", 2)):
        (tmp_path / name).mkdir()
        content = write_results(tmp_path / name, ("home-1", "home-2"), seeds, METHODS)
    content["homes"]["home-2"]["traces_sha256"] = "cd" * 32
    save_results(tmp_path / "after", content)
    return tmp_path / "before", tmp_path / "after"


def test_tables_for_people(hemma, folders):
    status, out, err = hemma("compare", *folders)
    assert (status, err) == (0, "")
    assert f"B  {folders[1]}" in out
    assert "[0, 1, 2]" in out
    said = " ".join(out.split())
    for text in ("home-1", "different traces", "only ratios can be compared", "Better than A", "HA-1"):
        assert text in said


def test_json_for_programs(hemma, folders):
    status, out, err = hemma("compare", *folders, "--json")
    assert (status, err) == (0, "")
    assert json.loads(out)["folders"] == [str(folder) for folder in folders]


def test_a_file_beside(hemma, folders, tmp_path):
    status, out, _ = hemma("compare", *folders, "--out", tmp_path / "c.html")
    assert status == 0
    assert f"Comparison: {tmp_path / 'c.html'}" in out
    assert (tmp_path / "c.html").read_text().startswith("<!DOCTYPE html>")


@pytest.mark.parametrize(
    ("words", "part"),
    [
        (["before"], "at least two results folders"),
        (["before", "nowhere"], "nowhere: expected a results folder"),
        (["before", "after", "--out", "c.pdf"], "ends in .html, .csv, .json, got .pdf"),
        (["before", "after", "--out", "before/results.json/c.csv"], "results.json"),
    ],
)
def test_mistakes(hemma, folders, tmp_path, monkeypatch, words, part):
    monkeypatch.chdir(tmp_path)
    status, out, err = hemma("compare", *words)
    assert (status, out) == (2, "")
    assert part in err.replace("\n", " ")
    assert "Traceback" not in err


def test_the_results_of_several_homes_end_with_a_table_over_all(hemma, folders, monkeypatch):
    """Printed by every command that shows results; here `hemma report`, its figures left out."""
    monkeypatch.setattr(report, "write_report", lambda folder, week: folder / "report.html")
    status, out, _ = hemma("report", folders[0])
    assert status == 0
    place = [out.index(text) for text in ("home-1: mean", "home-2: mean", "All 2 homes: mean")]
    assert place == sorted(place)
    assert "Worst run" in out
