"""PPO: its formulas by hand, and worlds whose best policy is known."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.stats import norm

from hemma.home import Home
from hemma.rl import ppo
from hemma.rl.environment import Environment, collect
from hemma.rl.policies.policy import StochasticPolicy
from hemma.rl.policies.scaling import fit_scaler
from hemma.rl.policies.spaces import FRACTIONS
from hemma.rl.ppo import Objective, PPOSettings, advantages
from hemma.types import Exogenous

SETTINGS = PPOSettings(rollouts=32, slots=24, hidden=(32,), learning_rate=3e-3, value_learning_rate=3e-3)
DEVIATION = jnp.asarray([0.3, 0.3])


def environment(slots=240, seed=0):
    rng = np.random.default_rng(seed)
    hour = np.arange(slots) % 24.0
    exogenous = Exogenous(
        pv_generation=jnp.asarray(rng.uniform(0, 2, slots), float),
        load=jnp.asarray(rng.uniform(0, 2, slots), float),
        outdoor_temperature=jnp.asarray(30 + 5 * np.sin(hour / 24 * 2 * np.pi), float),
        buying_price=jnp.asarray(rng.uniform(0.05, 0.2, slots), float),
        selling_price=jnp.asarray(rng.uniform(0.05, 0.1, slots), float),
        hour_of_day=jnp.asarray(hour, float),
    )
    columns = [exogenous.pv_generation, exogenous.load, rng.uniform(0.6, 6, slots)]
    columns += [exogenous.outdoor_temperature, rng.uniform(19, 25, slots), exogenous.buying_price, hour]
    states = np.stack(columns, axis=1)
    nothing = jnp.zeros((slots, 0))
    return Environment(Home(), Home(), exogenous, jnp.asarray(slots), fit_scaler(states), nothing)


@pytest.mark.parametrize("samples", [1, 2, 5, 64, 3072])
def test_shuffling_keeps_every_sample_once_and_prefers_no_place(samples):
    orders = np.asarray(
        jax.vmap(lambda key: ppo.shuffled(samples, key))(jax.random.split(jax.random.key(0), 400))
    )
    assert np.array_equal(np.sort(orders, axis=1), np.tile(np.arange(samples), (400, 1)))
    first = orders[:, 0] / max(samples - 1, 1)
    assert samples == 1 or abs(first.mean() - 0.5) < 4 * first.std() / np.sqrt(400)


def trained(environment, reward, updates, settings=SETTINGS):
    def improve(learner, key):
        collect_key, update_key = jax.random.split(key)
        shape = (settings.slots, settings.rollouts)
        rollout = collect(environment, learner.networks.policy, DEVIATION, shape, collect_key)
        return ppo.update(learner, rollout, Objective(reward(rollout), DEVIATION), settings, update_key), None

    learner = ppo.start(settings, jax.random.key(0))
    keys = jax.random.split(jax.random.key(1), updates)
    return jax.jit(lambda learner: jax.lax.scan(improve, learner, keys)[0])(learner)


def means(environment, learner):
    rollout = collect(environment, learner.networks.policy, 1e-3 * DEVIATION, (24, 32), jax.random.key(2))
    return rollout.transitions


def test_advantages_are_the_discounted_sum_of_errors():
    rng = np.random.default_rng(0)
    rewards, values, following = (jnp.asarray(rng.normal(size=(6, 2)), float) for _ in range(3))
    settings = PPOSettings(discount=0.9, trace=0.8)
    expected = np.zeros((6, 2))
    for t in range(6):
        for k in range(t, 6):
            delta = rewards[k] + 0.9 * following[k] - values[k]
            expected[t] += (0.9 * 0.8) ** (k - t) * np.asarray(delta)
    np.testing.assert_allclose(
        advantages(rewards, values, following, settings), expected, rtol=1e-4, atol=1e-6
    )


def test_log_density_is_that_of_independent_gaussians():
    rng = np.random.default_rng(0)
    actions, mean = rng.normal(size=(5, 2)), rng.normal(size=(5, 2))
    deviation = np.asarray([0.2, 0.05])
    expected = norm.logpdf(actions, mean, deviation).sum(axis=1)
    actions, mean, deviation = (jnp.asarray(x, float) for x in (actions, mean, deviation))
    computed = FRACTIONS.log_density(actions, jnp.zeros((5, 0)), mean, deviation)
    np.testing.assert_allclose(computed, expected, rtol=1e-4)


def test_the_mean_is_affine_within_the_bounds_and_bent_beyond():
    policy = StochasticPolicy((8,), jax.random.key(0))
    weights = jnp.zeros((2, 8)).at[0, 5].set(1.0).at[1, 4].set(2.0)
    policy = eqx.tree_at(
        lambda p: (p.linear, p.bias, p.network.weights),
        policy,
        (weights, jnp.asarray([0.1, -0.5]), tuple(jnp.zeros_like(w) for w in policy.network.weights)),
    )
    features = jnp.zeros((3, 8)).at[:, 5].set(jnp.asarray([0.3, 2.9, -3.1])).at[:, 4].set(0.5)
    expected = [[0.4, 0.5], [1 + 0.05 * 2.0, 0.5], [-1 - 0.05 * 2.0, 0.5]]
    np.testing.assert_allclose(jax.vmap(policy.mean)(features), expected, atol=1e-6)


def test_a_rollout_replays_consecutive_slots_of_the_traces():
    world = environment()
    learner = ppo.start(SETTINGS, jax.random.key(0))
    rollout = collect(world, learner.networks.policy, DEVIATION, (24, 32), jax.random.key(3))
    transitions = rollout.transitions
    np.testing.assert_array_equal(transitions.features[1:], transitions.next_features[:-1])
    load = world.scaler(jnp.zeros((240, 7)).at[:, 1].set(world.exogenous.load))[:, 1]
    rows = np.abs(np.asarray(transitions.features[:, :, 1])[..., None] - np.asarray(load)).argmin(axis=-1)
    np.testing.assert_array_equal((rows[1:] - rows[:-1]) % 240, 1)


def test_padding_behind_the_available_slots_is_never_replayed():
    world = environment()
    poisoned = jax.tree.map(lambda x: x.at[100:].set(jnp.nan), world.exogenous)
    world = Environment(world.home, world.home, poisoned, jnp.asarray(100), world.scaler, world.context)
    learner = ppo.start(SETTINGS, jax.random.key(0))
    rollout = collect(world, learner.networks.policy, DEVIATION, (24, 256), jax.random.key(3))
    assert bool(jnp.all(jnp.isfinite(rollout.transitions.next_features)))


@pytest.mark.parametrize("target", [-0.6, 0.5])
def test_one_step_world_the_policy_finds_the_rewarded_action(target):
    world = environment()
    learner = trained(world, lambda r: -jnp.sum((r.transitions.fractions - target) ** 2, axis=-1), 80)
    np.testing.assert_allclose(means(world, learner).fractions.mean((0, 1)), target, atol=0.12)


def test_discounting_world_a_battery_is_filled_for_rewards_that_come_later():
    """Reward is the energy held at the end of a slot: only who looks ahead charges at once and stays full."""
    world = environment()
    energy = 2
    learner = trained(world, lambda r: r.transitions.next_features[..., energy], 80)
    assert float(means(world, learner).fractions[..., 0].mean()) > 0.5


def test_state_matters_world_the_policy_follows_the_price():
    """Reward is battery power times price deviation: charge at high prices, discharge at low ones."""
    world = environment()
    price = 5
    learner = trained(
        world,
        lambda r: jnp.clip(r.transitions.fractions[..., 0], -1, 1) * r.transitions.features[..., price],
        80,
    )
    transitions = means(world, learner)
    agree = jnp.sign(transitions.fractions[..., 0]) == jnp.sign(transitions.features[..., price])
    assert float(agree.mean()) > 0.85
