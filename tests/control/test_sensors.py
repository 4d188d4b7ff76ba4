"""What controllers read when sensors fail, and the safety layer that has the last word."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hemma.control.estimation import StateEstimator
from hemma.control.safety import SafetyLayer
from hemma.control.sensors import Sensors, faultless
from hemma.home import AbstractController, Home, Hvac, benchmark_home, replay_in_double
from hemma.home.comfort import observed_comfort_power
from hemma.types import Action, Exogenous, Observation

HOME = benchmark_home()


class Held(AbstractController):
    """A controller that holds comfort and charges when the hour is even."""

    home: Home

    def __call__(self, observation, memory, key):
        e = jnp.where(observation.hour_of_day % 2 == 0, 1.0, -1.0)
        low, high = self.home.battery.power_limits(observation.battery_energy, self.home.slot_length)
        return Action(jnp.clip(e, low, high), observed_comfort_power(self.home, observation)), memory


def week(slots=48):
    hour = jnp.arange(slots) % 24.0
    return Exogenous(
        pv_generation=jnp.clip(jnp.sin((hour - 6) * jnp.pi / 12), 0),
        load=0.5 + 0.1 * hour / 24,
        outdoor_temperature=30 + 5 * jnp.sin((hour - 9) * jnp.pi / 12),
        buying_price=0.1 + 0.01 * hour,
        selling_price=0.09 + 0.009 * hour,
        hour_of_day=hour,
    )


GUARD = SafetyLayer(Held(HOME), HOME)


def observation(temperature, energy=3.0, outdoor=32.0):
    zero = jnp.zeros(())
    return Observation(
        zero,
        zero,
        jnp.asarray(energy),
        jnp.asarray(outdoor),
        jnp.asarray(temperature),
        zero,
        zero,
        zero,
        zero,
        jnp.zeros((), int),
    )


def watched(controller, readings, adapts=False, believed=HOME):
    """As under faults: sensors, state estimation, safety layer, controller."""
    guarded = SafetyLayer(controller, believed)
    return Sensors(StateEstimator(guarded, believed, adapts), readings, HOME.battery)


@pytest.mark.parametrize("adapts", [False, True])
def test_without_faults_a_watched_home_does_what_any_home_does(adapts):
    exogenous, controller = week(), Held(HOME)
    plain = replay_in_double(HOME, exogenous, controller).steps
    path = replay_in_double(HOME, exogenous, watched(controller, faultless(exogenous), adapts))
    for a, b in zip(jax.tree.leaves(plain), jax.tree.leaves(path.steps), strict=True):
        np.testing.assert_allclose(a, b, atol=1e-9)
    changed = path.memory.inner.inner.own
    assert (int(changed.limited), int(changed.comfort)) == (0, 0)


class Diary(AbstractController):
    """Remembers T_in and E of the last slots as it saw them."""

    def start(self):
        return jnp.zeros((3, 2))

    def __call__(self, observation, memory, key):
        seen = jnp.stack([observation.indoor_temperature, observation.battery_energy])
        nothing = jnp.zeros_like(observation.indoor_temperature)
        return Action(nothing, nothing), jnp.concatenate([memory[1:], seen[None]])


class SlowDiary(Diary):
    """The same in the Python loop."""

    @property
    def is_traceable(self):
        return False


def seen_by(diary, states, change):
    """What is seen of a home that stands at these (T_in, E)."""
    exogenous = week(3)
    sensors = Sensors(diary, eqx.tree_at(change[0], faultless(exogenous), change[1]), HOME.battery)
    memory, key = sensors.start(), jax.random.key(0)
    for slot, (temperature, energy) in enumerate(states):
        seen = observation(temperature, energy)
        seen = eqx.tree_at(lambda o: o.slot, seen, jnp.asarray(slot))
        _, memory = sensors(seen, memory, key)
    return memory.inner


def test_readings_err_lag_and_fail_as_they_are_told_to():
    change = (
        lambda r: (r.temperature_error, r.energy_error, r.is_temperature_missing, r.is_energy_missing),
        (
            jnp.array([0.5, 0.0, 0.0]),
            jnp.array([0.0, -9.0, 0.0]),
            jnp.array([False, True, False]),
            jnp.array([False, False, True]),
        ),
    )
    states = [(23.0, 1.2), (22.0, 3.0), (21.0, 4.0)]
    missing = seen_by(Diary(), states, change)
    np.testing.assert_allclose(missing, [[23.5, 1.2], [np.nan, 0.6], [21.0, np.nan]], rtol=1e-6)
    held = seen_by(StateEstimator(Diary(), HOME), states, change).inner
    np.testing.assert_allclose(held, [[23.5, 1.2], [23.5, 0.6], [21.0, 0.6]], rtol=1e-6)
    late = seen_by(Diary(), states, (lambda r: r.lag, jnp.ones((), int)))
    np.testing.assert_allclose(late, [[23.0, 1.2], [23.0, 3.0], [22.0, 4.0]], rtol=1e-6)


def test_a_home_that_was_never_read_before_is_read_in_its_first_slot():
    everything = (lambda r: (r.is_temperature_missing, r.is_energy_missing), (jnp.ones(3, bool),) * 2)
    held = seen_by(StateEstimator(Diary(), HOME), [(23.0, 1.2), (22.0, 3.0), (21.0, 4.0)], everything)
    np.testing.assert_allclose(held.inner, [[23.0, 1.2]] * 3, rtol=1e-6)


@pytest.mark.parametrize("adapts", [False, True])
def test_the_compiled_and_the_python_loop_do_the_same(adapts):
    exogenous = week(30)
    change = (lambda r: r.is_temperature_missing, jnp.arange(30) % 4 == 2)
    readings = eqx.tree_at(change[0], faultless(exogenous), change[1])
    kicks = np.random.default_rng(0).normal(0, 0.3, 30)
    fast, slow = (
        replay_in_double(HOME, exogenous, watched(diary, readings, adapts), disturbances=kicks)
        for diary in (Diary(), SlowDiary())
    )
    for a, b in zip(jax.tree.leaves(fast), jax.tree.leaves(slow), strict=True):
        np.testing.assert_allclose(a, b, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("asked", [jnp.nan, jnp.inf])
def test_what_is_no_number_becomes_rest_and_comfort_and_is_counted(asked):
    seen = observation(23.9)
    action, changed = GUARD.guarded(seen, Action(jnp.asarray(asked), jnp.asarray(asked)))
    assert float(action.battery_power) == 0
    assert float(action.hvac_power) == pytest.approx(float(observed_comfort_power(HOME, seen)))
    assert (int(changed.limited), int(changed.comfort)) == (1, 0)


def test_an_infeasible_power_is_limited_and_counted():
    action, changed = GUARD.guarded(observation(23.0, energy=0.6), Action(jnp.asarray(-2.0), jnp.zeros(())))
    assert (float(action.battery_power), int(changed.limited)) == (0.0, 1)
    action, changed = GUARD.guarded(observation(23.0), Action(jnp.asarray(-2.0), jnp.zeros(())))
    assert (float(action.battery_power), int(changed.limited)) == (-2.0, 0)


@pytest.mark.parametrize(("heats", "needed", "idle"), [(False, 25.5, 17.5), (True, 17.5, 25.5)])
def test_the_hvac_is_taken_over_beyond_the_margin_only(heats, needed, idle):
    home = eqx.tree_at(lambda h: h.hvac, HOME, Hvac(heats=heats))
    outdoor = 5.0 if heats else 35.0
    safety, nothing, full = (
        SafetyLayer(Held(home), home).guarded,
        Action(*map(jnp.asarray, (0.0, 0.0))),
        home.hvac.max_power,
    )
    seen = observation(needed, outdoor=outdoor)
    action, changed = safety(seen, nothing)
    assert float(action.hvac_power) == pytest.approx(float(observed_comfort_power(home, seen)))
    assert int(changed.comfort) == 1
    action, changed = safety(observation(idle, outdoor=outdoor), Action(jnp.zeros(()), jnp.asarray(full)))
    assert (float(action.hvac_power), int(changed.comfort)) == (0.0, 1)
    inside = 24.9 if not heats else 18.1
    action, changed = safety(observation(inside, outdoor=outdoor), nothing)
    assert (float(action.hvac_power), int(changed.comfort)) == (0.0, 0)


@settings(max_examples=100)
@given(
    e=st.floats(width=32),
    h=st.floats(width=32),
    temperature=st.floats(-10, 50),
    energy=st.floats(0.6, 6.0),
)
def test_whatever_is_asked_the_home_gets_numbers_that_it_can_carry_out(e, h, temperature, energy):
    seen = observation(temperature, energy)
    action, _ = GUARD.guarded(seen, Action(jnp.asarray(e), jnp.asarray(h)))
    low, high = HOME.battery.power_limits(seen.battery_energy, HOME.slot_length)
    assert float(low) <= float(action.battery_power) <= float(high)
    assert 0 <= float(action.hvac_power) <= HOME.hvac.max_power
