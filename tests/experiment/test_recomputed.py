"""Every number of a results folder recomputes from its files, by an implementation that shares nothing."""

import json
import shutil
from dataclasses import replace

import jax
import numpy as np
import pytest
from recomputation import EXOGENOUS, SCHEDULE, complaints, groups

from hemma.evaluation import EqualComfort, evaluate, measure
from hemma.home import Battery, ExplicitThermalModel, Hvac, Schedule
from hemma.results.schedules import EXOGENOUS_COLUMNS, SCHEDULE_COLUMNS, write_exogenous, write_schedule
from hemma.settings.keys import outside
from hemma.types import Action, Exogenous
from tiny_experiment import tiny_experiment

RULE = "schedules/austin2021-2/Rule.csv"


def test_every_number_of_every_method_recomputes(finished):
    folder, content = finished
    assert complaints(folder) == []
    assert (list(EXOGENOUS_COLUMNS), list(SCHEDULE_COLUMNS)) == (EXOGENOUS, SCHEDULE)
    for home in content["homes"].values():
        found = dict(groups(home))
        assert {f"methods {method}" for method in home["methods"]} <= set(found)
        assert len(found) >= len(home["methods"]) + len(home["data_efficiency"])
        assert all(group["runs"] for group in found.values())


@pytest.mark.parametrize("column", SCHEDULE)
def test_a_schedule_with_one_wrong_cell_does_not(finished, tmp_path, column):
    folder = shutil.copytree(finished[0], tmp_path / "results")
    header, *rows = (folder / RULE).read_text().splitlines()
    cells = rows[30].split(",")
    position = SCHEDULE.index(column)
    cells[position] = (
        cells[position].replace("T", " ") if position == 0 else str(float(cells[position]) + 1e-4)
    )
    rows[30] = ",".join(cells)
    (folder / RULE).write_text("\n".join([header, *rows]) + "\n")
    found = complaints(folder)
    assert found
    assert all("Rule" in sentence for sentence in found)


@pytest.mark.parametrize("metric", ["energy_cost", "battery_cost", "mean_temperature_deviation"])
@pytest.mark.parametrize("where", ["run", "mean"])
def test_results_with_one_wrong_number_do_not(finished, tmp_path, metric, where):
    folder = shutil.copytree(finished[0], tmp_path / "results")
    content = json.loads((folder / "results.json").read_text())
    method = content["homes"]["austin2021-2"]["methods"]["HA-1"]
    (method["runs"][1] if where == "run" else method["mean"])[metric] += 1e-6
    (folder / "results.json").write_text(json.dumps(content))
    (only,) = complaints(folder)
    assert metric in only
    assert "HA-1" in only


def test_a_home_that_is_not_the_papers_recomputes_too(tmp_path):
    """Quarters of an hour, heating, sales dearer than purchases, negative prices, actions out of range."""
    experiment = replace(
        tiny_experiment(),
        battery=Battery(charging_efficiency=0.9, discharging_efficiency=0.8, ageing_cost=0.02),
        building=ExplicitThermalModel(inertia=0.8, efficiency=3.0, conductance=0.2),
        hvac=Hvac(max_power=4.0, heats=True),
        initial_temperature=17.0,
    )
    random = np.random.default_rng(5)
    price = random.normal(0.1, 0.2, 200)
    hour = np.arange(200) / 4 % 24
    exogenous = Exogenous(
        random.uniform(0, 3, 200),
        random.uniform(0, 2, 200),
        random.normal(0, 9, 200),
        price,
        1.2 * price,
        hour,
    )
    wild = Schedule(Action(random.uniform(-6, 6, 200), random.uniform(-1, 5, 200)))
    outcome = evaluate(experiment.home(0.25), exogenous, wild, jax.random.key(0))
    metrics = measure(outcome, EqualComfort(optimum=1.0, no_battery=2.0)).model_dump()
    folder = tmp_path / "schedules" / "odd"
    folder.mkdir(parents=True)
    stamps = [str(slot) for slot in range(200)]
    write_exogenous(folder / "exogenous.csv", stamps, exogenous)
    write_schedule(folder / "wild.csv", stamps, outcome)
    method = {"runs": [{**metrics, "schedule": "schedules/odd/wild.csv"}], "mean": metrics}
    homes = {"odd": {"slot_length_h": 0.25, "methods": {"wild": method}}}
    (tmp_path / "results.json").write_text(json.dumps({"settings": outside(experiment), "homes": homes}))
    assert complaints(tmp_path) == []
    assert metrics["total_temperature_deviation"] > 1
