"""Exciting inputs and the record that they leave."""

from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hemma.errors import HemmaError
from hemma.home import ExplicitThermalModel, Home, Hvac, benchmark_home
from hemma.identification import Excitation, ThermalRecord, excite, logged_record
from hemma.types import Exogenous

HEATED = replace(benchmark_home(), hvac=Hvac(max_power=3.0, heats=True), initial_temperature=20.0)


def weather(slots: int, mean: float = 30.0, slot_length: float = 1.0) -> Exogenous:
    hour = (jnp.arange(slots) * slot_length) % 24
    wave = jnp.sin(2 * jnp.pi * (hour - 9) / 24)
    zeros = jnp.zeros(slots)
    return Exogenous(2 * jnp.maximum(wave, 0), zeros, mean + 6 * wave, zeros, zeros, hour)


@pytest.mark.parametrize(
    ("home", "mean"), [(benchmark_home(), 30.0), (HEATED, 0.0), (benchmark_home(0.25), 30.0)]
)
def test_record_obeys_the_explicit_equation(home: Home, mean):
    """T' = eps T + (1 - eps) (T_out +- eta / A u), slot by slot in NumPy."""
    record = excite(home, weather(300, mean, float(home.slot_length)), Excitation(), jax.random.key(0))
    T, drivers = np.asarray(record.indoor_temperature, float), record.drivers
    eps = 0.7 ** float(home.slot_length)
    u = np.asarray(drivers.heating_power, float) - np.asarray(drivers.cooling_power, float)
    ambient = np.asarray(drivers.outdoor_temperature, float) + 2.5 / 0.252 * u
    np.testing.assert_allclose(T[1:], eps * T[:-1] + (1 - eps) * ambient, rtol=0, atol=2e-5)
    assert T[0] == home.initial_temperature
    assert np.abs(u).max() <= home.hvac.max_power
    assert (u >= 0).all() if home.hvac.heats else (u <= 0).all()


@pytest.mark.parametrize(("home", "mean"), [(benchmark_home(), 30.0), (HEATED, 0.0)])
def test_safety_rules_outside_the_margin(home, mean):
    record = excite(home, weather(1000, mean), Excitation(margin=2.0), jax.random.key(1))
    T = np.asarray(record.indoor_temperature[:-1])
    power = np.asarray(record.drivers.heating_power + record.drivers.cooling_power)
    warm, cold = T > 24 + 2, T < 19 - 2
    assert warm.any()
    assert cold.any()
    on, off = (cold, warm) if home.hvac.heats else (warm, cold)
    assert (power[on] == home.hvac.max_power).all()
    assert (power[off] == 0).all()


def test_levels_are_held_and_often_extreme():
    """Free of safety: a level changes once in 4 h on average, and half of the levels are fully on or off."""
    free = Excitation(mean_hold=4.0, extreme_share=0.5, margin=1000.0)
    record = excite(benchmark_home(0.5), weather(20_000, slot_length=0.5), free, jax.random.key(2))
    power = np.asarray(record.drivers.cooling_power)
    change = np.diff(power) != 0
    # A new level repeats the old one when both are off or both are on: 2 (1/4)^2 of the draws.
    assert change.mean() == pytest.approx(0.5 / 4 * (1 - 2 / 16), rel=0.1)
    held = np.concatenate([power[:1], power[1:][change]])
    assert np.isin(power, (0.0, 2.0)).mean() == pytest.approx(0.5, abs=0.05)
    inner = held[~np.isin(held, (0.0, 2.0))]
    assert inner.mean() == pytest.approx(1.0, abs=0.1)


def test_the_key_alone_is_chance():
    run = lambda seed: excite(benchmark_home(), weather(100), Excitation(), jax.random.key(seed))  # noqa: E731
    first, again, other = run(3), run(3), run(4)
    assert (first.indoor_temperature == again.indoor_temperature).all()
    assert (first.indoor_temperature != other.indoor_temperature).any()


def test_disturbance_acts_but_is_not_recorded():
    still = excite(benchmark_home(), weather(500), Excitation(), jax.random.key(5))
    home = replace(benchmark_home(), disturbance_deviation=0.1)
    record = excite(home, weather(500), Excitation(), jax.random.key(5))
    assert (np.asarray(record.drivers.disturbance) == 0).all()
    model, T = ExplicitThermalModel(), record.indoor_temperature
    rest = T[1:] - model(model.initial(T[:-1]), record.drivers).indoor_temperature
    assert float(jnp.std(rest)) == pytest.approx(0.1, rel=0.1)
    assert (still.indoor_temperature != T).any()


def test_a_log_gives_the_record_that_it_was_taken_from():
    """Temperature at the start of each slot and the power in it: the last row closes the slot before."""
    exogenous = weather(100, 0.0)
    record = excite(HEATED, exogenous, Excitation(), jax.random.key(6))
    power = np.asarray(record.drivers.heating_power)
    log = logged_record(HEATED, exogenous, np.asarray(record.indoor_temperature[:-1]), power)
    jax.tree.map(np.testing.assert_array_equal, log, record.window(0, 99))


def test_a_hole_is_refused_with_its_place():
    record = excite(benchmark_home(), weather(50), Excitation(), jax.random.key(0))
    sun = record.drivers.pv_generation.at[17].set(jnp.nan)
    with pytest.raises(HemmaError, match="nan in slot 17 of pv_generation"):
        ThermalRecord(replace(record.drivers, pv_generation=sun), record.indoor_temperature, 1.0)
    with pytest.raises(HemmaError, match="in slot 50 of indoor_temperature"):
        ThermalRecord(record.drivers, record.indoor_temperature.at[50].set(jnp.inf), 1.0)


def test_fence_posts_are_counted():
    record = excite(benchmark_home(), weather(50), Excitation(), jax.random.key(0))
    with pytest.raises(HemmaError, match="got 50 temperatures for 50 slots"):
        ThermalRecord(record.drivers, record.indoor_temperature[:-1], 1.0)
