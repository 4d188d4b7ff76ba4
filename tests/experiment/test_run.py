"""The main job: its results follow from its files, and an interruption changes nothing."""

import csv
import json
import math
import shutil
from dataclasses import replace

import pytest

from hemma.errors import HemmaError
from hemma.experiment.run import Stage, run
from hemma.home import Battery
from hemma.results.results import RESULTS_FILE, load_results
from tiny_experiment import Watching, tiny_experiment, tiny_job

HOME = "austin2021-2"
METRICS = {
    "energy_cost",
    "transaction_cost",
    "battery_cost",
    "mean_temperature_deviation",
    "total_temperature_deviation",
    "gap_to_optimum",
    "share_of_savings",
    "regret",
    "reference_gap",
    "seconds_to_train",
}
JOBS = {"HA-1", "AIRL-1-days", "HA-1-bands"}
TOGETHER = "HA-1-and-2-more"
"""They are trained in one call."""
NOT_LEARNED = {
    "Rule",
    "no battery",
    "thresholds",
    "MPC perfect",
    "default",
    "default published",
    "MPC forecast",
    "MPC hourly means",
    "MPC yesterday",
    "HMPC",
    "HMPC joint",
    "DNLP",
    "optimum",
}


def without_seconds(content):
    """Results as they must repeat: everything but how long it took."""
    if isinstance(content, dict):
        return {key: without_seconds(value) for key, value in content.items() if "seconds" not in key}
    return [without_seconds(item) for item in content] if isinstance(content, list) else content


def read_csv(path):
    with path.open() as file:
        header, *rows = csv.reader(file)
    return header, rows


def test_the_results_file_has_the_schema_of_the_documents(finished):
    folder, content = finished
    assert json.loads((folder / RESULTS_FILE).read_text()) == content
    assert content["schema"] == 1
    assert content["settings"]["battery"]["max_energy_kwh"] == 6.0
    home = content["homes"][HOME]
    assert home["test"] == {"start": "2021-06-06T00:00:00-06:00", "slots": 48}
    assert home["training"] == {"start": "2021-06-01T00:00:00-06:00", "slots": 120}
    assert (home["currency"], home["slot_length_h"], home["comfort_c"]) == ("$", 1.0, [19.0, 24.0])
    assert set(home["identification"]["rmse_c"]) == {"1 h", "6 h", "24 h", "whole period"}
    assert set(home["optimum"]) == {"energy_cost", "mean_temperature_deviation", "bound", "relative_gap"}
    assert set(home["methods"]) == {"HA-1"} | NOT_LEARNED
    assert home["demonstration_days"] == {"HA-1": 2}
    assert [(entry["days"], entry["method"]) for entry in home["data_efficiency"]] == [
        (1, "AIRL"),
        (2, "AIRL"),
    ]
    for method in (*home["methods"].values(), *home["data_efficiency"]):
        assert set(method["mean"]) == set(method["interval"]) == set(method["interquartile_mean"]) == METRICS
        for one in method["runs"]:
            assert set(one) == METRICS | {"seed", "schedule", "curve"}


def test_the_report_reads_the_results(finished):
    results = load_results(finished[0])
    assert results.homes[HOME].methods["HA-1"].runs[1].seed == 1


def test_no_number_is_nan(finished):
    def numbers(content):
        children = content.values() if isinstance(content, dict) else content
        if not isinstance(content, dict | list):
            return [content] if isinstance(content, float) else []
        return [number for child in children for number in numbers(child)]

    assert all(math.isfinite(number) for number in numbers(finished[1]))


def test_nothing_beats_the_optimum_at_equal_comfort(finished):
    home = finished[1]["homes"][HOME]
    for method in home["methods"].values():
        for one in method["runs"]:
            assert one["gap_to_optimum"] >= -1e-6
    assert home["methods"]["optimum"]["runs"][0]["gap_to_optimum"] == pytest.approx(0, abs=1e-6)
    assert home["methods"]["optimum"]["runs"][0]["share_of_savings"] == pytest.approx(1, abs=1e-6)
    assert home["optimum"]["bound"] <= home["optimum"]["energy_cost"] + 1e-9
    assert home["methods"]["no battery"]["runs"][0]["battery_cost"] == 0


def test_curves_and_the_free_run_are_there_row_by_row(finished):
    folder, content = finished
    home = content["homes"][HOME]
    header, rows = read_csv(folder / home["methods"]["HA-1"]["runs"][0]["curve"])
    assert header[0] == "iteration"
    assert [row[0] for row in rows] == ["25", "50"]
    header, rows = read_csv(folder / home["identification"]["free_run"])
    assert header == ["time", "measured_c", "predicted_c", "outdoor_c"]
    assert len(rows) == 48
    assert rows[0][0] == "2021-06-06T00:00:00-06:00"


def test_repeating_the_command_computes_nothing_and_changes_nothing(finished):
    folder, _ = finished
    before = {path: path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}
    watching = Watching()
    run(tiny_job(folder), Stage.EVALUATE, watching)
    assert watching.done == []
    assert set(watching.kept) >= JOBS
    after = {path: path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}
    assert after == before


class Interrupting(Watching):
    """Presses Ctrl-C once, at the first chunk of the training."""

    def advanced(self, stage, done, message):
        if stage == TOGETHER and done == 25:
            raise KeyboardInterrupt


def test_an_interrupted_run_goes_on_and_ends_with_the_same_results(finished, tmp_path):
    with pytest.raises(KeyboardInterrupt):
        run(tiny_job(tmp_path), Stage.EVALUATE, Interrupting())
    partly = json.loads((tmp_path / RESULTS_FILE).read_text())["homes"][HOME]
    assert set(partly["methods"]) == NOT_LEARNED
    watching = Watching()
    again = run(tiny_job(tmp_path), Stage.EVALUATE, watching)
    assert watching.notices == [f"{TOGETHER}: going on from iteration 25 of an interrupted run"]
    assert "identify" in watching.kept
    assert TOGETHER in watching.done
    assert not NOT_LEARNED & set(watching.done)
    assert without_seconds(again) == without_seconds(finished[1])
    assert not list((tmp_path / "models").rglob("*.training.safetensors"))


def test_other_settings_compute_anew_what_depends_on_them_and_nothing_else(finished, tmp_path):
    shutil.copytree(finished[0], tmp_path / "results")
    experiment = tiny_experiment()
    fewer = replace(experiment, data_efficiency=replace(experiment.data_efficiency, days=()))
    watching = Watching()
    content = run(tiny_job(tmp_path / "results", fewer), Stage.EVALUATE, watching)
    assert watching.done == []
    assert "replaced" in watching.notices[0]
    assert [entry["days"] for entry in content["homes"][HOME]["data_efficiency"]] == [2]
    names = {path.name for path in (tmp_path / "results" / "schedules" / HOME).iterdir()}
    assert "AIRL-1-days-0.csv" not in names
    assert "HA-1-0.csv" in names

    larger = replace(fewer, battery=Battery(max_energy=9.0))
    watching = Watching()
    content = run(tiny_job(tmp_path / "results", larger), Stage.DEMONSTRATE, watching)
    assert watching.done == ["identify", "demonstrate", "demonstrate"]  # the second one for another band
    assert content["homes"][HOME]["methods"] == {}


def test_a_product_that_is_broken_missing_or_changed_is_made_again(finished, tmp_path):
    shutil.copytree(finished[0], tmp_path / "results")
    (tmp_path / "results/models" / HOME / "network.safetensors").write_bytes(b"broken")
    (tmp_path / "results/schedules" / HOME / "Rule.csv").unlink()
    schedule = tmp_path / "results/schedules" / HOME / "HMPC.csv"
    schedule.write_text(schedule.read_text().replace("1", "2"))
    watching = Watching()
    content = run(tiny_job(tmp_path / "results"), Stage.EVALUATE, watching)
    assert watching.done == ["identify"]
    assert without_seconds(content) == without_seconds(finished[1])
    for name in ("Rule.csv", "HMPC.csv"):
        made, original = (root / "schedules" / HOME / name for root in (tmp_path / "results", finished[0]))
        assert made.read_bytes() == original.read_bytes()


@pytest.mark.slow
def test_the_method_sees_its_own_days_and_no_others(finished, tmp_path):
    """Other traces after the demonstrated days: another test and excitation, the same controllers."""
    job = tiny_job(tmp_path)
    exogenous = job.homes[0].exogenous
    load = exogenous.load.copy()
    load[48:] += 0.5
    other = replace(job.homes[0], exogenous=replace(exogenous, load=load))
    content = run(replace(job, homes=(other,)), Stage.EVALUATE, Watching())
    curve = "curves/austin2021-2/HA-1-0.csv"
    assert (tmp_path / curve).read_bytes() == (finished[0] / curve).read_bytes()
    assert content["homes"][HOME]["methods"]["HA-1"]["mean"]["energy_cost"] != pytest.approx(
        finished[1]["homes"][HOME]["methods"]["HA-1"]["mean"]["energy_cost"]
    )


def test_nobody_needs_to_learn_from_demonstrations(tmp_path):
    tiny = tiny_experiment()
    no_lengths = replace(tiny.data_efficiency, days=())
    experiment = replace(tiny, learned=("PPO",), data_efficiency=no_lengths)
    watching = Watching()
    run(tiny_job(tmp_path, experiment), Stage.DEMONSTRATE, watching)
    assert watching.done == ["identify"]


def test_too_many_days_of_demonstrations_are_refused(tmp_path):
    experiment = replace(tiny_experiment(), demonstration_days=6)
    with pytest.raises(HemmaError, match=r"at least 6 days .* got 5; set demonstration_days lower"):
        run(tiny_job(tmp_path, experiment), Stage.DEMONSTRATE)


def test_the_same_home_twice_is_refused(tmp_path):
    job = tiny_job(tmp_path)
    with pytest.raises(HemmaError, match="austin2021-2 twice"):
        run(replace(job, homes=(job.homes[0], job.homes[0])))
