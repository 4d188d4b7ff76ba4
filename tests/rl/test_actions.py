"""Fractions of the feasible range and powers are two names of one action."""

import jax.numpy as jnp
import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from hemma.home import Battery, Home, Hvac
from hemma.rl.actions import to_fractions, to_power

unit = st.floats(-1, 1, width=32)
homes = st.builds(
    lambda charge, discharge, hvac: Home(
        battery=Battery(max_charging_power=charge, max_discharging_power=discharge), hvac=Hvac(hvac)
    ),
    st.floats(0.5, 5),
    st.floats(0.5, 5),
    st.floats(0.5, 5),
)


@given(homes, st.floats(0.625, 6, width=32), st.floats(-3, 3, width=32), st.floats(-3, 3, width=32))
def test_any_fraction_is_a_feasible_power(home, energy, battery, hvac):
    energy = jnp.asarray(energy)
    action = to_power(home, energy, jnp.asarray([battery, hvac]))
    feasible = home.feasible_action(home.reset(battery_energy=energy), action)
    np.testing.assert_allclose(action.battery_power, feasible.battery_power, atol=1e-6)
    np.testing.assert_allclose(action.hvac_power, feasible.hvac_power, atol=1e-6)


@given(homes, st.floats(0.75, 5.875, width=32), unit, unit)
def test_fractions_survive_the_way_to_powers_and_back(home, energy, battery, hvac):
    fractions = jnp.asarray([battery, hvac])
    back = to_fractions(home, jnp.asarray(energy), to_power(home, jnp.asarray(energy), fractions))
    np.testing.assert_allclose(back, fractions, atol=2e-5)


def test_zero_rests_and_one_fills_the_battery_exactly():
    home = Home()
    energy = jnp.asarray(5.0)
    assert float(to_power(home, energy, jnp.asarray([0.0, -1.0])).battery_power) == 0.0
    full = to_power(home, energy, jnp.asarray([1.0, 1.0]))
    after = home.battery.next_energy(energy, full.battery_power, home.slot_length)
    np.testing.assert_allclose(after, home.battery.max_energy, atol=1e-6)
    np.testing.assert_allclose(full.hvac_power, home.hvac.max_power)


def test_a_full_battery_at_rest_has_fraction_zero():
    home = Home()
    full = jnp.asarray(home.battery.max_energy)
    idle = to_power(home, full, jnp.asarray([1.0, 0.0]))
    np.testing.assert_allclose(to_fractions(home, full, idle), [0.0, 0.0], atol=1e-6)
