"""The home against a loop written from the paper, and what must hold for any action."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

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
from hemma.types import Action, Exogenous

REPLAY = jax.jit(replay)


def traces(slots, seed=0):
    rng = np.random.default_rng(seed)
    price = rng.uniform(-0.05, 0.3, slots)
    return Exogenous(
        pv_generation=rng.uniform(0, 3, slots),
        load=rng.uniform(0, 3, slots),
        outdoor_temperature=rng.uniform(10, 42, slots),
        buying_price=price,
        selling_price=0.9 * price,
        hour_of_day=np.arange(slots) % 24.0,
    )


def random_actions(slots, seed=1):
    rng = np.random.default_rng(seed)
    return Action(rng.uniform(-5, 5, slots), rng.uniform(-1, 3, slots))


def paper_loop(traces, actions):
    """Equations (1) to (8) with the constants of docs/paper.md, one slot after the other, one hour each."""
    E, T = 1.2, 23.0
    rows = []
    for t in range(traces.slots):
        p, load, T_out = traces.pv_generation[t], traces.load[t], traces.outdoor_temperature[t]
        e, h = actions.battery_power[t], actions.hvac_power[t]
        h = min(max(h, 0.0), 2.0)
        if e > 0:
            e = min(e, 3.0, (6.0 - E) / 0.95)
            E = E + 0.95 * e
        else:
            e = max(e, -3.0, -(E - 0.6) * 0.95)
            E = E + e / 0.95
        g = h + e + load - p
        X1 = (traces.buying_price[t] if g > 0 else traces.selling_price[t]) * g
        X2 = 0.001 * abs(e)
        T = 0.7 * T + 0.3 * (T_out - 2.5 / 0.252 * h)
        X3 = max(T - 24.0, 0.0) + max(19.0 - T, 0.0)
        rows.append((e, h, g, E, T, X1, X2, X3))
    return np.array(rows).T


def as_rows(trajectory):
    step = trajectory.steps
    state, costs = step.state, step.costs
    columns = [step.action.battery_power, step.action.hvac_power, step.grid_power, state.battery_energy]
    columns += [state.indoor_temperature, costs.transaction, costs.ageing, costs.temperature_deviation]
    return np.stack(columns)


def test_compiled_home_agrees_with_the_paper_over_a_month_in_double_precision():
    exogenous, actions = traces(744), random_actions(744)
    with jax.enable_x64(True):
        home = benchmark_home()
        done = REPLAY(home, exogenous, Schedule(actions), home.reset(), jax.random.key(0))
        np.testing.assert_allclose(as_rows(done), paper_loop(exogenous, actions), atol=1e-10)


def test_compiled_home_agrees_with_the_paper_over_a_month_in_single_precision():
    exogenous, actions = traces(744), random_actions(744)
    home = benchmark_home()
    done = REPLAY(home, exogenous, Schedule(actions), home.reset(), jax.random.key(0))
    np.testing.assert_allclose(as_rows(done), paper_loop(exogenous, actions), rtol=1e-5, atol=1e-5)


numbers = st.floats(-1e3, 1e3, width=32)
sizes = st.integers(0, 40).map(lambda eighths: eighths / 8)
homes = st.builds(
    lambda low, width, charge, discharge, eta, hvac, heats: Home(
        battery=Battery(low + width, low, low, charge, discharge, eta, eta), hvac=Hvac(hvac, heats)
    ),
    *[sizes, sizes, sizes, sizes, st.floats(0.5, 1), sizes, st.booleans()],
)


@given(homes, numbers, numbers, st.floats(0, 1), st.integers(0, 99))
def test_limits_and_energy_balance_hold_for_any_action(home, e, h, level, seed):
    battery = home.battery
    with jax.enable_x64(True):
        energy = battery.min_energy + level * (battery.max_energy - battery.min_energy)
        exogenous = jax.tree.map(lambda x: jnp.asarray(x[0]), traces(1, seed))
        before = home.reset(battery_energy=energy)
        step = home.step(
            before, exogenous, Action(jnp.asarray(float(e)), jnp.asarray(float(h))), jnp.zeros(())
        )
    power, after = float(step.action.battery_power), float(step.state.battery_energy)
    assert battery.min_energy - 1e-9 <= after <= battery.max_energy + 1e-9
    assert -battery.max_discharging_power - 1e-9 <= power <= battery.max_charging_power + 1e-9
    assert 0 <= float(step.action.hvac_power) <= home.hvac.max_power
    supply = float(step.grid_power) + float(exogenous.pv_generation)
    demand = float(step.action.hvac_power) + power + float(exogenous.load)
    assert abs(supply - demand) < 1e-9
    stored = after - energy
    assert stored <= power * home.slot_length + 1e-9, "no energy from nothing"
    expected = battery.charging_efficiency * power if power > 0 else power / battery.discharging_efficiency
    np.testing.assert_allclose(stored, expected, atol=1e-6)


@given(homes, numbers, numbers)
def test_projecting_twice_is_projecting_once(home, e, h):
    state = home.reset()
    once = home.feasible_action(state, Action(jnp.asarray(e), jnp.asarray(h)))
    twice = home.feasible_action(state, once)
    assert once.battery_power == twice.battery_power
    assert once.hvac_power == twice.hvac_power


@given(st.floats(0.1, 5), st.floats(0.0, 2), st.floats(0.0, 2))
def test_more_cooling_never_warms_and_more_heating_never_cools(hours, low, high):
    low, high = sorted((low, high))
    exogenous = jax.tree.map(lambda x: jnp.asarray(x[0], float), traces(1))
    for heats, sign in ((False, -1), (True, 1)):
        home = Home(
            thermal_model=ExplicitThermalModel().at_slot_length(hours),
            hvac=Hvac(heats=heats),
            slot_length=hours,
        )
        less, more = (
            home.step(home.reset(), exogenous, Action(jnp.zeros(()), jnp.asarray(h, float)), jnp.zeros(()))
            for h in (low, high)
        )
        change = float(more.state.indoor_temperature - less.state.indoor_temperature)
        assert sign * change >= -1e-5


def test_four_quarters_of_an_hour_are_one_hour():
    """Constant inputs: energies, temperatures and costs do not depend on how the hour is cut."""
    hour, quarters = traces(1), jax.tree.map(lambda x: np.repeat(x, 4), traces(1))
    with jax.enable_x64(True):
        whole, cut = benchmark_home(1.0), benchmark_home(0.25)
        one = Schedule(Action(np.array([1.0]), np.array([0.7])))
        four = Schedule(Action(np.full(4, 1.0), np.full(4, 0.7)))
        a = replay(whole, hour, one, whole.reset(), jax.random.key(0))
        b = replay(cut, quarters, four, cut.reset(), jax.random.key(0))
        np.testing.assert_allclose(a.energy_cost, b.energy_cost, rtol=1e-12)
    np.testing.assert_allclose(a.steps.state.battery_energy[-1], b.steps.state.battery_energy[-1], rtol=1e-12)
    temperatures = [x.steps.state.indoor_temperature[-1] for x in (a, b)]
    np.testing.assert_allclose(*temperatures, rtol=1e-12)


def test_the_cost_is_differentiable_in_the_schedule():
    exogenous = jax.tree.map(lambda x: jnp.asarray(x, float), traces(24))
    home = benchmark_home()
    actions = Action(jnp.full(24, 0.01), jnp.full(24, 0.5))

    def cost(actions):
        return replay(home, exogenous, Schedule(actions), home.reset(), jax.random.key(0)).energy_cost

    gradient = jax.grad(cost)(actions)
    bought = exogenous.load - exogenous.pv_generation + 0.51 > 0
    price = jnp.where(bought, exogenous.buying_price, exogenous.selling_price)
    np.testing.assert_allclose(gradient.hvac_power, price, rtol=1e-4, atol=1e-6)


def test_homes_are_stacked_and_vmapped():
    exogenous = jax.tree.map(lambda x: jnp.asarray(x, float), traces(48))
    several = [
        Home(battery=Battery(max_energy=size), comfort=ComfortBand(high=24.0)) for size in (2.0, 6.0, 9.0)
    ]
    schedule = Schedule(jax.tree.map(jnp.asarray, random_actions(48)))

    def cost(home):
        return replay(home, exogenous, schedule, home.reset(), jax.random.key(0)).energy_cost

    stacked = jax.tree.map(lambda *x: jnp.stack([jnp.asarray(y, float) for y in x]), *several)
    together = jax.vmap(cost)(stacked)
    np.testing.assert_allclose(together, [cost(home) for home in several], rtol=1e-5)


def test_disturbance_is_off_by_default_and_has_its_deviation_when_on():
    calm, rough = Home(), Home(disturbance_deviation=0.5)
    assert not np.any(calm.disturbances(jax.random.key(0), 100))
    np.testing.assert_allclose(np.std(rough.disturbances(jax.random.key(0), 20_000)), 0.5, rtol=0.03)


@pytest.mark.parametrize(
    ("build", "message"),
    [
        (lambda: Battery(max_energy=-1.0), "battery: expected max_energy >= min_energy, got -1.0"),
        (lambda: Battery(charging_efficiency=0.0), "0 < charging_efficiency <= 1, got 0.0"),
        (lambda: Battery(initial_energy=9.0), "min_energy <= initial_energy <= max_energy, got 9.0"),
        (lambda: Battery(ageing_cost=float("nan")), "ageing_cost >= 0, got nan"),
        (lambda: Hvac(max_power=-2.0), "hvac: expected max_power >= 0, got -2.0"),
        (lambda: ComfortBand(25.0, 24.0), "low <= high"),
        (lambda: ExplicitThermalModel(inertia=1.0), "0 < inertia < 1, got 1.0"),
        (lambda: benchmark_home(0.0), "slot_length > 0, got 0.0"),
    ],
)
def test_what_cannot_exist_is_refused_by_name(build, message):
    with pytest.raises(HemmaError, match=message.replace("(", r"\(")):
        build()
