"""DNLP: another formulation and another solver must find what the proven optimum is, on the same home."""

import sys

import equinox as eqx
import jax
import numpy as np
import pytest

from hemma.data import load_austin2021
from hemma.errors import HemmaError
from hemma.home import (
    Battery,
    ComfortBand,
    ExplicitThermalModel,
    Home,
    Hvac,
    Schedule,
    benchmark_home,
    replay,
)
from hemma.optimisation import nonlinear_programme
from hemma.optimisation.nonlinear import COMFORT_SLACK, nonlinear_optimum
from hemma.optimisation.optimum import optimum_problem
from hemma.types import Exogenous


def traces(slots: int, mean: float = 31.0, selling: float = 0.9, negative: float = 0.0) -> Exogenous:
    random = np.random.default_rng(11)
    hour = np.arange(slots) % 24.0
    price = 0.1 + 0.04 * np.cos((hour - 18) * np.pi / 12) + random.exponential(0.03, slots)
    price = np.where(random.uniform(size=slots) < negative, -price, price)
    return Exogenous(
        pv_generation=np.maximum(2.5 * np.sin((hour - 6) * np.pi / 12), 0) * random.uniform(0.4, 1, slots),
        load=0.2 + random.exponential(0.5, slots),
        outdoor_temperature=mean + 5 * np.sin((hour - 9) * np.pi / 12),
        buying_price=price,
        selling_price=selling * price,
        hour_of_day=hour,
    )


def priced(exogenous: Exogenous, factor: float) -> Exogenous:
    where = lambda x: (x.buying_price, x.selling_price)  # noqa: E731
    return eqx.tree_at(where, exogenous, tuple(factor * price for price in where(exogenous)))


def agree(home: Home, exogenous: Exogenous, extra: float | None = None) -> None:
    """The same least deviation, and at its deviation the same least cost as the proof allows."""
    problem = optimum_problem(home, exogenous)
    budget = None if extra is None else problem.least_deviation + extra
    found = nonlinear_optimum(home, exogenous, budget=budget)
    expected = problem.least_deviation + (extra or 0.0)
    assert found.convex
    assert found.budget == pytest.approx(expected, abs=1e-8 * exogenous.slots)
    assert problem.least_deviation - 1e-6 <= found.deviation <= expected + 1.1 * COMFORT_SLACK
    proven = problem.solve(max(found.deviation, problem.least_deviation))
    assert proven.bound - 1e-6 <= found.cost <= proven.cost + 1e-5 * max(abs(proven.cost), 1.0)


def check_feasible(home: Home, exogenous: Exogenous, found) -> None:
    """Equations (3) to (6), by hand."""
    b, dt = home.battery, home.slot_length
    e, h = found.actions.battery_power, found.actions.hvac_power
    gain = np.where(e > 0, b.charging_efficiency * e, e / b.discharging_efficiency)
    energy = b.initial_energy + np.cumsum(gain) * dt
    np.testing.assert_allclose(found.trajectory.steps.state.battery_energy, energy, atol=1e-9)
    assert b.min_energy - 1e-9 <= energy.min() <= energy.max() <= b.max_energy + 1e-9
    assert -b.max_discharging_power <= e.min() <= e.max() <= b.max_charging_power
    assert 0 <= h.min() <= h.max() <= home.hvac.max_power


def test_it_agrees_with_the_proven_optimum_on_days_of_june():
    exogenous = load_austin2021(2).window(24 * 3, 24 * 8).exogenous
    problem = optimum_problem(Home(), exogenous)
    found = nonlinear_optimum(Home(), exogenous)
    assert found.status == "Solve_Succeeded"
    assert found.cost == pytest.approx(problem.solve().cost, rel=1e-3)
    agree(Home(), exogenous)
    agree(Home(), exogenous, extra=3.0)


@pytest.mark.slow
@pytest.mark.parametrize("home", [1, 2, 4])
def test_it_agrees_with_the_proven_optimum_over_a_month(home):
    exogenous = load_austin2021(home).window(0, 744).exogenous
    proven = optimum_problem(Home(), exogenous).solve()
    assert nonlinear_optimum(Home(), exogenous).cost == pytest.approx(proven.cost, rel=1e-3)
    agree(Home(), exogenous)


@pytest.mark.parametrize("extra", [None, 2.0])
@pytest.mark.parametrize(
    ("home", "exogenous"),
    [
        pytest.param(Home(hvac=Hvac(heats=True)), traces(36, 8.0), id="winter"),
        pytest.param(benchmark_home(0.25), traces(96, 34.0), id="quarters"),
        pytest.param(Home(), traces(36, 45.0), id="unreachable comfort"),
        pytest.param(Home(), priced(traces(36), 11.0), id="SEK"),
        pytest.param(Home(), priced(traces(36), 0.0), id="free"),
        pytest.param(Home(), traces(36, selling=0.0), id="selling for nothing"),
        pytest.param(Home(comfort=ComfortBand(22.0, 22.0)), traces(36), id="no band"),
        pytest.param(Home(battery=Battery(max_energy=1.2, min_energy=1.2)), traces(36), id="no store"),
        pytest.param(Home(hvac=Hvac(max_power=0.0)), traces(36), id="no HVAC"),
        pytest.param(
            Home(battery=Battery(max_charging_power=0.0, max_discharging_power=0.0)),
            eqx.tree_at(lambda x: x.pv_generation, traces(36), np.zeros(36)),
            id="no battery, no PV",
        ),
    ],
)
def test_it_agrees_with_the_proven_optimum_on_any_convex_home(home, exogenous, extra):
    agree(home, exogenous, extra)


def test_one_slot_by_hand():
    """0.6 kWh are left to discharge: 0.57 kWh arrive; h keeps 24 degC; the rest is bought."""
    exogenous = Exogenous(*(np.array([x]) for x in (0.0, 1.0, 35.0, 0.2, 0.18, 0.0)))
    h = (0.7 * 23 + 0.3 * 35 - 24) * 0.252 / (0.3 * 2.5)
    found = nonlinear_optimum(Home(), exogenous)
    assert found.actions.hvac_power[0] == pytest.approx(h, abs=1e-4)
    assert found.actions.battery_power[0] == pytest.approx(-0.57, abs=1e-6)
    assert found.cost == pytest.approx(0.2 * (1 + h - 0.57) + 0.001 * 0.57, abs=2e-5)


def test_what_it_reports_is_what_the_home_does():
    home, exogenous = Home(), traces(48, 36.0)
    found = nonlinear_optimum(home, exogenous, home.reset(battery_energy=4.0, indoor_temperature=27.0), 8.0)
    with jax.enable_x64(True):
        start = home.reset(battery_energy=4.0, indoor_temperature=27.0)
        path = eqx.filter_jit(replay)(home, exogenous, Schedule(found.actions), start, jax.random.key(0))
        assert float(path.energy_cost) == pytest.approx(found.cost, abs=1e-9)
        assert float(path.temperature_deviation) == pytest.approx(found.deviation, abs=1e-9)


@pytest.mark.parametrize(("selling", "negative"), [(1.3, 0.0), (0.9, 0.3), (1.2, 0.2)])
def test_where_the_programme_is_not_convex_the_schedule_is_feasible_and_the_loss_small(selling, negative):
    home = Home(battery=Battery(charging_efficiency=0.85))
    exogenous = traces(72, 31.0, selling, negative)
    problem = optimum_problem(home, exogenous)
    found = nonlinear_optimum(home, exogenous)
    assert not found.convex
    check_feasible(home, exogenous, found)
    proven, idle = problem.solve(found.deviation), problem.solve(found.deviation, battery=False)
    assert proven.bound - 1e-6 <= found.cost <= proven.cost + 0.05 * (idle.cost - proven.cost)


def test_it_repeats_itself_and_says_nothing(capfd):
    exogenous = traces(48, selling=1.1)
    first, second = (nonlinear_optimum(Home(), exogenous) for _ in range(2))
    np.testing.assert_array_equal(first.actions.battery_power, second.actions.battery_power)
    np.testing.assert_array_equal(first.actions.hvac_power, second.actions.hvac_power)
    assert capfd.readouterr() == ("", "")


class AnotherBuilding(ExplicitThermalModel):
    """Inherits from the explicit model, so that it may have other equations."""


GAP = eqx.tree_at(lambda x: x.load, traces(24), np.where(np.arange(24) == 5, np.nan, 1.0))


@pytest.mark.parametrize(
    ("home", "exogenous", "start", "budget", "message"),
    [
        (
            Home(thermal_model=AnotherBuilding()),
            traces(24),
            None,
            None,
            "explicit thermal model, got Another",
        ),
        (Home(), traces(24, 45.0), None, 1.0, r"budget of at least \d+.* got 1; leave the budget out"),
        (Home(), traces(24), None, float("nan"), "got nan"),
        (Home(), traces(24), Home().reset(battery_energy=7.0), None, "from 0.6 to 6 kWh, got 7"),
        (Home(), GAP, None, None, "got nan for load in slot 5"),
    ],
)
def test_what_cannot_be_solved_is_refused(home, exogenous, start, budget, message):
    with pytest.raises(HemmaError, match=message):
        nonlinear_optimum(home, exogenous, start, budget)


def test_a_solver_that_does_not_converge_is_an_error_with_a_cure(monkeypatch):
    monkeypatch.setitem(nonlinear_programme.OPTIONS, "ipopt.max_iter", 3)
    with pytest.raises(HemmaError, match=r"reports Maximum_Iterations_Exceeded; .*proven optimum"):
        nonlinear_optimum(Home(), traces(24))


def test_without_casadi_it_says_how_to_install_it(monkeypatch):
    assert nonlinear_programme.casadi_is_installed()
    monkeypatch.setitem(sys.modules, "casadi", None)
    assert not nonlinear_programme.casadi_is_installed()
    with pytest.raises(HemmaError, match=r"pip install 'hemma\[nlp\]'"):
        nonlinear_optimum(Home(), traces(24))
