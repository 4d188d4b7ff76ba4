"""The same bits on one core and on all: in processes of their own, since XLA looks at the cores only once."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import hemma

GRADIENT = """
import os, sys
if sys.argv[1] == "one":
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
import hashlib
import hemma
import jax, jax.numpy as jnp
from hemma.rl import ppo
from hemma.rl.environment import Transitions

learner = jax.vmap(lambda key: ppo.ActorCritic((64, 64), key))(jax.random.split(jax.random.key(0), 2))
shapes = [(2, 768, 8), (2, 768, 2), (2, 768, 8), (2, 768, 0), *[(2, 768)] * 3]
draws = [jax.random.normal(jax.random.key(n), shape) for n, shape in enumerate(shapes)]
batch = ppo.Batch(Transitions(*draws[:4]), *draws[4:])
slope = lambda one, batch: jax.grad(ppo.loss)(one, batch, jnp.asarray([0.5, 0.2]), 0.2)
found = jax.jit(jax.vmap(slope))(learner, batch)
print(hashlib.sha256(b"".join(leaf.tobytes() for leaf in jax.tree.leaves(found))).hexdigest())
"""


def digest(cores):
    """Of the gradient of PPO's loss at the sizes of the main job, on ``"one"`` core or on ``"all"``."""
    environment = {name: value for name, value in os.environ.items() if name != "NPROC"}
    environment |= {"PYTHONPATH": str(Path(hemma.__file__).parents[1]), "JAX_PLATFORMS": "cpu"}
    command = [sys.executable, "-c", GRADIENT, cores]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    return done.stdout


@pytest.mark.skipif(not hasattr(os, "sched_setaffinity"), reason="cores can be given on Linux alone")
def test_a_gradient_is_the_same_on_one_core_and_on_all():
    assert digest("one") == digest("all")
