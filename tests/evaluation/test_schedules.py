"""Schedule files: every digit comes back."""

import csv

import jax
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from hemma.evaluation import Outcome, evaluate
from hemma.home import Home, Schedule
from hemma.results.schedules import SCHEDULE_COLUMNS, write_schedule
from hemma.types import Action, Exogenous

NUMBERS = arrays(np.float64, 6, elements=st.floats(-1e6, 1e6))
STAMPS = [f"2021-08-01T0{hour}:00:00-06:00" for hour in range(6)]


def read_schedule(path):
    """The time stamps of a file, and its columns of numbers by name."""
    with path.open(newline="", encoding="utf-8") as file:
        header, *rows = csv.reader(file)
    assert tuple(header) == SCHEDULE_COLUMNS
    times, *columns = zip(*rows, strict=True)
    return times, dict(zip(header[1:], np.array(columns, float), strict=True))


@given(st.tuples(*[NUMBERS] * 8))
def test_every_digit_survives_the_file(tmp_path_factory, columns):
    path = tmp_path_factory.mktemp("schedules") / "schedule.csv"
    outcome = Outcome(*columns)
    write_schedule(path, STAMPS, outcome)
    times, back = read_schedule(path)
    assert times == tuple(STAMPS)
    np.testing.assert_array_equal(back["battery_kw"], outcome.battery_power)
    np.testing.assert_array_equal(back["indoor_c"], outcome.indoor_temperature)
    np.testing.assert_array_equal(back["cost"], outcome.transaction + outcome.ageing)


def test_a_written_schedule_replays_to_itself(tmp_path):
    """The actions of the file, fed to the home again, give the same temperatures, energies and costs."""
    random = np.random.default_rng(1)
    exogenous = Exogenous(*random.uniform(0.1, 30.0, (6, 6)))
    actions = Action(battery_power=random.uniform(-4, 4, 6), hvac_power=random.uniform(0, 3, 6))
    first = evaluate(Home(), exogenous, Schedule(actions), jax.random.key(0))
    write_schedule(tmp_path / "schedule.csv", STAMPS, first)
    _, saved = read_schedule(tmp_path / "schedule.csv")
    again = Schedule(Action(battery_power=saved["battery_kw"], hvac_power=saved["hvac_kw"]))
    second = evaluate(Home(), exogenous, again, jax.random.key(5))
    np.testing.assert_array_equal(second.cost, saved["cost"])
    np.testing.assert_array_equal(second.battery_energy, saved["battery_kwh"])


def test_a_column_of_another_length_is_a_mistake_of_the_caller(tmp_path):
    with pytest.raises(ValueError, match="6 time stamps"):
        write_schedule(tmp_path / "x.csv", STAMPS, Outcome(*np.zeros((8, 5))))
