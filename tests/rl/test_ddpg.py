"""DDPG: memory, targets and losses by hand, and worlds whose best policy is known."""

import dataclasses

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from paid_worlds import paid_task, played

from companions import assert_alone_as_among_others
from hemma.errors import HemmaError
from hemma.rl.critic import Critic
from hemma.rl.ddpg import (
    DDPG,
    ActorAndCritic,
    DDPGSettings,
    actor_loss,
    bellman_targets,
    critic_loss,
    followed,
)
from hemma.rl.environment import Transitions
from hemma.rl.policies.policy import StochasticPolicy
from hemma.rl.replay_buffer import Experience, empty_memory

LEARNER = DDPG(
    DDPGSettings(
        iterations=150,
        slots=24,
        rollouts=8,
        batch=128,
        hidden=(32, 32),
        actor_rate=1e-3,
        critic_rate=2e-3,
        following=0.02,
    )
)


def experience(first, samples):
    numbers = jnp.arange(first, first + samples, dtype=float)
    states, nothing = jnp.repeat(numbers[:, None], 8, 1), jnp.zeros((samples, 0))
    transitions = Transitions(states, jnp.zeros((samples, 2)), states, nothing)
    return Experience(transitions, numbers)


def networks(seed):
    actor_key, critic_key = jax.random.split(jax.random.key(seed))
    return ActorAndCritic(StochasticPolicy((8,), actor_key), Critic((8,), critic_key))


def batch(samples=6, seed=0):
    rng = np.random.default_rng(seed)
    features, following = (jnp.asarray(rng.normal(size=(samples, 8)), float) for _ in range(2))
    fractions = jnp.asarray(rng.uniform(-1, 1, (samples, 2)), float)
    rewards = jnp.asarray(rng.normal(size=samples), float)
    return Experience(Transitions(features, fractions, following, jnp.zeros((samples, 0))), rewards)


def test_the_newest_takes_the_place_of_the_oldest():
    memory = empty_memory(experience(0, 2), 5)
    for first in (10, 12, 14):
        memory = memory.add(experience(first, 2))
    np.testing.assert_array_equal(memory.experience.rewards, [15, 11, 12, 13, 14])
    np.testing.assert_array_equal(memory.experience.transitions.features[:, 3], [15, 11, 12, 13, 14])


def test_nothing_but_what_was_stored_is_sampled():
    memory = empty_memory(experience(0, 2), 100).add(experience(7, 2))
    drawn = memory.sample(200, jax.random.key(0))
    assert set(np.asarray(drawn.rewards).tolist()) == {7.0, 8.0}


def test_the_critic_is_a_value_of_the_state_and_one_of_the_action_rectified():
    """Q(s, a) = V(s) + A(s, a), both written out with max(0, x)."""

    def by_hand(network, inputs):
        hidden = np.maximum(0.0, np.asarray(network.weights[0]) @ inputs + np.asarray(network.biases[0]))
        return float((np.asarray(network.weights[1]) @ hidden + np.asarray(network.biases[1]))[0])

    critic, t = networks(3).critic, batch().transitions
    for s, a in zip(np.asarray(t.features), np.asarray(t.fractions), strict=True):
        expected = by_hand(critic.value, s) + by_hand(critic.advantage, np.concatenate([s, a]))
        np.testing.assert_allclose(critic(jnp.asarray(s), jnp.asarray(a)), expected, rtol=1e-4, atol=1e-6)


def test_bellman_targets_are_bootstrapped_everywhere():
    target, some = networks(0), batch()
    expected = []
    for reward, following in zip(some.rewards, some.transitions.next_features, strict=True):
        decision = np.clip(np.asarray(target.actor.mean(following)), -1, 1)
        value = float(target.critic(following, jnp.asarray(decision)))
        expected.append(float(reward) + 0.9 * value)
    np.testing.assert_allclose(bellman_targets(target, some, 0.9), expected, rtol=1e-5)


def test_losses_by_hand():
    both, some = networks(1), batch()
    targets, t = jnp.linspace(-3.0, 3.0, 6), some.transitions
    values = np.array([float(both.critic(s, a)) for s, a in zip(t.features, t.fractions, strict=True)])
    loss = critic_loss(both.critic, both.actor, t, targets)
    error = np.abs(values - np.asarray(targets))
    expected = np.where(error <= 1, 0.5 * error**2, error - 0.5).mean()
    np.testing.assert_allclose(loss, expected, rtol=1e-5)
    decisions = jnp.clip(jnp.stack([both.actor.mean(x) for x in t.features]), -1, 1)
    values = np.array([float(both.critic(s, a)) for s, a in zip(t.features, decisions, strict=True)])
    np.testing.assert_allclose(actor_loss(both.actor, both.critic, t), -values.mean(), rtol=1e-5)


def test_targets_follow_by_their_share():
    old, new = networks(0), networks(1)
    for t, o, n in zip(*(jax.tree.leaves(x) for x in (followed(old, new, 0.1), old, new)), strict=True):
        np.testing.assert_allclose(t, 0.9 * np.asarray(o) + 0.1 * np.asarray(n), rtol=1e-5, atol=1e-7)


def test_the_critic_steps_towards_its_targets_and_the_actor_uphill():
    both, some = networks(2), batch()
    targets = jnp.zeros(6)
    slope = jax.grad(critic_loss)(both.critic, both.actor, some.transitions, targets)
    nearer = eqx.apply_updates(both.critic, jax.tree.map(lambda g: -0.01 * g, slope))
    before, after = (critic_loss(c, both.actor, some.transitions, targets) for c in (both.critic, nearer))
    assert float(after) < float(before)
    slope = jax.grad(actor_loss)(both.actor, both.critic, some.transitions)
    better = eqx.apply_updates(both.actor, jax.tree.map(lambda g: -0.01 * g, slope))
    before, after = (actor_loss(a, both.critic, some.transitions) for a in (both.actor, better))
    assert float(after) < float(before)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"capacity": 10}, r"capacity >= rollouts \* slots, got 10"),
        ({"following": 0.0}, "0 < following <= 1, got 0.0"),
        ({"iterations": 10}, "iterations a multiple of 25, got 10"),
    ],
)
def test_settings_without_meaning_are_refused(change, message):
    with pytest.raises(HemmaError, match=message):
        dataclasses.replace(LEARNER.settings, **change)


@pytest.mark.slow
def test_one_step_world_without_a_price_of_comfort_the_hvac_is_off():
    """The night's price is a tenth of the day's, and so is what it tells: it takes twice the rounds."""
    longer = DDPG(dataclasses.replace(LEARNER.settings, iterations=300))
    acted = played(longer, comfort_price=0.0)
    assert float(acted.action.hvac_power.mean()) < 0.1


@pytest.mark.slow
def test_state_matters_world_comfort_at_a_price_is_held():
    acted = played(LEARNER, comfort_price=2.0)
    assert float(acted.costs.temperature_deviation[12:].mean()) < 0.3


@pytest.mark.slow
def test_discounting_world_the_battery_is_filled_at_night_for_the_day():
    acted = played(LEARNER, comfort_price=2.0)
    hour = np.arange(acted.action.battery_power.shape[0]) % 24
    energy = np.asarray(acted.state.battery_energy)
    assert energy[hour == 5].mean() > energy[hour == 17].mean() + 2.0


@pytest.mark.slow
def test_a_run_is_the_same_alone_and_among_others(monkeypatch):
    assert_alone_as_among_others(paid_task, LEARNER, monkeypatch)
