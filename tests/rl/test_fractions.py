"""Fractions of the feasible range and powers are two names of one action."""

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st

from hemma.home import Battery, ExplicitThermalModel, Home, Hvac
from hemma.home.comfort import observed_comfort_power
from hemma.rl.policies.fractions import FINENESS, to_fractions, to_power
from hemma.types import Action, Observation

unit = st.floats(-1, 1, width=32)
beyond = st.floats(-3, 3, width=32)
energies = st.floats(0.75, 5.875, width=32)
indoors = st.floats(15, 30, width=32)
outdoors = st.floats(-5, 42, width=32)
homes = st.builds(
    lambda charge, discharge, hvac, heats: Home(
        battery=Battery(max_charging_power=charge, max_discharging_power=discharge), hvac=Hvac(hvac, heats)
    ),
    st.floats(0.5, 5),
    st.floats(0.5, 5),
    st.floats(0.5, 5),
    st.booleans(),
)


def seen(energy=3.0, indoor=23.0, outdoor=35.0):
    """What a controller sees; load, PV and price turn no fraction into a power."""
    nothing = jnp.asarray(0.0)
    return Observation(
        nothing,
        nothing,
        jnp.asarray(energy, float),
        jnp.asarray(outdoor, float),
        jnp.asarray(indoor, float),
        nothing,
        nothing,
        nothing,
        nothing,
        jnp.asarray(0),
    )


@given(homes, energies, indoors, outdoors, beyond, beyond)
def test_any_fraction_is_a_feasible_power(home, energy, indoor, outdoor, battery, hvac):
    action = to_power(home, seen(energy, indoor, outdoor), jnp.asarray([battery, hvac]))
    feasible = home.feasible_action(home.reset(battery_energy=jnp.asarray(energy)), action)
    np.testing.assert_allclose(action.battery_power, feasible.battery_power, atol=1e-6)
    np.testing.assert_allclose(action.hvac_power, feasible.hvac_power, atol=1e-6)


@given(homes, energies, indoors, outdoors, unit, unit)
def test_fractions_survive_the_way_to_powers_and_back(home, energy, indoor, outdoor, battery, hvac):
    now = seen(energy, indoor, outdoor)
    comfort = observed_comfort_power(home, now)
    assume(min(float(comfort), float(home.hvac.max_power) - float(comfort)) > 0.01)  # kW: room on both sides
    fractions = jnp.asarray([battery, hvac])
    back = to_fractions(home, now, to_power(home, now, fractions))
    np.testing.assert_allclose(back[0], battery, atol=2e-5)
    np.testing.assert_allclose(back[1], hvac, atol=2e-3)  # float32 knows a power of kW to 1e-7


@given(homes, energies, indoors, outdoors, st.floats(0, 1, width=32))
def test_powers_survive_the_way_to_fractions_and_back(home, energy, indoor, outdoor, share):
    now, power = seen(energy, indoor, outdoor), share * home.hvac.max_power
    action = Action(jnp.asarray(0.0), jnp.asarray(power, float))
    back = to_power(home, now, to_fractions(home, now, action))
    np.testing.assert_allclose(back.hvac_power, power, atol=1e-4)


def test_zero_rests_and_one_fills_the_battery_exactly():
    home, now = Home(), seen(energy=5.0)
    assert float(to_power(home, now, jnp.asarray([0.0, -1.0])).battery_power) == 0.0
    full = to_power(home, now, jnp.asarray([1.0, 1.0]))
    after = home.battery.next_energy(now.battery_energy, full.battery_power, home.slot_length)
    np.testing.assert_allclose(after, home.battery.max_energy, atol=1e-6)
    np.testing.assert_allclose(full.hvac_power, home.hvac.max_power)


def test_a_full_battery_at_rest_has_fraction_zero():
    home = Home()
    now = seen(energy=home.battery.max_energy)
    idle = to_power(home, now, jnp.asarray([1.0, 0.0]))
    np.testing.assert_allclose(to_fractions(home, now, idle), [0.0, 0.0], atol=1e-6)


def test_the_hvac_is_counted_from_the_comfort_action_by_hand():
    """eps 0.7, eta / A = 9.9206, T_in 24, T_out 34: idle ends at 27 degC, so h_c = 3 / (0.3 * 9.9206) kW."""
    home, now = Home(), seen(indoor=24.0, outdoor=34.0)
    comfort = 3.0 / (0.3 * 2.5 / 0.252)
    share = np.sinh(FINENESS * 0.5) / np.sinh(FINENESS)
    powers = [
        float(to_power(home, now, jnp.asarray([0.0, hvac])).hvac_power) for hvac in (-1, -0.5, 0, 0.5, 1)
    ]
    expected = [0.0, comfort * (1 - share), comfort, comfort + share * (2.0 - comfort), 2.0]
    np.testing.assert_allclose(powers, expected, atol=1e-5)


def test_comfort_is_that_of_the_home_as_it_is_known():
    """Who believes in a building that loses twice the heat takes twice the power for comfort."""
    leaky = ExplicitThermalModel(conductance=0.504)
    believed = eqx.tree_at(lambda home: home.thermal_model, Home(), leaky)
    now, rest = seen(indoor=24.0, outdoor=30.0), jnp.zeros(2)
    once, twice = (to_power(home, now, rest).hvac_power for home in (Home(), believed))
    np.testing.assert_allclose(twice, 2 * once, rtol=1e-5)
