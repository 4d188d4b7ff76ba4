"""MaxEnt IRL against experts that are the best for a reward that is known here and hidden from it."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from probe_worlds import (
    PPO,
    best_response,
    demonstrate,
    idle_rule,
    imitation_task,
    linear_reward,
    price_rule,
    ruled_task,
    shown_by,
    traces,
)

from hemma.home import Home
from hemma.irl.maxent import MaxEntSettings, linear_maxent, neural_maxent
from hemma.irl.maxent_rewards import LinearMaxEnt
from hemma.rl import training
from hemma.rl.policies.policy import StochasticPolicy
from hemma.rl.task import stack

pytestmark = pytest.mark.slow


def test_a_known_reward_is_recovered_up_to_what_behaviour_shows():
    """The expert is soft-optimal for a known w*; not w itself, but what it says about behaviour, returns.

    Scale, constants and shaping leave no trace in behaviour. So: the learner earns under w* what the expert
    earns; under the learned reward nobody earns clearly more than the expert; it says of two
    other policies that differ clearly which is better; and the weights that made the behaviour have their
    signs. The price on w is low, for it draws w to 0 where an expert can be matched.
    """
    truth = linear_reward(
        charge_at_price=-1.0, level_at_cosine=0.3, throughput=-0.1, warmer=-1.0, colder=-0.5
    )
    world = ruled_task(price_rule)
    scaler = world.environment.scaler
    shown = shown_by(best_response(truth, world, updates=300), scaler)
    linear = LinearMaxEnt(shrinkage=0.02)
    learner = linear_maxent(MaxEntSettings(iterations=400, windows=8, slots=24, linear=linear), PPO)
    trained = training.train(stack([imitation_task(shown, scaler)]), learner)
    state = jax.tree.map(lambda x: x[0], trained.state)
    reward = state.learned.average

    def earned(reward, shown):
        return float(jnp.mean(reward.batch(imitation_task(shown, scaler).teacher.transitions)))

    others = [shown_by(stranger(seed), scaler) for seed in range(6)]
    others += [demonstrate(Home(), traces(5), rule) for rule in (price_rule, idle_rule)]
    true, found = ([earned(r, other) for other in others] for r in (truth, reward))
    best = earned(truth, shown)
    assert best - earned(truth, shown_by(state.average, scaler)) < 0.02 * (best - np.mean(true))
    assert max(found) - earned(reward, shown) < 0.05 * (max(found) - min(found))
    assert agreement(true, found) > 0.85
    w = reward.weights
    assert max(float(w.charge_at_price), -float(w.level_at_cosine), float(w.warmer)) < 0


def test_a_neural_reward_leads_to_the_expert_s_earnings():
    """The learner earns under a w* that it never saw what the expert earns."""
    truth = linear_reward(level_at_cosine=1.0, throughput=-0.3, hvac=-0.3)
    world = ruled_task(price_rule)
    scaler = world.environment.scaler
    shown = shown_by(best_response(truth, world, updates=100), scaler)
    learner = neural_maxent(MaxEntSettings(iterations=400, windows=8, slots=24), PPO)
    trained = training.train(stack([imitation_task(shown, scaler)]), learner)
    policy = jax.tree.map(lambda x: x[0], trained.state.average)

    def earned(shown):
        return float(jnp.mean(truth.batch(imitation_task(shown, scaler).teacher.transitions)))

    usual = np.mean([earned(shown_by(stranger(seed), scaler)) for seed in range(6)])
    assert earned(shown) - earned(shown_by(policy, scaler)) < 0.1 * (earned(shown) - usual)


def agreement(true, found):
    """Share of the pairs at least 1 apart in ``true`` that ``found`` puts in the same order."""
    pairs = [(i, j) for i in range(len(true)) for j in range(len(true)) if true[i] > true[j] + 1]
    return np.mean([found[i] > found[j] for i, j in pairs])


def stranger(seed):
    """A policy with random weights."""
    policy = StochasticPolicy((16,), jax.random.key(seed))
    slopes = jax.random.normal(jax.random.key(100 + seed), (2, 8))
    return eqx.tree_at(lambda p: p.linear, policy, slopes)
