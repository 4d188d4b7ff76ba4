"""Metrics: equal-comfort ratios by hand, and everything recomputed from the written files alone."""

import csv
import math

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hemma.evaluation import EqualComfort, Outcome, evaluate, measure
from hemma.home import AbstractController, Home
from hemma.results.schedules import write_exogenous, write_schedule
from hemma.types import Action, Exogenous


def outcome_of(cost, deviation=0.0):
    """One slot with the given cost and deviation, everything else zero."""
    zero = np.zeros(1)
    return Outcome(zero, zero, zero, zero, zero, np.array([cost]), zero, np.array([deviation]))


def test_gap_and_share_by_hand():
    metrics = measure(outcome_of(12.0, 1.5), EqualComfort(optimum=10.0, no_battery=18.0, gap=0.01), 3.0)
    assert metrics.gap_to_optimum == pytest.approx(0.2)
    assert metrics.share_of_savings == pytest.approx(6 / 8)
    assert metrics.mean_temperature_deviation == metrics.total_temperature_deviation == 1.5
    assert metrics.seconds_to_train == 3.0
    assert metrics.reference_gap == 0.01


def test_a_negative_optimum_keeps_the_sign_of_the_gap():
    """Earning 8 where 10 could be earned is 20 % away from the optimum, not -20 %."""
    metrics = measure(outcome_of(-8.0), EqualComfort(optimum=-10.0, no_battery=0.0))
    assert metrics.gap_to_optimum == pytest.approx(0.2)
    assert metrics.share_of_savings == pytest.approx(0.8)


@pytest.mark.parametrize("optimum", [0.0, 1e-9, -1e-9])
def test_an_optimum_of_zero_gives_no_gap_but_a_share(optimum):
    metrics = measure(outcome_of(1.0), EqualComfort(optimum=optimum, no_battery=4.0))
    assert metrics.gap_to_optimum is None
    assert metrics.share_of_savings == pytest.approx(0.75)


@pytest.mark.parametrize("no_battery", [10.0, 10.0 - 1e-7, 9.0, math.nan])
def test_a_useless_battery_gives_no_share(no_battery):
    metrics = measure(outcome_of(12.0), EqualComfort(optimum=10.0, no_battery=no_battery))
    assert metrics.share_of_savings is None
    assert metrics.gap_to_optimum == pytest.approx(0.2)


class Wobbling(AbstractController):
    """Charges and cools by the clock, beyond the limits now and then."""

    def __call__(self, observation, memory, key):
        turn = jnp.sin(observation.slot * 0.9)
        h = jnp.maximum(2.5 * jnp.cos(observation.slot), 0.0)
        return Action(battery_power=4.0 * turn, hvac_power=h), memory


def summer(slots):
    random = np.random.default_rng(3)
    hour = np.arange(slots) % 24
    return Exogenous(
        pv_generation=np.maximum(0.0, 3 * np.sin((hour - 6) / 12 * np.pi)),
        load=random.uniform(0.2, 1.5, slots),
        outdoor_temperature=30 + 5 * np.sin((hour - 9) / 12 * np.pi),
        buying_price=random.uniform(-0.05, 0.4, slots),
        selling_price=0.9 * random.uniform(-0.05, 0.4, slots),
        hour_of_day=hour.astype(float),
    )


def read_columns(path):
    with path.open() as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0] if name != "time"}


@pytest.mark.parametrize("slot_length", [1.0, 0.25])
def test_every_metric_follows_from_the_written_files(tmp_path, slot_length):
    """Written by hand from equations (1), (2), (5) and (8), with nothing of Hemma in it."""
    home, exogenous = Home(slot_length=slot_length), summer(100)
    outcome = evaluate(home, exogenous, Wobbling(), jax.random.key(0))
    stamps = [f"2021-08-01T{i:04d}" for i in range(100)]
    write_schedule(tmp_path / "schedule.csv", stamps, outcome)
    write_exogenous(tmp_path / "exogenous.csv", stamps, exogenous)
    metrics = measure(outcome, EqualComfort(optimum=1.0, no_battery=9.0))

    s, x = read_columns(tmp_path / "schedule.csv"), read_columns(tmp_path / "exogenous.csv")
    grid = s["hvac_kw"] + s["battery_kw"] + x["load_kw"] - x["pv_kw"]
    np.testing.assert_allclose(s["grid_kw"], grid, atol=1e-12)
    price = np.where(grid > 0, x["buy_per_kwh"], x["sell_per_kwh"])
    transaction, ageing = price * grid * slot_length, 0.001 * np.abs(s["battery_kw"]) * slot_length
    np.testing.assert_allclose(s["cost"], transaction + ageing, atol=1e-12)
    deviation = np.maximum(s["indoor_c"] - 24, 0) + np.maximum(19 - s["indoor_c"], 0)
    stored = np.where(s["battery_kw"] > 0, 0.95 * s["battery_kw"], s["battery_kw"] / 0.95) * slot_length
    np.testing.assert_allclose(s["battery_kwh"], 1.2 + np.cumsum(stored), atol=1e-9)

    assert metrics.transaction_cost == pytest.approx(transaction.sum(), abs=1e-10)
    assert metrics.battery_cost == pytest.approx(ageing.sum(), abs=1e-10)
    assert metrics.energy_cost == pytest.approx(s["cost"].sum(), abs=1e-10)
    assert metrics.mean_temperature_deviation == pytest.approx(deviation.mean(), abs=1e-10)
    assert metrics.total_temperature_deviation == pytest.approx(deviation.sum(), abs=1e-10)
    assert metrics.gap_to_optimum == pytest.approx(s["cost"].sum() - 1.0, abs=1e-10)
    assert metrics.share_of_savings == pytest.approx((9 - s["cost"].sum()) / 8, abs=1e-10)
    assert metrics.seconds_to_train is None
