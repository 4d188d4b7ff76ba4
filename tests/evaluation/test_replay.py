"""Replay: double precision, no reset, no disturbance, one compilation, seeds beside each other."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hemma.evaluation import evaluate, evaluate_stacked
from hemma.home import AbstractController, Home, Hvac
from hemma.types import Action, Array, Exogenous

traces = 0


class Proportional(AbstractController):
    """Battery power proportional to the price, HVAC to the temperature; counts its compilations."""

    gain: Array

    def __call__(self, observation, memory, key):
        global traces
        traces += 1
        e = self.gain[0] * (observation.buying_price - 0.1)
        h = self.gain[1] * (observation.indoor_temperature - 22.0)
        return Action(battery_power=e, hvac_power=h), memory


def period(slots=60, seed=0):
    random = np.random.default_rng(seed)
    return Exogenous(
        pv_generation=random.uniform(0, 3, slots),
        load=random.uniform(0, 2, slots),
        outdoor_temperature=random.uniform(24, 38, slots),
        buying_price=random.uniform(0.01, 0.3, slots),
        selling_price=random.uniform(0.0, 0.01, slots),
        hour_of_day=np.arange(slots) % 24.0,
    )


def loop(gain, exogenous):
    """The benchmark home as a plain Python loop, equations (3) to (8)."""
    E, T, energy, temperature, cost = 1.2, 23.0, [], [], []
    for t in range(exogenous.slots):
        u = float(exogenous.buying_price[t])
        e = min(max(gain[0] * (u - 0.1), -min(3.0, (E - 0.6) * 0.95)), min(3.0, (6.0 - E) / 0.95))
        h = min(max(gain[1] * (T - 22.0), 0.0), 2.0)
        g = h + e + float(exogenous.load[t]) - float(exogenous.pv_generation[t])
        E += 0.95 * e if e > 0 else e / 0.95
        T = 0.7 * T + 0.3 * (float(exogenous.outdoor_temperature[t]) - 2.5 / 0.252 * h)
        energy.append(E)
        temperature.append(T)
        cost.append((u if g > 0 else float(exogenous.selling_price[t])) * g + 0.001 * abs(e))
    return np.array(energy), np.array(temperature), np.array(cost)


def test_a_replay_is_the_loop_of_the_equations_in_double_precision():
    exogenous = period()
    controller = Proportional(jnp.array([-40.0, 0.5], jnp.float32))
    outcome = evaluate(Home(), exogenous, controller, jax.random.key(0))
    energy, temperature, cost = loop([-40.0, 0.5], exogenous)
    assert outcome.cost.dtype == np.float64
    np.testing.assert_allclose(outcome.battery_energy, energy, atol=1e-10)
    np.testing.assert_allclose(outcome.indoor_temperature, temperature, atol=1e-10)
    np.testing.assert_allclose(outcome.cost, cost, atol=1e-10)
    assert not jax.config.jax_enable_x64


def test_stacked_seeds_do_what_each_does_alone():
    gains = jnp.array([[-40.0, 0.5], [10.0, 1.0], [0.0, 0.0]])
    keys = jax.random.split(jax.random.key(1), 3)
    together = evaluate_stacked(Home(), period(), Proportional(gains), keys)
    assert len(together) == 3
    for gain, key, outcome in zip(gains, keys, together, strict=True):
        alone = evaluate(Home(), period(), Proportional(gain), key)
        np.testing.assert_allclose(outcome.cost, alone.cost, atol=1e-12)
        np.testing.assert_allclose(outcome.indoor_temperature, alone.indoor_temperature, atol=1e-12)


def test_the_disturbance_of_the_home_is_off_unless_asked_for():
    noisy, quiet = Home(disturbance_deviation=0.5), Home()
    controller, key = Proportional(jnp.array([-40.0, 0.5])), jax.random.key(2)
    reference = evaluate(quiet, period(), controller, key)
    np.testing.assert_array_equal(
        evaluate(noisy, period(), controller, key).indoor_temperature, reference.indoor_temperature
    )
    disturbed = evaluate(quiet, period(), controller, key, disturbance_deviation=0.5)
    assert np.std(disturbed.indoor_temperature - reference.indoor_temperature) > 0.1


def test_another_home_and_other_weights_need_no_new_compilation():
    controller, key = Proportional(jnp.array([-40.0, 0.5])), jax.random.key(2)
    evaluate(Home(), period(seed=1), controller, key)
    before = traces
    smaller = Home(hvac=Hvac(max_power=1.0), initial_temperature=25.0)
    outcome = evaluate(smaller, period(seed=4), Proportional(jnp.array([3.0, 2.0])), jax.random.key(3))
    assert traces == before
    assert outcome.hvac_power.max() == pytest.approx(1.0)
