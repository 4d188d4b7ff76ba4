"""Exploration by hand: how sigma shrinks, how weights are averaged, how learning rates fall."""

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hemma.errors import HemmaError
from hemma.rl.policies.exploration import Exploration, falling
from hemma.rl.policies.policy import StochasticPolicy


def test_deviation_shrinks_geometrically_and_then_stays():
    exploration = Exploration(first_deviation=(0.4, 0.2), last_deviation=(0.1, 0.2), shrinking=0.5)
    np.testing.assert_allclose(exploration.deviation(jnp.asarray(0), 100), [0.4, 0.2], rtol=1e-6)
    np.testing.assert_allclose(exploration.deviation(jnp.asarray(25), 100), [0.2, 0.2], rtol=1e-6)
    np.testing.assert_allclose(exploration.deviation(jnp.asarray(90), 100), [0.1, 0.2], rtol=1e-6)


def test_the_average_forgets_the_first_policy_and_then_moves_slowly():
    old, new = (StochasticPolicy((4,), jax.random.key(seed)) for seed in (0, 1))
    exploration = Exploration(averaging=0.9)
    first = exploration.averaged(old, new, jnp.asarray(0))
    late = exploration.averaged(old, new, jnp.asarray(10_000))
    for a, b, n, m in zip(*(jax.tree.leaves(t) for t in (first, late, new, old)), strict=True):
        np.testing.assert_allclose(a, n, rtol=1e-6)
        np.testing.assert_allclose(b, 0.9 * m + 0.1 * n, rtol=1e-5, atol=1e-7)


def test_learning_rates_fall_to_a_tenth():
    np.testing.assert_allclose(falling(jnp.asarray([0, 50, 100]), 100), [1.0, 0.55, 0.1], rtol=1e-6)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"first_deviation": (0.2, 0.0)}, "first_deviation two numbers > 0"),
        ({"averaging": 1.0}, "0 <= averaging < 1, got 1.0"),
        ({"shrinking": 0.0}, "0 < shrinking <= 1, got 0.0"),
    ],
)
def test_settings_without_meaning_are_refused(change, message):
    with pytest.raises(HemmaError, match=message):
        dataclasses.replace(Exploration(), **change)
