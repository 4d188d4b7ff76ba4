"""A run of training must not depend on what is trained beside it, nor on how many cores there are."""

import os

import jax
import numpy as np

from hemma.rl import training
from hemma.rl.task import stack


def assert_alone_as_among_others(task, learner, monkeypatch):
    """``task(seed, days)``: seed 0 alone on one core, and third of four, longer ones among them, on two."""

    def weights(cores, runs, place):
        monkeypatch.setattr(os, "cpu_count", lambda: cores)
        tasks = stack([task(seed, days) for seed, days in runs])
        trained = training.advance(training.begin(tasks, learner), tasks, learner)
        arrays = jax.tree.leaves(jax.tree.map(lambda x: x[place], trained))
        return [jax.random.key_data(x) if _is_key(x) else np.asarray(x) for x in arrays]

    alone = weights(1, [(0, 5)], 0)
    among = weights(2, [(1, 9), (2, 5), (0, 5), (3, 7)], 2)
    other = weights(2, [(4, 5), (0, 5)], 1)
    for a, b, c in zip(alone, among, other, strict=True):
        np.testing.assert_array_equal(a, b)
        np.testing.assert_array_equal(a, c)


def _is_key(x):
    return jax.numpy.issubdtype(x.dtype, jax.dtypes.prng_key)
