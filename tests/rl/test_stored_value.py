"""The battery that does what pays at the worth of a stored kWh."""

import jax
import jax.numpy as jnp
import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from paid_worlds import played

from hemma.home import Battery, Home, HomeState
from hemma.rl.explicit import ExplicitLearning, ExplicitSettings
from hemma.rl.policies.exploration import Exploration
from hemma.rl.policies.scaling import StateScaler
from hemma.rl.policies.spaces import STORED_VALUE
from hemma.rl.policies.stored_value import FAR, menu
from hemma.rl.ppo import PPOSettings
from hemma.types import Action, Exogenous, Observation

SCALER = StateScaler(jnp.zeros(6), jnp.ones(6).at[5].set(0.05))
DEVIATION = jnp.asarray([0.3, 0.1])
batteries = st.builds(
    lambda charge, discharge, into, out, wear: Battery(
        max_charging_power=charge,
        max_discharging_power=discharge,
        charging_efficiency=into,
        discharging_efficiency=out,
        ageing_cost=wear,
    ),
    st.floats(0.5, 5),
    st.floats(0.5, 5),
    st.floats(0.7, 1.0),
    st.floats(0.7, 1.0),
    st.floats(0, 0.05),
)
slots = st.fixed_dictionaries(
    {
        "pv": st.floats(0, 5),
        "load": st.floats(0, 5),
        "energy": st.floats(0.6, 6.0),
        "price": st.floats(0.02, 0.5),
        "sold": st.floats(0.3, 1.0),
        "dt": st.sampled_from([1.0, 0.5, 0.25]),
    }
)


def seen(pv=0.0, load=1.0, energy=3.0, price=0.1, sold=0.9, dt=1.0):
    """A comfortable home: the HVAC has nothing to do."""
    values = (pv, load, energy, 20.0, 21.0, price, sold * price, 12.0, 0.0)
    return Observation(*(jnp.asarray(v, float) for v in values), jnp.zeros((), int))


def decided(worth, fraction=0.0):
    """A decision: the worth [currency/kWh] as the scaler scales it, and the HVAC's fraction."""
    return jnp.stack([SCALER.price(jnp.asarray(worth, float)), jnp.asarray(fraction, float)])


def lost(home, slot, power, worth):
    """X1 + X2 of the slot less what the energy gained is worth, in NumPy: what the battery is to minimise."""
    battery, dt = home.battery, slot["dt"]
    grid = power + slot["load"] - slot["pv"]
    price = np.where(grid > 0, slot["price"], slot["sold"] * slot["price"])
    into, out = float(battery.charging_efficiency), float(battery.discharging_efficiency)
    gained = np.where(power > 0, into * power, power / out)
    return dt * (price * grid + float(battery.ageing_cost) * np.abs(power) - worth * gained)


@given(batteries, slots, st.floats(0, 1))
def test_the_battery_does_what_pays_most_at_the_worth(battery, slot, worth):
    home = Home(battery=battery, slot_length=slot["dt"])
    deed = STORED_VALUE.carry_out(home, seen(**slot), decided(worth), SCALER)
    low, high = (float(x) for x in battery.power_limits(jnp.asarray(slot["energy"]), slot["dt"]))
    tried = np.linspace(low, high, 2001)
    best = lost(home, slot, tried, worth).min()
    assert lost(home, slot, float(deed.action.battery_power), worth) <= best + 1e-5


def test_the_menu_by_hand():
    """Load 1 kW, no PV: discharge, cover, rest, charge; worth (u- - k) eta, (u - k) eta, (u + k) / eta."""
    offered = menu(Home(), seen(), jnp.zeros(()), SCALER)
    np.testing.assert_allclose(offered.powers, [-(3.0 - 0.6) * 0.95, -1.0, 0.0, 3.0], rtol=1e-6)
    edges = np.asarray([(0.09 - 0.001) * 0.95, (0.1 - 0.001) * 0.95, (0.1 + 0.001) / 0.95])
    np.testing.assert_allclose(offered.edges, np.arcsinh(edges / 0.05), rtol=1e-6)
    sunny = menu(Home(), seen(pv=3.0), jnp.zeros(()), SCALER)
    np.testing.assert_allclose(sunny.powers, [-(3.0 - 0.6) * 0.95, 0.0, 2.0, 3.0], rtol=1e-6)
    np.testing.assert_allclose(sunny.edges[1], np.arcsinh((0.09 + 0.001) / 0.95 / 0.05), rtol=1e-6)


def test_ways_to_discharge_an_empty_battery_are_one():
    deed = STORED_VALUE.carry_out(Home(), seen(energy=0.6), decided(0.01), SCALER)
    assert float(deed.action.battery_power) == 0.0
    upper = np.arcsinh((0.1 + 0.001) / 0.95 / 0.05)
    np.testing.assert_allclose(deed.reach, [-FAR, upper], rtol=1e-6)


@given(batteries, slots, st.floats(-4, 4))
def test_chances_of_different_powers_sum_to_one(battery, slot, mean):
    home, observation = Home(battery=battery, slot_length=slot["dt"]), seen(**slot)
    offered = menu(home, observation, jnp.zeros(()), SCALER)
    chances = {}
    for power in np.asarray(offered.powers):
        reach = offered.reach(jnp.asarray(power))
        both = jnp.asarray([mean, 0.0])
        density = STORED_VALUE.log_density(jnp.zeros(2), reach, both, DEVIATION)
        chances[tuple(np.asarray(reach))] = float(jnp.exp(density)) * 0.1 * np.sqrt(2 * np.pi)
    assert abs(sum(chances.values()) - 1.0) < 2e-3


def test_the_density_is_the_frequency_with_which_a_power_is_taken():
    home, observation, mean = Home(), seen(), jnp.asarray([1.5, 0.0])
    noise = STORED_VALUE.noise(jax.random.key(0), (20_000,)) * jnp.asarray(
        [0.3, 0.0]
    )  # the HVAC is load, too
    taken = jax.vmap(lambda d: STORED_VALUE.carry_out(home, observation, d, SCALER))(mean + noise)
    powers = np.asarray(taken.action.battery_power)
    for power in np.unique(powers):
        rows = powers == power
        reach = taken.reach[np.flatnonzero(rows)[0]]
        battery = STORED_VALUE.log_density(jnp.zeros(2), reach, mean, DEVIATION)
        hvac = -np.log(0.1 * np.sqrt(2 * np.pi))
        assert abs(float(jnp.exp(battery - hvac)) - rows.mean()) < 0.015


@given(slots, st.floats(0, 1))
def test_what_was_done_is_shown_as_what_was_done(slot, worth):
    home, observation = Home(slot_length=slot["dt"]), seen(**slot)
    done = STORED_VALUE.carry_out(home, observation, decided(worth), SCALER)
    shown = STORED_VALUE.shown(home, observation, done.action, SCALER)
    np.testing.assert_allclose(shown.fractions, done.fractions, atol=1e-5)
    np.testing.assert_allclose(shown.reach, done.reach, rtol=1e-6)
    assert float(shown.action.battery_power) == float(done.action.battery_power)


def test_what_no_worth_does_is_shown_as_the_nearest_that_one_does():
    shown = STORED_VALUE.shown(Home(), seen(), Action(jnp.asarray(2.0), jnp.asarray(0.0)), SCALER)
    assert float(shown.action.battery_power) == 3.0
    np.testing.assert_allclose(shown.fractions[0], 1.0, rtol=1e-6)


@given(st.floats(-50, 50), st.floats(-3, 3), st.floats(0.001, 3))
def test_the_density_has_a_finite_gradient_however_far_the_mean_is(mean, low, length):
    reach = jnp.asarray([low, low + length])

    def density(worth):
        return STORED_VALUE.log_density(jnp.zeros(2), reach, jnp.stack([worth, 0.0 * worth]), DEVIATION)

    value, slope = jax.value_and_grad(density)(jnp.asarray(mean))
    assert np.isfinite(float(value))
    assert np.isfinite(float(slope))
    if abs(mean) > 10:
        assert float(slope) * mean < 0, "the mean must be able to come back"


def test_what_is_tried_is_read_as_what_is_feasible():
    """A nearly full battery takes a third of a full charge, whatever is asked of it."""
    room = (6.0 - 5.05) / 0.95
    tried = STORED_VALUE.tried(Home(), seen(energy=5.05), jnp.asarray([1.0, 0.0]))
    np.testing.assert_allclose(tried.action.battery_power, room, rtol=1e-4)
    np.testing.assert_allclose(tried.fractions, [room / 3.0, 0.0], rtol=1e-4)
    half = STORED_VALUE.tried(Home(), seen(), jnp.asarray([-0.5, 0.0]))
    np.testing.assert_allclose(half.action.battery_power, -1.5, rtol=1e-6)


def test_an_error_is_the_way_into_the_reach():
    reach = jnp.asarray([[0.0, 1.0], [0.0, 1.0], [0.0, 1.0]])
    mean = jnp.asarray([[-0.5, 0.2], [0.4, 0.2], [1.25, 0.2]])
    error = STORED_VALUE.error(mean, jnp.zeros((3, 2)), reach)
    np.testing.assert_allclose(error, [[-0.5, 0.2], [0.0, 0.2], [0.25, 0.2]], atol=1e-6)


def test_a_dear_hour_is_sold_into_whatever_was_learned():
    """A price spike is beyond any worth learned in usual hours: the battery discharges at full power."""
    deed = STORED_VALUE.carry_out(Home(), seen(price=9.0), decided(0.12), SCALER)
    assert float(deed.action.battery_power) < -2.0


def test_the_same_worth_is_the_same_law_in_slots_of_any_length():
    """Four quarters of an hour at one worth charge what an hour does, until the battery is full."""
    home, quarter = Home(), Home(slot_length=0.25)
    exogenous = Exogenous(*(jnp.asarray(v) for v in (0.0, 1.0, 20.0, 0.05, 0.045, 12.0)))
    state, hour = quarter.reset(2.0, 21.0), home.reset(2.0, 21.0)
    assert isinstance(state, HomeState)
    for _ in range(4):
        observation = seen(energy=state.battery_energy, price=0.05)
        deed = STORED_VALUE.carry_out(quarter, observation, decided(0.2), SCALER)
        state = quarter.step(state, exogenous, deed.action, jnp.zeros(())).state
    deed = STORED_VALUE.carry_out(home, seen(energy=2.0, price=0.05), decided(0.2), SCALER)
    whole = home.step(hour, exogenous, deed.action, jnp.zeros(())).state
    np.testing.assert_allclose(state.battery_energy, whole.battery_energy, rtol=1e-5)


def test_reinforcement_fills_the_battery_at_night_for_the_day():
    ppo = PPOSettings(rollouts=32, slots=24, hidden=(16,), learning_rate=3e-3, value_learning_rate=3e-3)
    settings = ExplicitSettings(75, Exploration((0.3, 0.3), (0.2, 0.1)), ppo)
    acted = played(ExplicitLearning(settings, STORED_VALUE), comfort_price=50.0)
    hour = np.arange(acted.action.battery_power.shape[0]) % 24
    energy = np.asarray(acted.state.battery_energy)
    assert energy[hour == 5].mean() > energy[hour == 17].mean() + 4.0
