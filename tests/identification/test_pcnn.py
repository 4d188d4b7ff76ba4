"""The physically consistent network: its equations, and the signs that no weights can break."""

from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hemma.home import Schedule, ThermalDrivers, ThermalState, benchmark_home, replay
from hemma.identification import (
    InputScaling,
    PcnnWeights,
    PhysicallyConsistentNetwork,
    ThermalResponse,
    run_free,
)
from hemma.types import Action, Exogenous

SLOTS = 8
SCALING = InputScaling(temperature_mean=22.0, temperature_deviation=2.0, pv_peak=2.5)
BENCHMARK = ThermalResponse(heating=0.3 * 2.5 / 0.252, cooling=0.3 * 2.5 / 0.252, loss=0.3)


def network(seed: int = 0, scale: float = 1.0, slot_length: float = 1.0) -> PhysicallyConsistentNetwork:
    """A network with random weights: physical logarithms in [-2, 2], layers of size ``scale``."""
    weights = PcnnWeights.create(jax.random.key(seed), width=8, depth=2)
    rng = np.random.default_rng(seed)
    leaves, tree = jax.tree.flatten(weights)
    draws = [scale * rng.normal(size=x.shape) if x.ndim else rng.uniform(-2, 2) for x in leaves]
    arrays = [jnp.asarray(draw, float) for draw in draws]
    start = ThermalResponse(heating=1.5, cooling=2.0, loss=0.2)
    return PhysicallyConsistentNetwork(jax.tree.unflatten(tree, arrays), start, SCALING, slot_length)


def random_drivers(seed: int, slots: int = SLOTS) -> ThermalDrivers:
    rng = np.random.default_rng(seed)
    return ThermalDrivers(
        outdoor_temperature=jnp.asarray(rng.uniform(-10, 40, slots)),
        heating_power=jnp.asarray(rng.uniform(0, 2, slots)),
        cooling_power=jnp.asarray(rng.uniform(0, 2, slots)),
        pv_generation=jnp.asarray(rng.uniform(0, 3, slots)),
        hour_of_day=jnp.asarray(np.arange(slots) % 24.0),
        disturbance=jnp.asarray(rng.normal(0, 0.1, slots)),
    )


@jax.jit
def path(model: PhysicallyConsistentNetwork, drivers: ThermalDrivers) -> ThermalState:
    return run_free(model, drivers, jnp.asarray(23.0))


@jax.jit
def slopes(model: PhysicallyConsistentNetwork, drivers: ThermalDrivers) -> ThermalState:
    """Of both temperatures at the posts 1 .. T (rows) to the drivers of the slots (columns)."""
    return jax.jacobian(path, argnums=1)(model, drivers)


def test_equations_in_numpy():
    """A loop written from the equations, with the matrix products spelt out, agrees to 1e-10."""
    with jax.enable_x64(True):
        model, drivers = network(3, slot_length=0.5), random_drivers(4)
        states = path(model, drivers)
        w = model.weights
        a, d = 1.5 * np.exp(float(w.log_heating)), 2.0 * np.exp(float(w.log_cooling))
        b = 1 - 0.8 ** np.exp(float(w.log_loss))
        layers = [(np.asarray(layer.weight), np.asarray(layer.bias)) for layer in w.layers]
        D, E = 23.0, 0.0
        for t in range(SLOTS):
            now = jax.tree.map(lambda x, t=t: float(x[t]), drivers)
            angle = 2 * np.pi * now.hour_of_day / 24
            x = np.array([np.tanh((D - 22) / 2), np.sin(angle), np.cos(angle), now.pv_generation / 2.5])
            for weight, bias in layers[:-1]:
                x = np.tanh(np.einsum("oi,i->o", weight, x) + bias)
            f = 0.5 * float(np.dot(layers[-1][0][0], x) + layers[-1][1][0])
            T = D + E
            E += a * now.heating_power - d * now.cooling_power - b * (T - now.outdoor_temperature)
            E += now.disturbance
            D += f
            np.testing.assert_allclose(states.memory[t + 1], D, rtol=0, atol=1e-10)
            np.testing.assert_allclose(states.indoor_temperature[t + 1], D + E, rtol=0, atol=1e-10)


@settings(max_examples=40)
@given(seed=st.integers(0, 2**30), scale=st.floats(0.01, 10.0))
def test_signs_hold_for_any_weights(seed, scale):
    """dT/du_heat > 0, dT/du_cool < 0, dT/dT_out > 0 at every later post, and 0 at every earlier one."""
    with jax.enable_x64(True):
        slope = slopes(network(seed, scale), random_drivers(seed)).indoor_temperature
    later = np.tri(SLOTS + 1, SLOTS, -1, dtype=bool)
    for values, sign in (
        (slope.heating_power, 1),
        (slope.cooling_power, -1),
        (slope.outdoor_temperature, 1),
    ):
        assert (sign * np.asarray(values)[later] > 0).all()
        assert (np.asarray(values)[~later] == 0).all()


@settings(max_examples=40)
@given(seed=st.integers(0, 2**30), scale=st.floats(0.01, 10.0))
def test_natural_temperature_sees_neither_power_nor_weather(seed, scale):
    with jax.enable_x64(True):
        slope = slopes(network(seed, scale), random_drivers(seed)).memory
    for values in (
        slope.heating_power,
        slope.cooling_power,
        slope.outdoor_temperature,
        slope.disturbance,
    ):
        assert (np.asarray(values) == 0).all()


def test_natural_temperature_does_see_the_sun():
    with jax.enable_x64(True):
        to_sun = np.asarray(slopes(network(), random_drivers(0)).memory.pv_generation)
    assert (np.diag(to_sun[1:]) != 0).all()


def test_response_to_one_slot_of_power_decays_by_the_loss():
    """dT_k/du_0 = a (1 - b)^(k - 1), derived by hand from E' = (1 - b) E + ..."""
    with jax.enable_x64(True):
        model = network(5)
        slope = slopes(model, random_drivers(5)).indoor_temperature.heating_power[1:, 0]
        b = float(model.loss_share)
        assert 0 < b < 1
        np.testing.assert_allclose(
            slope, float(model.heating_response) * (1 - b) ** np.arange(SLOTS), rtol=1e-9
        )


@settings(max_examples=40)
@given(seed=st.integers(0, 2**30), share=st.floats(0.0, 1.0))
def test_temperature_is_affine_in_power(seed, share):
    """T of a mixture of two power schedules is the mixture of the temperatures."""
    with jax.enable_x64(True):
        model, one, other = network(seed), random_drivers(seed), random_drivers(seed + 1)
        other = replace(one, heating_power=other.heating_power, cooling_power=other.cooling_power)
        between = jax.tree.map(lambda x, y: share * x + (1 - share) * y, one, other)
        first, second, mixed = (path(model, x).indoor_temperature for x in (one, other, between))
        np.testing.assert_allclose(mixed, share * first + (1 - share) * second, rtol=0, atol=1e-9)


def test_explicit_model_lies_in_the_class():
    """With f = 0, b = 0.3, d = 2.976 the network is the explicit model: same home, same temperatures."""
    weights = PcnnWeights.create(jax.random.key(0), width=16, depth=1)
    network_home = replace(
        benchmark_home(),
        thermal_model=PhysicallyConsistentNetwork(weights, BENCHMARK, SCALING, 1.0),
        disturbance_deviation=0.1,
    )
    explicit_home = replace(benchmark_home(), disturbance_deviation=0.1)
    rng = np.random.default_rng(0)
    n = 200
    zeros, hours = jnp.zeros(n), jnp.arange(float(n)) % 24
    outdoor, sun = jnp.asarray(rng.uniform(15, 40, n), float), jnp.asarray(rng.uniform(0, 3, n), float)
    exogenous = Exogenous(sun, zeros, outdoor, zeros, zeros, hours)
    schedule = Schedule(Action(battery_power=zeros, hvac_power=jnp.asarray(rng.uniform(0, 2, n), float)))
    run = jax.jit(replay)
    paths = [
        run(home, exogenous, schedule, home.reset(), jax.random.key(1)).steps.state.indoor_temperature
        for home in (network_home, explicit_home)
    ]
    np.testing.assert_allclose(*paths, rtol=0, atol=1e-5)


def test_a_new_network_knows_no_gains():
    weights = PcnnWeights.create(jax.random.key(7), width=16, depth=2)
    model = PhysicallyConsistentNetwork(weights, BENCHMARK, SCALING, 1.0)
    assert (np.asarray(model.gain(jnp.linspace(-50.0, 50.0, SLOTS), random_drivers(0))) == 0).all()


def test_gains_are_rates():
    """The same weights give half the gain in half the time, and no more than their rate at any D."""
    gain = jax.jit(lambda model, level: model.gain(jnp.full(SLOTS, level), random_drivers(1)))
    hour, half = network(2), network(2, slot_length=0.5)
    np.testing.assert_allclose(gain(half, 25.0), gain(hour, 25.0) / 2, rtol=1e-6)
    last = hour.weights.layers[-1]
    bound = np.abs(last.weight).sum() + np.abs(last.bias).sum()
    assert (np.abs(gain(hour, 1000.0)) <= bound).all()


def test_a_measurement_resets_the_memory():
    state = network().initial(jnp.asarray(21.5))
    assert state.indoor_temperature == state.memory == 21.5


@pytest.mark.parametrize(
    ("a", "d", "b"), [(0.0, 1.0, 0.3), (1.0, -1.0, 0.3), (1.0, 1.0, 0.0), (1.0, 1.0, 1.0)]
)
def test_an_unphysical_start_is_refused(a, d, b):
    with pytest.raises(ValueError, match="thermal response: expected"):
        ThermalResponse(heating=a, cooling=d, loss=b)
