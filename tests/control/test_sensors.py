"""What controllers read when sensors fail, and the safety layer that has the last word."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hemma.control.sensors import (
    Measured,
    SafetyLayer,
    faultless,
    first_measured,
    measure_state,
    watched_replay,
)
from hemma.home import Home, Hvac, benchmark_home, replay
from hemma.home.comfort import observed_comfort_power
from hemma.home.home import HomeState
from hemma.home.thermal import ThermalState
from hemma.types import Action, Exogenous, Observation

HOME = benchmark_home()


class Held(eqx.Module):
    """A controller that holds comfort and charges when the hour is even."""

    home: Home

    def __call__(self, observation, key):
        e = jnp.where(observation.hour_of_day % 2 == 0, 1.0, -1.0)
        low, high = self.home.battery.power_limits(observation.battery_energy, self.home.slot_length)
        return Action(jnp.clip(e, low, high), observed_comfort_power(self.home, observation))


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


def state(temperature, energy):
    thermal = ThermalState(jnp.asarray(temperature), jnp.asarray(temperature))
    return HomeState(jnp.asarray(energy), thermal, jnp.zeros(()), jnp.zeros((), int))


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


def test_without_faults_a_watched_home_does_what_any_home_does():
    exogenous, controller = week(), Held(HOME)
    plain = replay(HOME, exogenous, controller, HOME.reset(), jax.random.key(0)).steps
    safety = SafetyLayer(HOME)
    watched = watched_replay(HOME, exogenous, controller, faultless(exogenous), safety, jax.random.key(0))
    for a, b in zip(jax.tree.leaves(plain), jax.tree.leaves(watched.step), strict=True):
        np.testing.assert_allclose(a, b, atol=1e-5)
    assert int(jnp.sum(watched.interventions.limited + watched.interventions.comfort)) == 0


def test_readings_err_lag_and_fail_as_they_are_told_to():
    readings = eqx.tree_at(
        lambda r: (r.temperature_error, r.energy_error, r.is_temperature_missing, r.is_energy_missing),
        faultless(week(3)),
        (
            jnp.array([0.5, 0.0, 0.0]),
            jnp.array([0.0, -9.0, 0.0]),
            jnp.array([False, True, False]),
            jnp.array([False, False, True]),
        ),
    )
    last = first_measured(state(23.0, 1.2))
    last = measure_state(HOME, state(23.0, 1.2), readings, jnp.asarray(0), last)
    assert (last.temperature, last.energy) == pytest.approx((23.5, 1.2))
    last = measure_state(HOME, state(22.0, 3.0), readings, jnp.asarray(1), last)
    assert (last.temperature, last.energy) == pytest.approx((23.5, 0.6))  # held, and not below the battery
    last = measure_state(HOME, state(21.0, 4.0), readings, jnp.asarray(2), last)
    assert (last.temperature, last.energy) == pytest.approx((21.0, 0.6))
    late = eqx.tree_at(lambda r: r.lag, faultless(week(3)), jnp.ones((), int))
    last = Measured(jnp.asarray(20.0), jnp.asarray(1.0), jnp.asarray(19.5), jnp.ones((), bool))
    last = measure_state(HOME, state(22.0, 3.0), late, jnp.asarray(0), last)
    assert (last.temperature, last.energy, last.earlier) == pytest.approx((19.5, 3.0, 22.0))


@pytest.mark.parametrize("asked", [jnp.nan, jnp.inf])
def test_what_is_no_number_becomes_rest_and_comfort_and_is_counted(asked):
    seen = observation(23.9)
    action, changed = SafetyLayer(HOME)(seen, Action(jnp.asarray(asked), jnp.asarray(asked)))
    assert float(action.battery_power) == 0
    assert float(action.hvac_power) == pytest.approx(float(observed_comfort_power(HOME, seen)))
    assert (int(changed.limited), int(changed.comfort)) == (1, 0)


def test_an_infeasible_power_is_limited_and_counted():
    action, changed = SafetyLayer(HOME)(
        observation(23.0, energy=0.6), Action(jnp.asarray(-2.0), jnp.zeros(()))
    )
    assert (float(action.battery_power), int(changed.limited)) == (0.0, 1)
    action, changed = SafetyLayer(HOME)(observation(23.0), Action(jnp.asarray(-2.0), jnp.zeros(())))
    assert (float(action.battery_power), int(changed.limited)) == (-2.0, 0)


@pytest.mark.parametrize(("heats", "needed", "idle"), [(False, 25.5, 17.5), (True, 17.5, 25.5)])
def test_the_hvac_is_taken_over_beyond_the_margin_only(heats, needed, idle):
    home = eqx.tree_at(lambda h: h.hvac, HOME, Hvac(heats=heats))
    outdoor = 5.0 if heats else 35.0
    safety, nothing, full = SafetyLayer(home), Action(*map(jnp.asarray, (0.0, 0.0))), home.hvac.max_power
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
    action, _ = SafetyLayer(HOME)(seen, Action(jnp.asarray(e), jnp.asarray(h)))
    low, high = HOME.battery.power_limits(seen.battery_energy, HOME.slot_length)
    assert float(low) <= float(action.battery_power) <= float(high)
    assert 0 <= float(action.hvac_power) <= HOME.hvac.max_power
