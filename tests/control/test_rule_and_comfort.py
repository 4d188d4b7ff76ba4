"""Facts about the thermostat rule and the comfort law."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hemma.control.comfort import ComfortHold
from hemma.control.rule import Rule
from hemma.home import ComfortBand, ExplicitThermalModel, Home, Hvac, replay
from hemma.home.comfort import comfort_power, observed_comfort_power
from hemma.types import Exogenous, Observation


def observation(temperature: float, previous: float = 0.7, outdoor: float = 35.0) -> Observation:
    values = [jnp.asarray(x) for x in (0.0, 0.5, 1.2, outdoor, temperature, 0.1, 0.1, 12.0, previous)]
    return Observation(*values, slot=jnp.asarray(0))


def weather(outdoor: np.ndarray) -> Exogenous:
    zero = jnp.zeros(len(outdoor))
    hours = jnp.asarray(np.arange(len(outdoor)) % 24.0)
    return Exogenous(zero, zero + 0.5, jnp.asarray(outdoor), zero + 0.1, zero + 0.09, hours)


@pytest.mark.parametrize(
    ("heats", "temperature", "expected"),
    [
        (False, 24.5, 2.0),
        (False, 18.5, 0.0),
        (False, 22.0, 0.7),
        (True, 24.5, 0.0),
        (True, 18.5, 2.0),
        (True, 22.0, 0.7),
        (False, 24.0, 0.7),  # on the edge of the band nothing switches
        (True, 19.0, 0.7),
    ],
)
def test_rule_is_a_thermostat_with_hysteresis(heats, temperature, expected):
    action, _ = Rule(Hvac(heats=heats), ComfortBand())(observation(temperature), (), jax.random.key(0))
    assert float(action.hvac_power) == pytest.approx(expected)
    assert float(action.battery_power) == 0.0


def test_rule_under_constant_heat_cycles_and_leaves_the_battery_alone():
    home = Home()
    with jax.enable_x64(True):
        path = replay(
            home,
            weather(np.full(200, 38.0)),
            Rule(home.hvac, home.comfort),
            home.reset(),
            jax.random.key(0),
        )
    used = np.unique(np.asarray(path.steps.action.hvac_power))
    np.testing.assert_array_equal(used, [0.0, 2.0])
    temperature = np.asarray(path.steps.state.indoor_temperature)
    assert temperature.max() > 24
    assert temperature.min() < 19
    np.testing.assert_array_equal(path.steps.state.battery_energy, 1.2)


@settings(max_examples=25)
@given(
    temperature=st.floats(10, 40),
    outdoor=st.floats(-20, 50),
    inertia=st.floats(0.3, 0.99),
)
def test_comfort_law_is_the_closed_form_on_the_explicit_model(temperature, outdoor, inertia):
    model = ExplicitThermalModel(inertia=inertia)
    home = Home(thermal_model=model)
    with jax.enable_x64(True):
        h = observed_comfort_power(home, observation(temperature, outdoor=outdoor))
    excess = inertia * temperature + (1 - inertia) * outdoor - 24.0
    expected = np.clip(excess * 0.252 / ((1 - inertia) * 2.5), 0, 2.0)
    assert float(h) == pytest.approx(expected, abs=1e-9)


@settings(max_examples=25)
@given(temperature=st.floats(10, 40), outdoor=st.floats(-20, 50), heats=st.booleans())
def test_comfort_law_is_the_smallest_power_that_reaches_the_band(temperature, outdoor, heats):
    home = Home(hvac=Hvac(heats=heats))
    with jax.enable_x64(True):
        now = jax.tree.map(lambda x: x[0], weather(np.array([outdoor])))
        state = home.reset(indoor_temperature=jnp.asarray(temperature))
        h = comfort_power(home, state.thermal, now)

        def violation(power):
            after = home.thermal_model(state.thermal, home.thermal_drivers(now, power, jnp.zeros(())))
            T = after.indoor_temperature
            return float(home.comfort.low - T if heats else T - home.comfort.high)

        assert 0 <= float(h) <= 2
        assert float(h) == 2 or violation(h) <= 1e-9
        assert float(h) == 0 or violation(h - 1e-3) > 1e-3  # a little less would not do


@pytest.mark.parametrize("effect", [0.0, -1.0])
@pytest.mark.parametrize("temperature", [15.0, 30.0])
def test_hvac_without_effect_or_with_the_wrong_one_stays_off(effect, temperature):
    class Odd(ExplicitThermalModel):
        def __call__(self, state, drivers):
            return super().__call__(
                state, eqx.tree_at(lambda d: d.cooling_power, drivers, effect * drivers.cooling_power)
            )

    home = Home(thermal_model=Odd())
    assert float(observed_comfort_power(home, observation(temperature))) == 0.0


@pytest.mark.parametrize("heats", [False, True])
def test_comfort_hold_never_leaves_the_band_where_it_can_be_held(heats):
    home = Home(hvac=Hvac(heats=heats, max_power=6.0))
    middle = 5.0 if heats else 38.0
    outdoor = middle + 6 * np.sin(np.arange(96) * np.pi / 12)
    with jax.enable_x64(True):
        run = eqx.filter_jit(lambda c: replay(home, weather(outdoor), c, home.reset(), jax.random.key(1)))
        path = run(ComfortHold(home))
        deviation = float(path.temperature_deviation)
    assert deviation == pytest.approx(0, abs=1e-9)
    edge = 19.0 if heats else 24.0
    np.testing.assert_allclose(path.steps.state.indoor_temperature[24:], edge, atol=1e-9)
    np.testing.assert_array_equal(path.steps.action.battery_power, 0.0)
