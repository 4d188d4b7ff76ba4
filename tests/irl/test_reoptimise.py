"""PPO on a reward that learns no more: it finds what a known reward pays best, and nothing else matters."""

import dataclasses

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from probe_worlds import traces

from hemma.home import Home
from hemma.irl.reoptimise import Reoptimisation, frozen_task
from hemma.irl.reward import ShapedReward
from hemma.rl import training
from hemma.rl.environment import collect
from hemma.rl.explicit import ExplicitLearning, ExplicitSettings
from hemma.rl.ppo import PPOSettings
from hemma.rl.task import explicit_task, stack

PRICE = 5
"""Position of the price among the features."""
# What is paid depends on the slot alone, so that looking ahead is only noise.
LEARNER = Reoptimisation(
    ExplicitLearning(
        ExplicitSettings(
            iterations=150,
            ppo=PPOSettings(rollouts=32, slots=24, hidden=(16,), learning_rate=1e-2, discount=0.1, trace=0.0),
        )
    )
)


class Known(eqx.Module):
    """-(a_battery - b)^2 - (a_hvac - 0.3)^2, b = 0.6 where it is cheap and -0.6 where it is dear."""

    scale: jax.Array

    def rewards(self, transitions):
        battery = jnp.where(transitions.features[..., PRICE] > 0, -0.6, 0.6)
        wanted = jnp.stack([battery, jnp.full_like(battery, 0.3)], axis=-1)
        return -self.scale * jnp.sum((transitions.fractions - wanted) ** 2, axis=-1)


def task(reward, seed=0):
    made = explicit_task(Home(), Home(), traces(4), 0.0, seed)
    return frozen_task(made, reward, made.environment.scaler)


def policy_of(task, learner=LEARNER):
    runs = stack([task])
    trained = training.train(runs, learner)
    return jax.tree.map(lambda x: x[0], training.controllers(trained, runs, learner).policy)


@pytest.mark.slow
def test_it_finds_what_a_known_reward_pays_best():
    """The best is 0, everything at rest earns -0.45."""
    known = task(Known(jnp.asarray(1.0)))
    quiet = jnp.full(2, 1e-3)
    acted = collect(known.environment, policy_of(known), quiet, (24, 16), jax.random.key(5))
    assert float(known.teacher.rewards(acted.transitions).mean()) > -0.08


@pytest.mark.slow
def test_neither_scale_nor_seedless_repetition_changes_it():
    """Twice the same task is twice the same policy; a reward of ten times the size is the same reward."""
    short = dataclasses.replace(LEARNER.learning.settings, iterations=25)
    learner = Reoptimisation(ExplicitLearning(short))
    one, again, larger = (policy_of(task(Known(jnp.asarray(scale))), learner) for scale in (1.0, 1.0, 10.0))
    for a, b, c in zip(*map(jax.tree.leaves, (one, again, larger)), strict=True):
        np.testing.assert_array_equal(a, b)
        np.testing.assert_allclose(a, c, atol=0.02)


@pytest.mark.slow
def test_the_frozen_reward_is_what_the_policy_is_paid_and_it_stays():
    head = ShapedReward.random((8,), 0.95, jax.random.key(3))
    runs = stack([task(head, 0), task(head, 1)])
    short = dataclasses.replace(LEARNER.learning.settings, iterations=25)
    trained = training.train(runs, Reoptimisation(ExplicitLearning(short)))
    assert trained.iterations == 25
    for a, b in zip(jax.tree.leaves(head), jax.tree.leaves(runs.teacher), strict=True):
        np.testing.assert_array_equal(a, b[1])
