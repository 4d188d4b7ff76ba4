"""A filled folder measured as it is: nothing is trained, and where nothing is wrong it costs what it told."""

import json
import shutil
from dataclasses import replace

import numpy as np
import pytest

from hemma.control.comfort import ComfortHold
from hemma.data import load_austin2021
from hemma.errors import HemmaError
from hemma.methods.rules import NoBattery
from hemma.results.reading import json_content
from hemma.results.store import Store
from hemma.stages.case import make_case
from hemma.studies.robustness.faults import faults
from hemma.studies.robustness.records import FaultRun, load_robustness
from hemma.studies.robustness.run import measure_faults, run_stored_faults
from hemma.studies.robustness.scenes import late, scene
from hemma.studies.robustness.stored import stored_job, stored_trial
from hemma.studies.robustness.trial import FOREIGN, Trial
from tiny_experiment import Watching, tiny_job

HOME = "austin2021-2"
COMMAND = "hemma robustness --for-tests"


def week(experiment, homes):
    """The tiny experiment's part of embedded homes."""
    return tuple(load_austin2021(home).window(0, 24 * 7) for home in homes)


@pytest.fixture(autouse=True, scope="module")
def _short():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("hemma.studies.robustness.stored.embedded_homes", week)
        patch.setattr("hemma.studies.robustness.trial.faults", lambda settings: faults(settings)[:1])
        yield


@pytest.fixture
def filled(finished, tmp_path):
    """A copy of the folder of the tiny experiment."""
    return shutil.copytree(finished[0], tmp_path / "results")


@pytest.fixture(scope="module")
def measured(finished, tmp_path_factory):
    """Folder, content and watcher of a filled folder, measured as it is."""
    folder = shutil.copytree(finished[0], tmp_path_factory.mktemp("stored") / "results")
    watching = Watching()
    return folder, json_content(run_stored_faults(folder, None, COMMAND, watching)), watching


def test_it_has_the_settings_homes_and_test_period_of_the_folder(filled):
    job, usual = stored_job(filled, None, COMMAND), tiny_job(filled)
    assert job.homes[0].sha256 == usual.homes[0].sha256
    assert make_case(job.experiment, job.homes[0], job.test_from).mark == (
        make_case(usual.experiment, usual.homes[0], usual.test_from).mark
    )
    assert (job.experiment.airl, job.experiment.seeds) == (usual.experiment.airl, usual.experiment.seeds)


def test_nothing_is_trained_and_every_run_costs_what_the_results_tell(finished, measured):
    _, content, watching = measured
    assert watching.done == ["robustness"]
    assert not [notice for notice in watching.notices if "costs" in notice]
    main = finished[1]["homes"][HOME]["methods"]
    [nothing] = content["homes"][HOME]["faults"]
    assert "HA-1" in nothing["methods"]
    for method, met in nothing["methods"].items():
        costs = [[run["energy_cost"] for run in runs] for runs in (met["runs"], main[method]["runs"])]
        assert costs[0] == pytest.approx(costs[1], abs=2e-3), method


def test_a_run_that_costs_something_else_and_a_method_that_is_gone_are_said(measured, tmp_path):
    folder = shutil.copytree(measured[0], tmp_path / "results")
    results = json.loads((folder / "results.json").read_text())
    results["homes"][HOME]["methods"]["Rule"]["runs"][0]["energy_cost"] *= 1.01
    results["settings"]["learned"] = ["HA-1", "PPO"]
    (folder / "results.json").write_text(json.dumps(results))
    watching = Watching()
    run_stored_faults(folder, None, COMMAND, watching)
    said = [notice for notice in watching.notices if "costs" in notice]
    assert len(said) == 1
    assert said[0].startswith(f"{HOME}: Rule costs ")
    assert any("PPO is left out" in notice for notice in watching.notices)


@pytest.fixture
def trial(measured, tmp_path):
    """The methods of the filled folder, in a copy of it."""
    folder = shutil.copytree(measured[0], tmp_path / "results")
    job = stored_job(folder, None, COMMAND)
    case = make_case(job.experiment, job.homes[0], job.test_from)
    return stored_trial(case, Store(folder, HOME, Watching()))


def moved(trial, home):
    """The same controllers, as if they had learned in another embedded home."""
    case = trial.expert.case
    other = make_case(case.experiment, week(None, (home,))[0], "2021-06-06")
    store = Store(trial.store.folder, other.name, Watching())
    return replace(trial, expert=replace(trial.expert, case=other), store=store)


@pytest.mark.slow
def test_controllers_of_another_home_act_in_this_one(trial):
    """The embedded homes differ in load and PV alone: a rule costs the same, a forecast does not."""
    case, guest = trial.expert.case, moved(trial, 3)
    own, foreign = trial.results(guest)
    assert (own.fault, foreign.fault) == ("nothing", FOREIGN.name)
    acted = guest.runs(scene(case.home, case.test))
    assert {name: list(one.runs) for name, one in foreign.methods.items()} == acted
    costs = [{name: one.mean.energy_cost for name, one in met.methods.items()} for met in (own, foreign)]
    assert costs[0]["Rule"] == costs[1]["Rule"]
    assert costs[0]["MPC hourly means"] != costs[1]["MPC hourly means"]
    assert all(run.regret >= -1e-4 for one in foreign.methods.values() for run in one.runs)


def test_a_method_knows_the_period_as_it_is_read_and_no_better(trial, monkeypatch):
    """Whatever kind of method it is: no list of kinds decides it."""
    told = []

    def controller(self, known):
        told.append(np.asarray(known.outlook.period.load))
        return ComfortHold(known.expert.planning_home)

    monkeypatch.setattr(NoBattery, "controller", controller)
    case = trial.expert.case
    now = late(scene(case.home, case.test), np.random.default_rng(0))
    trial.runs(now)
    np.testing.assert_array_equal(told[-1], now.readings.exogenous.load)
    assert not np.array_equal(told[-1], case.test.load)


@pytest.mark.slow
def test_each_home_has_the_controllers_of_the_next_and_the_last_those_of_the_first(trial, monkeypatch):
    def runs(self, _):
        """One run that says whose it is."""
        return {"Rule": [FaultRun(energy_cost=float(self.expert.case.name[-1]))]}

    monkeypatch.setattr(Trial, "runs", runs)
    folder = trial.store.folder
    homes = [moved(trial, home) for home in (4, 5, 6)]
    content = json_content(measure_faults(stored_job(folder, None, COMMAND), homes))
    costs = [
        [one["methods"]["Rule"]["mean"]["energy_cost"] for one in home["faults"]]
        for home in content["homes"].values()
    ]
    assert costs == [[4.0, 5.0], [5.0, 6.0], [6.0, 4.0]]
    assert load_robustness(folder).faults == ["nothing", FOREIGN.name]
    assert f"- {FOREIGN.name}: " in (folder / "robustness.md").read_text()
    assert (folder / "figures" / "robustness.png").exists()


@pytest.mark.slow
def test_planners_that_look_less_far_are_measured_again(trial):
    case = trial.expert.case
    shorter = replace(case, experiment=replace(case.experiment, forecast_horizon=3.0))
    again = replace(trial, expert=replace(trial.expert, case=shorter))
    costs = [one.results()[0].methods["MPC yesterday"].mean.energy_cost for one in (trial, again)]
    assert costs[0] != costs[1]


def test_a_single_home_has_no_neighbour(measured):
    assert [one["fault"] for one in measured[1]["homes"][HOME]["faults"]] == ["nothing"]


def test_other_traces_than_those_measured_are_refused(filled):
    path = filled / "results.json"
    content = json.loads(path.read_text())
    content["homes"][HOME]["traces_sha256"] = "ab" * 32
    path.write_text(json.dumps(content))
    with pytest.raises(HemmaError, match=f"{HOME} was measured on other traces"):
        stored_job(filled, None, COMMAND)


def test_a_changed_network_is_refused(filled):
    (filled / "models" / HOME / "network.safetensors").write_bytes(b"")
    with pytest.raises(HemmaError, match=r"network\.safetensors: expected the network.*hemma reproduce"):
        run_stored_faults(filled, None, COMMAND)


def test_homes_with_different_test_periods_are_refused(filled):
    path = filled / "results.json"
    content = json.loads(path.read_text())
    other = json.loads(json.dumps(content["homes"][HOME]))
    other["test"]["start"] = "2021-06-05T00:00:00-06:00"
    other["traces_sha256"] = load_austin2021(3).sha256
    content["homes"]["austin2021-3"] = other
    path.write_text(json.dumps(content))
    with pytest.raises(HemmaError, match="expected one test period for all homes"):
        stored_job(filled, None, COMMAND)
