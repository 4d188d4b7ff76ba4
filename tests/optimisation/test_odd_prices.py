"""Selling above buying and negative prices: proven months, and SciPy's optimum on short ones."""

import dataclasses

import jax
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from test_optimum import TwoNodes, dense, traces

from hemma.control.rolling import RollingPlanner
from hemma.home import Battery, Home, Hvac, benchmark_home, replay_in_double
from hemma.optimisation.battery import schedule_battery
from hemma.optimisation.exact.convex import Convex
from hemma.optimisation.exact.modes import SlotModes
from hemma.optimisation.exact.odd_prices import ComfortPrice
from hemma.optimisation.exact.own_schedule import own_schedule
from hemma.optimisation.exact.planning import PlanningProblem
from hemma.optimisation.exact.programme import EXACT
from hemma.optimisation.exact.slot_costs import Slot, View
from hemma.optimisation.optimum import optimum_problem
from hemma.types import Exogenous


def priced(exogenous: Exogenous, kind: str) -> Exogenous:
    u = exogenous.buying_price
    odd = np.arange(exogenous.slots) % 3 == 0
    flat = np.ones(exogenous.slots)
    buy, sell = {
        "flat, sold dearer": (0.2 * flat, 0.4 * flat),
        "sold dearer": (u, 1.5 * u),
        "fixed feed-in": (u, 0.12 * flat),
        "negative": (-u, -0.9 * u),
        "negative, flat": (-0.1 * flat, -0.1 * flat),
        "negative, sold dearer still": (-u, -1.2 * u),
        "negative, flat, sold dearer still": (-0.1 * flat, -0.12 * flat),
        "some negative": (np.where(odd, -u, u), np.where(odd, -0.9 * u, 0.9 * u)),
        "some negative, fees": (np.where(odd, -u, u) + 0.02, np.where(odd, -u, u) - 0.02),
        "some sold dearer": (u, np.where(odd, 1.4, 0.8) * u),
        "few sold dearer": (u, np.where(np.arange(exogenous.slots) % 12 == 0, 1.4, 0.9) * u),
    }[kind]
    return dataclasses.replace(exogenous, buying_price=buy, selling_price=sell)


PROVEN = (
    "flat, sold dearer", "sold dearer", "fixed feed-in", "negative", "negative, flat", "some negative",
    "some negative, fees", "few sold dearer", "some sold dearer", "negative, flat, sold dearer still",
)  # fmt: skip


@pytest.mark.parametrize("kind", PROVEN)
@pytest.mark.parametrize("heats", [False, True])
def test_a_short_period_costs_what_scipy_finds_with_binaries_everywhere(kind, heats):
    home = Home(hvac=Hvac(heats=heats), battery=Battery(charging_efficiency=0.9))
    exogenous = priced(traces(10, 3, 8.0 if heats else 32.0), kind)
    problem = optimum_problem(home, exogenous)
    for extra in (0.0, 2.5):
        found = problem.solve(problem.least_deviation + extra)
        expected = dense(home, exogenous, problem.least_deviation + extra, True)
        assert found.cost == pytest.approx(expected, abs=1e-5)
        assert found.bound <= expected + 1e-6
    idle = dataclasses.replace(home, battery=Battery(max_charging_power=0.0, max_discharging_power=0.0))
    without = problem.solve(battery=False)
    assert without.cost == pytest.approx(dense(idle, exogenous, problem.least_deviation, True), abs=1e-5)


@pytest.mark.parametrize("seed", range(2))
def test_prices_of_no_kind_cost_what_scipy_finds(seed):
    """Spikes of both signs, a selling price that is now dearer and now cheaper."""
    random, exogenous = np.random.default_rng(seed), traces(36, seed, 33.0)
    spikes = np.where(random.uniform(size=36) < 0.1, random.choice([-30, 30], 36), 1)
    buy = exogenous.buying_price * spikes + random.normal(0, 0.1, 36)
    sell = buy * random.uniform(0.7, 1.4) + random.choice([0.0, 0.05, -0.05])
    exogenous = dataclasses.replace(exogenous, buying_price=buy, selling_price=sell)
    problem = optimum_problem(Home(), exogenous)
    found = problem.solve(problem.least_deviation + seed, solver=dataclasses.replace(EXACT, most_branched=0))
    expected = dense(Home(), exogenous, problem.least_deviation + seed, True)
    assert found.cost == pytest.approx(expected, rel=1e-6)
    assert -1e-6 <= (expected - found.bound) / abs(expected) <= 1e-4


SLOWLY = ("few sold dearer", "some sold dearer", "negative, flat, sold dearer still")
MONTHS = ("flat, sold dearer", "fixed feed-in", "negative", "some negative, fees")


@pytest.mark.parametrize("kind", [*MONTHS, *(pytest.param(kind, marks=pytest.mark.slow) for kind in SLOWLY)])
def test_a_month_is_proven_without_branching(kind):
    problem = optimum_problem(Home(), priced(traces(744, 1), kind))
    found = problem.solve(solver=dataclasses.replace(EXACT, most_branched=0))
    assert found.gap <= 1e-6
    assert found.bound <= found.cost + 1e-7 * abs(found.cost)  # rounding does not grow over the slots


@pytest.mark.parametrize("kind", ["flat, sold dearer", "negative, sold dearer still"])
def test_a_month_of_the_battery_alone_is_proven(kind):
    home, exogenous = Home(), priced(traces(744, 1), kind)
    with jax.enable_x64(True):
        initial = home.reset()
    assert schedule_battery(home, exogenous, np.ones(744), initial).gap <= 1e-6


def test_what_modes_leave_open_is_left_to_branch_and_bound_where_odd_slots_are_few():
    problem = optimum_problem(Home(), priced(traces(48, 0), "few sold dearer"))
    few = dataclasses.replace(EXACT, rounds=1)
    assert problem.solve(solver=dataclasses.replace(few, most_branched=0)).gap > 1e-6
    assert problem.solve(solver=few).gap <= 1e-6


powers = st.floats(-3.0, 3.0).map(lambda x: round(x, 3))


@given(
    price=st.floats(-0.3, 0.3),
    spread=st.floats(-0.1, 0.3),
    demand=powers,
    hvac=st.floats(0.0, 2.0),
    points=st.lists(st.tuples(st.floats(0.0, 2.0), powers), max_size=3),
    is_split=st.booleans(),
    at=st.tuples(st.floats(0.0, 2.0), powers),
)
def test_modes_cost_no_more_than_x1_and_as_much_where_they_shall(
    price, spread, demand, hvac, points, is_split, at
):
    """And wherever h and e are allowed, there is a mode."""
    u, v = price + spread, price
    slot = Slot(u, v, demand, 2.0)
    rows = list(slot.modes(-3.0, 3.0, View(price, hvac, is_split, tuple(points))))

    def cost(row, h, e):
        _, _, _, s, constant, least, most, low, middle, high = row
        kink, end = -demand - most, -demand - least

        def paid(e):
            return low * min(e, kink) + middle * (np.clip(e, kink, end) - kink) + high * max(e - end, 0.0)

        return constant + s * h + paid(e) - paid(0.0)

    def cheapest(h, e):
        allowed = [
            row for row in rows if row[0] - 1e-9 <= e <= row[1] + 1e-9 and row[5] - 1e-9 <= h <= row[6] + 1e-9
        ]
        return min(cost(row, h, e) for row in allowed)

    def x1(h, e):
        g = demand + h + e
        return u * g if g > 0 else v * g

    assert cheapest(*at) <= x1(*at) + 1e-9
    exact = [at] if u < v else points[-1:]
    if is_split and not points:
        exact = [*exact, (hvac, at[1])]
    for point in exact:
        assert cheapest(*point) == pytest.approx(x1(*point), abs=1e-9)


def test_quarter_hours_are_proven():
    found = optimum_problem(benchmark_home(0.25), priced(traces(192, 1), "sold dearer")).solve()
    assert found.gap <= 1e-6


@pytest.mark.parametrize(("buy", "sell"), [(-0.2, -0.3), (-0.3, -0.2), (0.2, 0.3)])
def test_a_slot_in_which_nothing_can_be_done_has_a_mode(buy, sell):
    for demand, view in ((0.0, View(0.0, 0.0, True)), (1.0, View(0.0, 0.0, False, ((0.0, 0.0),)))):
        [(low, high, *cost)] = Slot(buy, sell, demand, 0.0).modes(0.0, 0.0, view)
        assert (low, high) == (0.0, 0.0)
        assert cost[2] == pytest.approx(buy * demand)


@pytest.mark.parametrize(("full", "power"), [(True, 1.0), (False, -1.0)])
def test_a_mode_that_asks_too_much_of_the_battery_gets_what_there_is(full, power):
    """Full and told to charge, or empty and told to discharge: as much as it can, instead of no schedule."""
    home, exogenous = Home(), priced(traces(2, 0), "flat, sold dearer")
    energy = float(home.battery.max_energy if full else home.battery.min_energy)
    problem = PlanningProblem(home, exogenous, energy, np.zeros(2))
    two, nothing = np.ones(2), np.zeros(2)
    modes = SlotModes(
        two, power * two, power * two, two, 0.2 * two, nothing, nothing, nothing, np.full((2, 3), 0.2),
        np.zeros((2, 2)),
    )  # fmt: skip
    np.testing.assert_allclose(own_schedule(problem, modes, 0.0).battery, 0.0, atol=1e-9)


def test_comfort_that_costs_nothing_in_the_duals_is_given_a_price_where_the_budget_is_broken():
    free = ComfortPrice(0.0, unit=0.4)
    assert free.nearer(beyond=-1.0, expected=0.0).price == 0.0
    dear = free.nearer(beyond=1.0, expected=0.0)
    assert dear.price == 0.4
    assert dear.nearer(beyond=1.0, expected=0.0).price == 8 * 0.4
    assert dear.nearer(beyond=-1.0, expected=0.0).price == 0.2
    assert dear.nearer(beyond=-1.0, expected=0.3).price == 0.3
    assert dear.nearer(beyond=0.0, expected=0.3) == dear


def test_what_is_not_proven_is_said_and_holds():
    home, exogenous = Home(), priced(traces(10, 0, 33.0), "some sold dearer")
    problem = optimum_problem(home, exogenous)
    found = problem.solve(solver=dataclasses.replace(EXACT, rounds=1, most_branched=0))
    expected = dense(home, exogenous, problem.least_deviation, True)
    assert found.bound <= expected + 1e-6 <= found.cost + 2e-6
    assert found.gap > 1e-6


def test_a_building_with_two_temperatures_is_left_to_branch_and_bound():
    found = optimum_problem(
        Home(thermal_model=TwoNodes()), priced(traces(12, 4, 36.0), "sold dearer")
    ).solve()
    assert found.gap <= 1e-6


def test_a_rolling_planner_that_sees_all_finds_the_optimum():
    home, exogenous = Home(), priced(traces(24, 5), "flat, sold dearer")
    slots = np.minimum(np.arange(24)[:, None] + np.arange(24)[None, :], 23)
    forecasts = jax.tree.map(lambda x: np.asarray(x)[slots], exogenous)
    path = replay_in_double(home, exogenous, RollingPlanner(home, forecasts))
    best = optimum_problem(home, exogenous).solve()
    assert float(path.temperature_deviation) == pytest.approx(best.deviation, abs=1e-6)
    assert float(path.energy_cost) == pytest.approx(best.cost, rel=1e-6)


def test_convolution_shares_the_variable_in_the_cheapest_way():
    first = Convex(np.array([1.0]), np.array([[-1.0, 2.0]]), np.array([[1.0, 2.0]]))
    both = first.convolved(np.array([[3.0, 0.5]]), np.array([[1.0, 1.0]]), np.array([0.5]), 4.0)
    points = np.linspace(0.0, 4.0, 9)
    second = Convex(np.zeros(1), np.array([[0.5, 3.0]]), np.array([[1.0, 1.0]]))
    share = np.linspace(0.0, 2.0, 2001)
    for point, value in zip(points, both.at(points)[0], strict=True):
        rest = point + 0.5 - share
        inside = (rest >= -1e-9) & (rest <= 3 + 1e-9)
        costs = second.at(share[inside])[0] + first.at(np.clip(rest[inside], 0, 3))[0]
        assert value == pytest.approx(costs.min(), abs=1e-9)
