"""Rolling-horizon optimisation against perfect information, and what must hold for any home."""

from dataclasses import replace

import equinox as eqx
import jax
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hemma.control.rolling import RollingPlanner, comfort_price
from hemma.errors import HemmaError
from hemma.forecasting.outlook import Forecaster, Outlook, hourly_means, perfect, yesterday
from hemma.forecasting.ridge import fitted
from hemma.home import Battery, ExplicitThermalModel, Home, Hvac, Trajectory, benchmark_home, replay_in_double
from hemma.optimisation.affine import affine_response
from hemma.optimisation.joint import joint_hmpc
from hemma.optimisation.optimum import optimum_problem
from hemma.types import Exogenous
from small_worlds import changed_after, cut, noisy, periodic

HOME = Home()
SATURATED = Home(hvac=Hvac(max_power=0.9))
KINDS = {
    "summer": (HOME, 31.0, 0.0),
    "winter": (Home(hvac=Hvac(heats=True)), 8.0, 0.0),
    "saturated": (SATURATED, 33.0, 0.0),
    "negative prices": (HOME, 31.0, 0.15),
}


def planned(
    believed: Home, home: Home, period: Exogenous, forecasts: Exogenous, kicks: np.ndarray | None = None
) -> Trajectory:
    """What a rolling planner does in ``home``, which ``kicks`` [degC] disturb."""
    return replay_in_double(home, period, RollingPlanner(believed, forecasts), disturbances=kicks)


def costs(path: Trajectory) -> tuple[float, float]:
    """Sum of X1 + X2 [currency] and of X3 [degC]."""
    costs = path.steps.costs
    return float(np.sum(costs.transaction + costs.ageing)), float(np.sum(costs.temperature_deviation))


def whole(period: Exogenous, home: Home, horizon: float = 36.0, past: Exogenous | None = None) -> Outlook:
    dt = float(home.slot_length)
    return Outlook(periodic(4, dt) if past is None else past, period, dt, horizon)


@pytest.mark.parametrize("kind", list(KINDS))
def test_with_the_whole_period_foreseen_it_is_the_optimum(kind):
    home, mean, negative = KINDS[kind]
    period = noisy(2, 1, mean=mean, negative_share=negative)
    cost, deviation = costs(planned(home, home, period, perfect(whole(period, home, 48.0))))
    problem = optimum_problem(home, period)
    best = problem.solve()
    assert deviation == pytest.approx(problem.least_deviation, abs=1e-5)
    assert cost == pytest.approx(best.cost, abs=1e-4)


def test_quarters_of_an_hour_and_a_horizon_of_a_day_come_near():
    home = benchmark_home(0.25)
    period = noisy(2, 2, 0.25)
    cost, deviation = costs(planned(home, home, period, perfect(whole(period, home, 24.0))))
    problem = optimum_problem(home, period)
    best, without = problem.solve(deviation + 1e-6), problem.solve(deviation + 1e-6, battery=False)
    assert without.cost - cost > 0.98 * (without.cost - best.cost)


@settings(max_examples=5)
@given(seed=st.integers(0, 100), heats=st.booleans(), negative=st.sampled_from([0.0, 0.2]))
@pytest.mark.parametrize(
    "forecaster",
    [*(pytest.param(slow, marks=pytest.mark.slow) for slow in (yesterday, hourly_means)), fitted],
)
def test_no_forecast_beats_perfect_information_and_all_actions_are_feasible(
    forecaster, seed, heats, negative
):
    home = Home(hvac=Hvac(heats=heats))
    past, period = cut(noisy(7, seed, mean=10.0 if heats else 31.0, negative_share=negative), 6 * 24)
    path = planned(home, home, period, forecaster(Outlook(past, period, 1.0, 24.0)))
    cost, deviation = costs(path)
    problem = optimum_problem(home, period)
    assert cost >= problem.solve(max(deviation, problem.least_deviation)).bound - 1e-6
    energy = path.steps.state.battery_energy
    assert np.all((energy >= 0.6 - 1e-9) & (energy <= 6 + 1e-9))
    assert deviation <= problem.least_deviation + 1e-3  # comfort is held in whatever weather is believed


@settings(max_examples=3)
@given(seed=st.integers(0, 100), slot=st.integers(0, 22))
@pytest.mark.parametrize("forecaster", [yesterday, hourly_means, fitted])
def test_what_happens_later_changes_no_earlier_action(forecaster, seed, slot):
    exogenous = noisy(6, seed)

    def actions(exogenous: Exogenous) -> np.ndarray:
        past, period = cut(exogenous, 5 * 24)
        path = planned(HOME, HOME, period, forecaster(Outlook(past, period, 1.0, 12.0)))
        return np.stack([path.steps.action.battery_power, path.steps.action.hvac_power])

    as_it_was, otherwise = actions(exogenous), actions(changed_after(exogenous, 5 * 24 + slot))
    np.testing.assert_array_equal(as_it_was[:, : slot + 1], otherwise[:, : slot + 1])


def run(forecaster: Forecaster, exogenous: Exogenous, past_days: int = 5) -> Trajectory:
    past, period = cut(exogenous, past_days * 24)
    return planned(HOME, HOME, period, forecaster(Outlook(past, period, 1.0)))


def test_in_a_periodic_world_every_forecast_is_perfect():
    exogenous = periodic(7)
    expected = run(perfect, exogenous).steps.costs
    for forecaster in (yesterday, hourly_means, fitted):
        found = run(forecaster, exogenous).steps.costs
        assert np.sum(found.transaction) == pytest.approx(np.sum(expected.transaction), abs=1e-6)


def test_one_price_leaves_the_battery_at_rest():
    steps = run(yesterday, periodic(7, price=0.2)).steps
    e = steps.action.battery_power
    assert np.all(e <= 1e-9)
    assert np.sum(-e) == pytest.approx((1.2 - 0.6) * 0.95)  # what it was given is used, and no more


def test_one_price_and_a_poor_selling_price_store_the_surplus():
    exogenous = periodic(7, price=0.2)
    exogenous = replace(exogenous, selling_price=np.full(exogenous.slots, 0.02))
    steps = run(yesterday, exogenous).steps
    e, net = steps.action.battery_power, steps.grid_power - steps.action.battery_power
    assert np.max(e) > 0.1
    assert np.all(net[e > 1e-6] < 0)
    assert np.all(net[e < -1e-6] > 0)


def test_a_battery_without_capacity_is_no_trouble():
    home = replace(HOME, battery=Battery(max_energy=0.0, min_energy=0.0, initial_energy=0.0))
    period = noisy(1, 3)
    path = planned(home, home, period, perfect(whole(period, home)))
    assert np.all(path.steps.action.battery_power == 0)


def test_the_measured_temperature_corrects_a_wrong_model_and_a_disturbance():
    wrong = eqx.tree_at(lambda home: home.thermal_model, HOME, ExplicitThermalModel(efficiency=2.8))
    period = noisy(3, 4, mean=33.0)
    forecasts = perfect(whole(period, HOME, 12.0))
    kicks = np.random.default_rng(0).normal(0, 0.3, period.slots)
    quiet, kicked = (planned(wrong, HOME, period, forecasts, disturbed) for disturbed in (None, kicks))
    assert 0.0 < np.max(quiet.steps.costs.temperature_deviation) < 1.0
    assert np.all(np.isfinite(kicked.steps.state.indoor_temperature))
    assert np.mean(kicked.steps.costs.temperature_deviation) < 0.6
    assert not np.array_equal(quiet.steps.action.hvac_power, kicked.steps.action.hvac_power)


def test_the_comfort_price_stands_far_above_every_price_in_any_currency():
    period = noisy(1, 5)
    with jax.enable_x64(True):
        response = affine_response(HOME, period, HOME.reset().thermal)
    price = comfort_price(HOME, period, response)
    per_degree = 0.252 / (0.3 * 2.5)  # kWh of the slot itself that make a degree
    assert price == pytest.approx(1000 * np.max(period.buying_price) * per_degree, rel=1e-6)
    crowns = replace(period, buying_price=11 * period.buying_price, selling_price=11 * period.selling_price)
    assert comfort_price(HOME, crowns, response) == pytest.approx(11 * price)
    nothing = np.zeros(period.slots)
    free = replace(HOME, battery=Battery(ageing_cost=0.0))
    assert comfort_price(free, replace(period, buying_price=nothing, selling_price=nothing), response) == 1.0


def test_forecasts_of_another_period_are_refused():
    period = noisy(2, 6)
    with pytest.raises(HemmaError, match="shape"):
        planned(HOME, HOME, period, perfect(whole(period.window(0, 30), HOME)))
    with pytest.raises(HemmaError, match="shape"):
        planned(HOME, HOME, period, period)


def test_the_joint_plan_through_the_true_model_is_the_optimum():
    period = noisy(3, 7, mean=33.0)
    best = optimum_problem(HOME, period).solve()
    cost, deviation = costs(joint_hmpc(HOME, HOME, period))
    assert (cost, deviation) == pytest.approx((best.cost, best.deviation), abs=1e-9)


def test_the_joint_plan_through_another_model_is_what_the_real_home_makes_of_it():
    believed = eqx.tree_at(lambda home: home.thermal_model, HOME, ExplicitThermalModel(conductance=0.24))
    period = noisy(3, 8, mean=33.0)
    plan = optimum_problem(believed, period).solve()
    path = joint_hmpc(believed, HOME, period)
    np.testing.assert_allclose(path.steps.action.hvac_power, plan.actions.hvac_power, atol=1e-9)
    np.testing.assert_allclose(path.steps.action.battery_power, plan.actions.battery_power, atol=1e-6)
    cost, deviation = costs(path)
    problem = optimum_problem(HOME, period)
    assert deviation > plan.deviation + 0.1  # the real building loses more to the heat outside
    assert cost >= problem.solve(max(deviation, problem.least_deviation)).bound - 1e-6
