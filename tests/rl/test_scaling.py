"""The scaler: medians to zero, spikes bounded, midnight beside midnight."""

import jax.numpy as jnp
import numpy as np

from hemma.rl.policies.scaling import fit_scaler


def states(rng, samples=400):
    columns = [rng.uniform(0, 4, samples) for _ in range(6)]
    return np.stack([*columns, np.arange(samples) % 24], axis=1)


def test_features_by_hand():
    data = states(np.random.default_rng(0))
    scaler = fit_scaler(data)
    state = np.full(7, 3.0)
    low, high = np.quantile(data[:, :6], [0.1, 0.9], axis=0)
    scaled = (3.0 - np.median(data[:, :6], axis=0)) / ((high - low) / 2)
    expected = np.where([True, True, False, False, False, True], np.arcsinh(scaled), scaled)
    features = scaler(jnp.asarray(state))
    np.testing.assert_allclose(features[:6], expected, rtol=1e-5)
    np.testing.assert_allclose(features[6:], [np.sin(np.pi / 4), np.cos(np.pi / 4)], atol=1e-6)


def test_a_price_spike_a_hundred_times_the_usual_stays_of_unit_order():
    data = states(np.random.default_rng(1))
    scaler = fit_scaler(data)
    usual, spike = np.median(data, axis=0), np.median(data, axis=0)
    spike[5] = 400.0
    assert 3.0 < float(scaler(jnp.asarray(spike))[5] - scaler(jnp.asarray(usual))[5]) < 8.0


def test_a_quantity_that_never_changes_does_not_divide_by_zero():
    data = states(np.random.default_rng(2))
    data[:, 0] = 0.0
    data[:, 1] = 1.0
    data[0, 1] = 5.0
    assert bool(jnp.all(jnp.isfinite(fit_scaler(data)(jnp.asarray(data)))))
