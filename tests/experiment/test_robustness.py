"""All methods under every fault: the main table where nothing is wrong, and never better than the best."""

import json
import shutil
from dataclasses import replace

import numpy as np
import pytest
from tiny_experiment import Watching, tiny_experiment, tiny_job

from hemma.studies.robustness.faults import FaultSettings, faults
from hemma.studies.robustness.records import load_robustness
from hemma.studies.robustness.report import met, robustness_markdown, robustness_rows, shown
from hemma.studies.robustness.run import run_faults

HOME = "austin2021-2"
FEW = ("nothing", "disturbed building", "worn battery", "no thermometer", "no battery level")
"""Enough to see that each is met by all; what each does is tested by itself."""


def some(names):
    """The faults of these names."""
    return lambda settings: tuple(fault for fault in faults(settings) if fault.name in names)


@pytest.fixture(scope="module")
def robust(finished, tmp_path_factory):
    """Folder and content of some faults of the tiny experiment, in a copy of its folder."""
    folder = tmp_path_factory.mktemp("robust") / "results"
    shutil.copytree(finished[0], folder)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("hemma.studies.robustness.trial.faults", some(FEW))
        yield folder, json_content(run_faults(tiny_job(folder)))


def test_where_nothing_is_wrong_it_is_the_main_table(finished, robust):
    main = finished[1]["homes"][HOME]["methods"]
    nothing = robust[1]["homes"][HOME]["faults"][0]
    assert (nothing["fault"], nothing["repaired_readings"]) == ("nothing", 0)
    for method in ("Rule", "no battery", "thresholds", "default", "MPC yesterday", "HA-1"):
        for one, usual in zip(nothing["methods"][method]["runs"], main[method]["runs"], strict=True):
            assert one["seed"] == usual["seed"]
            assert one["energy_cost"] == pytest.approx(usual["energy_cost"], abs=2e-3)
            assert one["share_of_savings"] == pytest.approx(usual["share_of_savings"], abs=5e-3)


def test_every_fault_and_every_method_is_there(robust):
    found = robust[1]["homes"][HOME]["faults"]
    assert [one["fault"] for one in found] == list(FEW)
    methods = set(found[0]["methods"])
    assert {"HA-1", "Rule", "default", "default published", "MPC forecast"} <= methods
    assert "MPC perfect" not in methods
    assert all(set(one["methods"]) == methods for one in found)


def test_nothing_beats_perfect_information_in_the_same_home(robust):
    for one in robust[1]["homes"][HOME]["faults"]:
        for method in one["methods"].values():
            assert all(run["regret"] >= -1e-4 for run in method["runs"])


def test_missing_readings_are_counted_and_harm_no_run(robust):
    found = {one["fault"]: one for one in robust[1]["homes"][HOME]["faults"]}
    for fault in ("no thermometer", "no battery level"):
        assert found[fault]["repaired_readings"] == 2  # one hour on each of two days
        runs = [run for method in found[fault]["methods"].values() for run in method["runs"]]
        assert all(np.isfinite(run["energy_cost"]) for run in runs)
    watched = found["disturbed building"]["methods"]
    assert watched["HA-1"]["runs"][0]["limited"] is not None
    assert watched["default"]["runs"][0]["limited"] is None


def test_a_second_call_takes_everything_from_the_folder(robust):
    folder, content = robust
    before = (folder / "robustness.json").read_bytes()
    watching = Watching()
    assert json_content(run_faults(tiny_job(folder), watching)) == content
    assert (folder / "robustness.json").read_bytes() == before
    assert json.loads(before) == content


def test_the_table_has_a_row_for_each_fault_and_the_figure_is_drawn(robust):
    folder = robust[0]
    found = load_robustness(folder)
    rows = robustness_rows(found)
    assert [row[0] for row in rows] == found.faults
    assert all(len(row) == 1 + len(shown(found)) for row in rows)
    assert (folder / "robustness.md").read_text() == robustness_markdown(found)
    assert (folder / "figures" / "robustness.png").stat().st_size > 10_000
    one = robust[1]["homes"][HOME]["faults"][0]["methods"]["HA-1"]
    cell = met(found, "nothing", "HA-1")
    assert cell.share == pytest.approx(one["mean"]["share_of_savings"])
    assert cell.worst == min(run["share_of_savings"] for run in one["runs"])


def test_other_magnitudes_give_other_results(robust, monkeypatch):
    folder, content = robust
    monkeypatch.setattr("hemma.studies.robustness.trial.faults", some(["worn battery"]))
    harder = replace(tiny_experiment(), faults=FaultSettings(efficiency=0.6))
    [other] = json_content(run_faults(tiny_job(folder, harder)))["homes"][HOME]["faults"]
    usual = content["homes"][HOME]["faults"][FEW.index("worn battery")]
    costs = [table["methods"]["default"]["runs"][0]["energy_cost"] for table in (usual, other)]
    assert costs[1] > costs[0]
