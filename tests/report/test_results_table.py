"""The table says what results.json says, and a dash where there is nothing to say."""

import json

import pytest
from synthetic_results import save_results

from hemma.errors import HemmaError
from hemma.report import results_table


def _dollars(value: float) -> str:
    return f"${value:.2f}"


def test_every_mean_and_interval_is_that_of_results_json(written):
    methods = written.content["homes"]["austin2021-1"]["methods"]
    rows = {row.method: row for row in results_table(written.folder)}
    assert set(rows) == set(methods)
    for name, method in methods.items():
        row, mean, interval = rows[name], method["mean"], method["interval"]
        assert row.measures["Energy cost"].value == _dollars(mean["energy_cost"])
        assert row.measures["Trading X1"].value == _dollars(mean["transaction_cost"])
        assert row.measures["Battery X2"].value == _dollars(mean["battery_cost"])
        if mean["gap_to_optimum"] is not None:
            assert row.measures["Gap to optimum"].value == f"{100 * mean['gap_to_optimum']:.1f}\u00a0%"
        share = f"{100 * mean['share_of_savings']:.1f}\u00a0%".replace("-", "−")
        assert row.measures["Share of savings"].value == share
        deviation = mean["mean_temperature_deviation"]
        told = "0" if deviation == 0 else f"{deviation:.4f}"
        assert row.measures["Mean deviation"].value == f"{told}\u00a0°C"
        if interval["energy_cost"] is not None:
            low, high = interval["energy_cost"]
            assert row.measures["Energy cost"].detail == f"[{low:.2f}, {high:.2f}]"
            low, high = interval["share_of_savings"]
            assert row.measures["Share of savings"].detail == f"[{100 * low:.1f}, {100 * high:.1f}]"


def test_every_row_has_a_cell_for_every_heading(written):
    first, *others = results_table(written.folder)
    assert all(list(row.measures) == list(first.measures) for row in others)


def test_deterministic_methods_have_no_seed_no_interval_and_no_worst_seed(written):
    (row,) = [row for row in results_table(written.folder) if row.method == "Rule"]
    assert {row.measures[name].value for name in ("Seeds", "Worst seed", "Training time")} == {"–"}
    assert all(cell.detail == "" for cell in row.measures.values())


def test_the_worst_seed_is_the_farthest_from_the_optimum_and_not_the_dearest(small):
    folder, content = small
    method = content["homes"]["home"]["methods"]["HA-1"]
    del method["worst_seed"]
    method["runs"][0] |= {"energy_cost": 20.0, "gap_to_optimum": 0.9}
    method["runs"][1] |= {"energy_cost": 30.0, "gap_to_optimum": 0.1}
    save_results(folder, content)
    assert str(results_table(folder)[0].measures["Worst seed"]) == "$20.00 (gap 90.0\u00a0%)"


def test_the_worst_seed_that_the_folder_names_is_believed(small):
    folder, content = small
    method = content["homes"]["home"]["methods"]["HA-1"]
    method["worst_seed"] = 1
    method["runs"][0] |= {"energy_cost": 20.0, "gap_to_optimum": 0.9}
    method["runs"][1] |= {"energy_cost": 30.0, "gap_to_optimum": 0.1}
    save_results(folder, content)
    assert str(results_table(folder)[0].measures["Worst seed"]) == "$30.00 (gap 10.0\u00a0%)"


def test_the_interquartile_mean_stands_with_its_share_and_is_a_dash_in_older_folders(small):
    folder, content = small
    method = content["homes"]["home"]["methods"]["HA-1"]
    method["interquartile_mean"] |= {"energy_cost": 31.0, "share_of_savings": 0.8}
    save_results(folder, content)
    assert str(results_table(folder)[0].measures["Interquartile mean"]) == "$31.00 (share 80.0\u00a0%)"
    del method["interquartile_mean"]
    save_results(folder, content)
    assert str(results_table(folder)[0].measures["Interquartile mean"]) == "–"


@pytest.mark.parametrize("undefined", [None, float("nan"), float("inf")])
def test_an_undefined_metric_is_a_dash(small, undefined):
    folder, content = small
    method = content["homes"]["home"]["methods"]["HA-1"]
    method["mean"]["share_of_savings"] = undefined
    method["interval"]["share_of_savings"] = [undefined, undefined]
    save_results(folder, content)
    assert str(results_table(folder)[0].measures["Share of savings"]) == "–"


def test_no_deviation_is_told_to_be_perhaps_negative(small):
    folder, content = small
    interval = content["homes"]["home"]["methods"]["HA-1"]["interval"]
    interval["mean_temperature_deviation"] = [-0.0005, 0.0029]
    save_results(folder, content)
    cell = next(row for row in results_table(folder) if row.method == "HA-1").measures["Mean deviation"]
    assert cell.detail == "[0, 0.0029]"


def test_negative_costs_and_other_currencies(small):
    folder, content = small
    home = content["homes"]["home"]
    home["currency"] = "SEK"
    home["methods"]["HA-1"]["mean"]["energy_cost"] = -3.456
    home["methods"]["HA-1"]["mean"]["battery_cost"] = -0.001
    home["methods"]["HA-1"]["mean"]["mean_temperature_deviation"] = 3e-6
    save_results(folder, content)
    row = results_table(folder)[0]
    assert row.measures["Energy cost"].value == "−3.46\u00a0SEK"
    assert row.measures["Battery X2"].value == "0.00\u00a0SEK"
    assert row.measures["Mean deviation"].value == "<0.0001\u00a0°C"


def test_methods_stand_in_their_usual_order_and_strangers_last(small):
    folder, content = small
    methods = content["homes"]["home"]["methods"]
    content["homes"]["home"]["methods"] = {
        "my own": methods["Rule"], "optimum": methods["optimum"], "HA-1": methods["HA-1"],
    }  # fmt: skip
    save_results(folder, content)
    assert [row.method for row in results_table(folder)] == ["HA-1", "optimum", "my own"]


def test_a_missing_results_file_says_what_to_run(tmp_path):
    with pytest.raises(HemmaError, match=r"results\.json: .*no such file.*hemma reproduce"):
        results_table(tmp_path)


def test_a_file_that_is_not_json_is_named(tmp_path):
    (tmp_path / "results.json").write_text("{")
    with pytest.raises(HemmaError, match=r"results\.json.*cannot read it"):
        results_table(tmp_path)


def test_another_schema_is_refused(small):
    folder, content = small
    save_results(folder, content | {"schema": 2})
    with pytest.raises(HemmaError, match=r"results\.json.*schema.*found 2"):
        results_table(folder)


def test_a_wrong_entry_is_named_by_its_place(small):
    folder, content = small
    content["homes"]["home"]["comfort_c"] = "warm"
    save_results(folder, content)
    with pytest.raises(HemmaError, match=r"homes\.home\.comfort_c.*found warm"):
        results_table(folder)


def test_without_a_finished_method_there_is_no_table(small):
    folder, content = small
    content["homes"]["home"]["methods"] = {}
    (folder / "results.json").write_text(json.dumps(content))
    with pytest.raises(HemmaError, match="no method has finished"):
        results_table(folder)
