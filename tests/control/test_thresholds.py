"""Thresholds: the rule's cases by hand, the fit against brute force, and worlds with an obvious answer."""

from dataclasses import replace

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hemma.control.comfort import ComfortHold
from hemma.control.thresholds import PriceRule, Thresholds, fit_thresholds
from hemma.home import AbstractController, Battery, Home, Hvac, Trajectory, benchmark_home, replay
from hemma.home.precision import in_double
from hemma.home.selling import SellingLine, fit_selling
from hemma.types import Exogenous
from small_worlds import noisy, periodic

HOME = Home()
compiled_replay = eqx.filter_jit(replay)


def run(home: Home, exogenous: Exogenous, controller: AbstractController) -> Trajectory:
    with jax.enable_x64(True):
        inside = in_double((home, exogenous, controller))
        path = compiled_replay(*inside, home.reset(), jax.random.key(0))
        return jax.tree.map(np.asarray, path)


def cost(path: Trajectory) -> float:
    return float(np.sum(path.steps.costs.transaction) + np.sum(path.steps.costs.ageing))


def power(rule: PriceRule, demand: float, buying: float, selling: float = float("nan")) -> float:
    """Battery power [kW] of a battery at 3 kWh; without a line, the rule goes by the ``selling`` price."""
    inputs = (jnp.asarray(3.0), jnp.asarray(demand), (jnp.asarray(buying), jnp.asarray(selling)))
    return float(rule.battery_power(Battery(), *inputs, slot_length=1.0))


@pytest.mark.parametrize(
    ("price", "demand", "expected"),
    [
        (0.09, 1.0, 3.0),  # buying is cheap: full power
        (0.09, -1.0, 3.0),
        (0.12, -1.0, 1.0),  # selling is cheap, buying is not: the surplus
        (0.12, 1.0, 0.0),
        (0.12, -5.0, 3.0),  # at most what the battery takes
        (0.15, 1.0, 0.0),  # between
        (0.15, -1.0, 0.0),
        (0.22, 1.0, -1.0),  # buying is dear, selling is not: the demand
        (0.22, -1.0, 0.0),
        (0.22, 5.0, -2.28),  # at most what is stored
        (0.30, 1.0, -2.28),  # selling is dear: full power
    ],
)
def test_the_rule_by_hand(price, demand, expected):
    rule = PriceRule(charge_below=0.11, discharge_above=0.20, selling=SellingLine(0.8, 0.0))
    e = power(rule, demand, price)
    assert e == pytest.approx(expected, abs=1e-6)


def test_where_selling_is_dearer_than_buying_the_cheap_energy_is_taken_first():
    rule = PriceRule(charge_below=0.11, discharge_above=0.20, selling=SellingLine(0.0, 0.3))
    assert power(rule, 1.0, 0.1) == pytest.approx(3.0)


@pytest.mark.parametrize(
    ("demand", "selling", "expected"),
    [(-1.0, 0.05, 1.0), (-1.0, 0.15, 0.0), (1.0, 0.05, -1.0), (1.0, 0.25, -2.28)],
)
def test_a_selling_price_that_is_no_line_is_observed(demand, selling, expected):
    rule = PriceRule(charge_below=0.11, discharge_above=0.20, selling=None)
    assert power(rule, demand, 0.3, selling) == pytest.approx(expected, abs=1e-6)


def two_prices(low: float, high: float, ratio: float = 0.9) -> Exogenous:
    exogenous = periodic(6)
    u = np.where((exogenous.hour_of_day >= 14) & (exogenous.hour_of_day < 20), high, low)
    return replace(exogenous, buying_price=u, selling_price=ratio * u)


@pytest.mark.parametrize("scale", [1.0, 1000.0])
def test_two_prices_have_the_obvious_thresholds(scale):
    exogenous = two_prices(0.1 * scale, 0.3 * scale)
    rule = fit_thresholds(HOME, exogenous).rule
    assert 0.1 * scale < rule.charge_below < 0.27 * scale  # buys at the low price
    assert 0.1 * scale < rule.discharge_above < 0.3 * scale  # discharges at the high one


def test_a_poor_selling_price_covers_the_own_demand_alone():
    exogenous = two_prices(0.1, 0.3, ratio=0.2)
    fitted = fit_thresholds(HOME, exogenous)
    assert 0.06 <= fitted.rule.discharge_above < 0.3
    steps = run(HOME, exogenous, fitted).steps
    assert np.min(steps.grid_power[steps.action.battery_power < 0]) >= -1e-9


def test_one_price_and_a_fair_selling_price_leave_the_battery_at_rest():
    exogenous = periodic(4, price=0.2)
    steps = run(HOME, exogenous, fit_thresholds(HOME, exogenous)).steps
    assert np.all(steps.action.battery_power <= 0)  # it empties what it was given, and never charges
    assert np.sum(-steps.action.battery_power) == pytest.approx((1.2 - 0.6) * 0.95)


def test_one_price_and_a_poor_selling_price_store_the_surplus():
    exogenous = periodic(6, price=0.2)
    exogenous = replace(exogenous, selling_price=np.full(exogenous.slots, 0.02))
    steps = run(HOME, exogenous, fit_thresholds(HOME, exogenous)).steps
    e, net = steps.action.battery_power, steps.grid_power - steps.action.battery_power
    assert np.max(e) > 0.1
    assert np.all(net[e > 1e-9] < 0)  # charges from a surplus
    assert np.all(net[e < -1e-9] > 0)  # serves the demand


def test_a_battery_without_capacity_rests():
    home = replace(HOME, battery=Battery(max_energy=0.0, min_energy=0.0, initial_energy=0.0))
    exogenous = noisy(5, 1)
    fitted = fit_thresholds(home, exogenous)
    assert (fitted.rule.charge_below, fitted.rule.discharge_above) == (-np.inf, np.inf)
    assert np.all(run(home, exogenous, fitted).steps.action.battery_power == 0)


@settings(max_examples=3)
@given(
    seed=st.integers(0, 50),
    negative=st.sampled_from([0.0, 0.15]),
    kind=st.sampled_from(["cools", "heats", "quarters"]),
)
def test_no_pair_of_random_thresholds_is_better_on_the_training_period(seed, negative, kind):
    home = {"cools": HOME, "heats": Home(hvac=Hvac(heats=True)), "quarters": benchmark_home(0.25)}[kind]
    exogenous = noisy(4, seed, float(home.slot_length), 10.0 if kind == "heats" else 31.0, negative)
    fitted = fit_thresholds(home, exogenous)
    best = cost(run(home, exogenous, fitted))
    random, selling = np.random.default_rng(seed), fit_selling(exogenous)
    u = exogenous.buying_price
    for _ in range(12):
        low, high = np.sort(random.uniform(np.quantile(u, 0.02), np.quantile(u, 0.98), 2))
        other = Thresholds(home, PriceRule(float(low), float(high), selling))
        assert best <= cost(run(home, exogenous, other)) + 1e-2 * abs(best)
    assert best <= cost(run(home, exogenous, ComfortHold(home))) + 1e-9


def test_few_prices_are_searched_in_full():
    exogenous = noisy(3, 9)
    u = np.round(20 * exogenous.buying_price) / 20
    exogenous = replace(exogenous, buying_price=u, selling_price=0.9 * u)
    fitted = fit_thresholds(HOME, exogenous)
    best = cost(run(HOME, exogenous, fitted))
    candidates = np.unique(np.concatenate([u, 0.9 * u])) + 1e-4
    for low in candidates:
        for high in candidates[candidates >= low]:
            rule = PriceRule(float(low), float(high), fitted.rule.selling)
            assert best <= cost(run(HOME, exogenous, Thresholds(HOME, rule))) + 1e-9


def test_the_hvac_holds_comfort_by_the_home_that_it_was_given():
    exogenous = noisy(4, 3)
    fitted = fit_thresholds(HOME, exogenous)
    steps, held = run(HOME, exogenous, fitted).steps, run(HOME, exogenous, ComfortHold(HOME)).steps
    np.testing.assert_allclose(steps.action.hvac_power, held.action.hvac_power, atol=1e-12)
