"""Perfect information against SciPy on a dense formulation, and what must hold for any home."""

import dataclasses

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import Bounds, LinearConstraint, milp

from hemma.control.comfort import ComfortHold
from hemma.errors import HemmaError
from hemma.home import (
    AbstractThermalModel,
    Battery,
    ExplicitThermalModel,
    Home,
    Hvac,
    Schedule,
    ThermalState,
    benchmark_home,
    replay,
)
from hemma.optimisation.optimum import optimum_problem
from hemma.types import Exogenous


def traces(slots: int, seed: int, mean: float = 31.0, negative_share: float = 0.0) -> Exogenous:
    random = np.random.default_rng(seed)
    hour = np.arange(slots) % 24.0
    price = 0.08 + 0.05 * np.sin((hour - 12) * np.pi / 12) + random.gamma(0.5, 0.05, slots)
    price = np.where(random.uniform(size=slots) < negative_share, -price, price)
    return Exogenous(
        pv_generation=np.clip(3 * np.sin((hour - 6) * np.pi / 12), 0, None) * random.uniform(0.3, 1, slots),
        load=0.3 + random.gamma(1.0, 0.4, slots),
        outdoor_temperature=mean + 6 * np.sin((hour - 9) * np.pi / 12),
        buying_price=price,
        selling_price=0.9 * price,
        hour_of_day=hour,
    )


class TwoNodes(AbstractThermalModel):
    """Air and walls: the HVAC moves the air, the air the walls, and the walls the air."""

    def __call__(self, state, drivers):
        hvac = drivers.heating_power - drivers.cooling_power
        air, walls = state.indoor_temperature, state.memory
        after = 0.6 * air + 0.3 * walls + 0.1 * drivers.outdoor_temperature + 1.5 * hvac
        return ThermalState(after, 0.05 * air + 0.93 * walls + 0.02 * drivers.outdoor_temperature)


EXPLICIT = np.array([[0.7, 0.0], [0.7, 0.0]]), np.array([0.3, 0.3]), 0.3 * 2.5 / 0.252 * np.ones(2)
TWO_NODES = np.array([[0.6, 0.3], [0.05, 0.93]]), np.array([0.1, 0.02]), np.array([1.5, 0.0])


def response(home: Home, exogenous: Exogenous, numbers) -> tuple[np.ndarray, np.ndarray]:
    """Temperature of the idle house and the matrix dT/dh of x' = A x + b T_out + c (u_heat - u_cool)."""
    A, b, c = numbers
    sign, n = 1.0 if home.hvac.heats else -1.0, exogenous.slots
    free, x = np.empty(n), np.full(2, home.initial_temperature)
    for t in range(n):
        x = A @ x + b * exogenous.outdoor_temperature[t]
        free[t] = x[0]
    impulse = [(np.linalg.matrix_power(A, k) @ (sign * c))[0] for k in range(n)]
    return free, np.array([[impulse[t - s] if t >= s else 0.0 for s in range(n)] for t in range(n)])


def dense(home: Home, exogenous: Exogenous, budget: float | None, whole: bool, numbers=EXPLICIT) -> float:
    """SciPy's optimum of x = (charge, discharge, buy, sell, h, excess, lack, charging?, buying?).

    With no budget: the least reachable deviation.
    """
    b, dt, n = home.battery, home.slot_length, exogenous.slots
    eye, low, one = np.eye(n), np.tril(np.ones((n, n))), np.ones((1, n))
    free, G = response(home, exogenous, numbers)
    demand = exogenous.load - exogenous.pv_generation
    M = 2 * (np.abs(demand).max() + b.max_charging_power + b.max_discharging_power + home.hvac.max_power)
    names = ("charge", "discharge", "buy", "sell", "h", "excess", "lack", "charging", "buying")

    def row(lower, upper, **blocks):
        height = len(next(iter(blocks.values())))
        matrix = np.hstack([blocks.get(name, np.zeros((height, n))) for name in names])
        return LinearConstraint(matrix, lower, upper)

    store = {"charge": b.charging_efficiency * dt * low, "discharge": -dt / b.discharging_efficiency * low}
    rows = [
        row(b.min_energy - b.initial_energy, b.max_energy - b.initial_energy, **store),
        row(demand, demand, charge=-eye, discharge=eye, buy=eye, sell=-eye, h=-eye),
        row(-np.inf, home.comfort.high - free, h=G, excess=-eye),
        row(home.comfort.low - free, np.inf, h=G, lack=eye),
        row(-np.inf, np.inf if budget is None else budget, excess=one, lack=one),
        row(-np.inf, 0, charge=eye, charging=-M * eye),
        row(-np.inf, M, discharge=eye, charging=M * eye),
        row(-np.inf, 0, buy=eye, buying=-M * eye),
        row(-np.inf, M, sell=eye, buying=M * eye),
    ]
    cost = np.concatenate([[b.ageing_cost] * (2 * n), exogenous.buying_price, -exogenous.selling_price])
    c = np.concatenate([dt * cost, np.zeros(5 * n)])
    if budget is None:
        c = np.repeat([0.0, 0, 0, 0, 0, 1, 1, 0, 0], n)
    most = [b.max_charging_power, b.max_discharging_power, M, M, home.hvac.max_power, 99.0, 99.0, 1.0, 1.0]
    integrality = np.repeat([0] * 7 + [int(whole)] * 2, n)
    bounds = Bounds(0, np.repeat(most, n))
    found = milp(c, constraints=rows, bounds=bounds, integrality=integrality, options={"mip_rel_gap": 1e-9})
    assert found.success
    return float(found.fun)


compiled_replay = eqx.filter_jit(replay)

HOMES = {
    "summer": (Home(), 31.0),
    "winter": (Home(hvac=Hvac(heats=True)), 8.0),
    "quarters": (benchmark_home(0.25), 34.0),
}


@pytest.mark.parametrize("kind", ["summer", "winter", "quarters"])
@pytest.mark.parametrize("extra", [0.0, 4.0])
def test_optimum_is_that_of_a_dense_linear_programme(kind, extra):
    home, mean = HOMES[kind]
    exogenous = traces(48, 1, mean)
    numbers = EXPLICIT
    if kind == "quarters":
        eps = 0.7**0.25
        numbers = np.array([[eps, 0], [eps, 0]]), np.full(2, 1 - eps), np.full(2, (1 - eps) * 2.5 / 0.252)
    problem = optimum_problem(home, exogenous)
    least = dense(home, exogenous, None, False, numbers)
    assert problem.least_deviation == pytest.approx(least, abs=1e-6)
    found = problem.solve(least + extra)
    assert found.cost == pytest.approx(dense(home, exogenous, least + extra, False, numbers), abs=1e-5)
    assert found.deviation <= least + extra + 2e-7
    without = problem.solve(least + extra, battery=False)
    idle = dataclasses.replace(home, battery=Battery(max_charging_power=0.0, max_discharging_power=0.0))
    expected = dense(idle, exogenous, least + extra, False, numbers)
    assert without.cost == pytest.approx(expected, abs=1e-5)
    assert not np.any(without.actions.battery_power)
    assert max(found.gap, without.gap) <= 1e-6


@pytest.mark.parametrize("ratio", [0.9, 1.3])
def test_optimum_with_negative_prices_or_dear_sales_is_that_of_binaries_everywhere(ratio):
    home = Home(battery=Battery(charging_efficiency=0.85))
    exogenous = traces(16, 2, negative_share=0.3 if ratio < 1 else 0.0)
    exogenous = eqx.tree_at(lambda x: x.selling_price, exogenous, ratio * exogenous.buying_price)
    problem = optimum_problem(home, exogenous)
    for budget in (0.0, 3.0):
        found = problem.solve(budget)
        expected = dense(home, exogenous, budget, True)
        assert found.cost == pytest.approx(expected, abs=1e-5)
        assert found.bound == pytest.approx(expected, abs=1e-4)
        assert dense(home, exogenous, budget, False) < expected - 0.01  # the relaxation is wrong here


def test_a_model_whose_memory_matters_is_planned_exactly():
    home = Home(thermal_model=TwoNodes())
    exogenous = traces(48, 4, 36.0)
    problem = optimum_problem(home, exogenous)
    assert problem.response.memory_matters
    assert problem.least_deviation == pytest.approx(dense(home, exogenous, None, False, TWO_NODES), abs=1e-6)
    found = problem.solve(problem.least_deviation + 2)
    expected = dense(home, exogenous, problem.least_deviation + 2, False, TWO_NODES)
    assert found.cost == pytest.approx(expected, abs=1e-5)


def test_a_model_that_is_not_affine_is_refused():
    class Saturating(ExplicitThermalModel):
        def __call__(self, state, drivers):
            return super().__call__(
                state, eqx.tree_at(lambda d: d.cooling_power, drivers, jnp.tanh(drivers.cooling_power))
            )

    with pytest.raises(HemmaError, match="affine"):
        optimum_problem(Home(thermal_model=Saturating()), traces(24, 0))


@settings(max_examples=4)
@given(seed=st.integers(0, 1000), heats=st.booleans(), negative=st.sampled_from([0.0, 0.2]))
def test_no_controller_beats_the_bound_and_more_budget_never_costs_more(seed, heats, negative):
    home = Home(hvac=Hvac(heats=heats))
    exogenous = traces(24, seed, 12.0 if heats else 33.0, negative)
    problem = optimum_problem(home, exogenous)
    found = [problem.solve(problem.least_deviation + extra) for extra in (0.0, 1.0, 20.0)]
    assert found[0].cost >= found[1].cost - 1e-6 >= found[2].cost - 2e-6
    random = np.random.default_rng(seed)
    with jax.enable_x64(True):
        wild = Schedule(
            eqx.tree_at(
                lambda a: (a.battery_power, a.hvac_power),
                found[0].actions,
                (random.uniform(-3, 3, 24), random.uniform(0, 2, 24)),
            )
        )
        for controller in (wild, ComfortHold(home), Schedule(found[1].actions)):
            path = compiled_replay(home, exogenous, controller, home.reset(), jax.random.key(0))
            reference = problem.solve(max(float(path.temperature_deviation), problem.least_deviation))
            assert float(path.energy_cost) >= reference.bound - 1e-6
            assert reference.cost <= float(path.energy_cost) + 1e-6
            assert problem.solve(reference.budget, battery=False).cost >= reference.cost - 1e-6


def test_actions_cost_on_the_home_what_the_optimum_says():
    home, exogenous = Home(), traces(48, 7, negative_share=0.1)
    found = optimum_problem(home, exogenous).solve(5.0)
    with jax.enable_x64(True):
        path = replay(home, exogenous, Schedule(found.actions), home.reset(), jax.random.key(0))
        assert float(path.energy_cost) == pytest.approx(found.cost, abs=1e-9)
        assert float(path.temperature_deviation) == pytest.approx(found.deviation, abs=1e-9)
    assert found.cost == pytest.approx(found.bound, rel=1e-4)


def test_unreachable_comfort_is_planned_with_the_least_deviation_and_refused_below_it():
    home, exogenous = Home(), traces(48, 3, 45.0)
    problem = optimum_problem(home, exogenous)
    assert problem.least_deviation > 1
    found = problem.solve()
    assert found.deviation == pytest.approx(problem.least_deviation, abs=1e-6)
    with pytest.raises(HemmaError, match="least this home can reach"):
        problem.solve(problem.least_deviation - 0.1)


def test_a_quarter_hour_month_on_which_the_dual_simplex_gives_up_is_solved():
    found = optimum_problem(benchmark_home(0.25), traces(744, 1, 34.0)).solve()
    assert found.cost == pytest.approx(found.bound, rel=1e-6)
