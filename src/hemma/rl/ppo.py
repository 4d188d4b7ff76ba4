"""Proximal policy optimisation (Schulman et al. 2017, arXiv 1707.06347) for homes that never terminate."""

from collections.abc import Hashable
from dataclasses import dataclass

import equinox as eqx
import jax
import jax.numpy as jnp
import optax
from jaxtyping import Float, Int

from hemma.home.checks import require
from hemma.rl.descent import begin, descend
from hemma.rl.environment import Rollout, Transitions, flattened
from hemma.rl.policies.action_space import ActionSpace
from hemma.rl.policies.network import Network
from hemma.rl.policies.policy import FEATURES, StochasticPolicy
from hemma.rl.policies.spaces import FRACTIONS
from hemma.types import Array


@dataclass(frozen=True)
class PPOSettings:
    """Sizes and rates of PPO; where a value comes from stands in ``docs/paper.md``."""

    rollouts: int = 64
    """Rollouts collected for an update."""
    slots: int = 48
    """Length of a rollout."""
    discount: float = 0.95
    """gamma."""
    trace: float = 0.95
    """lambda of the generalised advantage estimate."""
    clip: float = 0.2
    """Largest change of the probability ratio that still pays."""
    epochs: int = 3
    """Passes over the samples in an update."""
    minibatches: int = 4
    """Parts of a pass; they must divide rollouts * slots."""
    learning_rate: float = 1e-3
    """Of the policy's Adam."""
    value_learning_rate: float = 2e-3
    """Of the value function's Adam."""
    max_gradient_norm: float = 0.5
    """Longer gradients are shortened to this, each network by itself."""
    hidden: tuple[int, ...] = (64, 64)
    """Units of the hidden layers of the battery's mean, and of the value function."""

    def __post_init__(self):
        """Refuse settings without meaning."""
        for name in ("rollouts", "slots", "epochs", "minibatches"):
            require("ppo", getattr(self, name) >= 1, f"{name} >= 1", getattr(self, name))
        for name in ("clip", "learning_rate", "value_learning_rate", "max_gradient_norm"):
            require("ppo", getattr(self, name) > 0, f"{name} > 0", getattr(self, name))
        require("ppo", 0 < self.discount < 1, "0 < discount < 1", self.discount)
        require("ppo", 0 <= self.trace <= 1, "0 <= trace <= 1", self.trace)
        require(
            "ppo", all(width >= 1 for width in self.hidden), "hidden layers of at least 1 unit", self.hidden
        )
        whole = self.rollouts * self.slots % self.minibatches == 0
        require("ppo", whole, "rollouts * slots a multiple of minibatches", self.minibatches)


class ActorCritic(eqx.Module):
    """Policy and state value, trained together."""

    policy: StochasticPolicy
    value: Network

    def __init__(
        self,
        hidden: tuple[int, ...],
        key: Array,
        features: int = FEATURES,
        space: ActionSpace = FRACTIONS,
    ):
        """Random weights."""
        policy_key, value_key = jax.random.split(key)
        self.policy = StochasticPolicy(hidden, policy_key, features, space)
        self.value = Network((features, *hidden, 1), value_key)

    def values(self, features: Float[Array, "*batch features"]) -> Float[Array, "*batch"]:
        """V(s) of a batch of states."""
        flat = features.reshape(-1, features.shape[-1])
        return jax.vmap(self.value)(flat).reshape(features.shape[:-1])


def optimiser(settings: PPOSettings) -> optax.GradientTransformation:
    """Adam with a bound on the norm of each network's gradient."""

    def adam(rate: float) -> optax.GradientTransformation:
        return optax.chain(optax.clip_by_global_norm(settings.max_gradient_norm), optax.adam(rate))

    rates: dict[Hashable, optax.GradientTransformation] = {
        "policy": adam(settings.learning_rate),
        "value": adam(settings.value_learning_rate),
    }
    return optax.multi_transform(rates, _labels)


def _labels(learner: ActorCritic) -> ActorCritic:
    labels = jax.tree.map(lambda _: "value", learner)
    return eqx.tree_at(lambda t: t.policy, labels, jax.tree.map(lambda _: "policy", learner.policy))


def advantages(
    rewards: Float[Array, "slots rollouts"],
    values: Float[Array, "slots rollouts"],
    next_values: Float[Array, "slots rollouts"],
    settings: PPOSettings,
) -> Float[Array, "slots rollouts"]:
    """Generalised advantage estimate, bootstrapped at the end of the rollout as everywhere else.

    A_t = delta_t + gamma lambda A_{t+1}, delta_t = r_t + gamma V(s_{t+1}) - V(s_t)
    (Schulman et al. 2016, arXiv 1506.02438, equation 16).
    """
    deltas = rewards + settings.discount * next_values - values

    def backwards(following: Array, delta: Array) -> tuple[Array, Array]:
        advantage = delta + settings.discount * settings.trace * following
        return advantage, advantage

    return jax.lax.scan(backwards, jnp.zeros_like(deltas[0]), deltas, reverse=True)[1]


class Batch(eqx.Module):
    """Samples of one update, shape (samples, ...)."""

    transitions: Transitions
    log_density: Array
    advantage: Array
    target: Array
    """Value target A + V."""


def loss(learner: ActorCritic, batch: Batch, deviation: Array, clip: float) -> Array:
    """Clipped surrogate plus squared value error.

    -E[min(rho A, clip(rho, 1 - c, 1 + c) A)] + E[(V - target)^2] / 2, rho = pi(a|s) / pi_old(a|s).
    """
    mean = jax.vmap(learner.policy.mean)(batch.transitions.features)
    deeds, space = batch.transitions, learner.policy.space
    density = space.log_density(deeds.fractions, deeds.reach, mean, deviation)
    ratio = jnp.exp(density - batch.log_density)
    bounded = jnp.clip(ratio, 1 - clip, 1 + clip)
    surrogate = jnp.minimum(ratio * batch.advantage, bounded * batch.advantage)
    error = learner.values(batch.transitions.features) - batch.target
    return -jnp.mean(surrogate) + 0.5 * jnp.mean(error**2)


class Learner(eqx.Module):
    """What PPO carries from update to update."""

    networks: ActorCritic
    optimiser: optax.OptState


class Objective(eqx.Module):
    """What an update is to improve, and how boldly."""

    rewards: Float[Array, "slots rollouts"]
    """r of each transition, whoever says so."""
    deviation: Float[Array, "actions"]
    """Standard deviation with which the policy acted."""
    share: Array | float = 1.0
    """Share of the learning rates to use, for rates that fall as training goes on."""


def start(
    settings: PPOSettings, key: Array, features: int = FEATURES, space: ActionSpace = FRACTIONS
) -> Learner:
    """A learner with random weights."""
    networks = ActorCritic(settings.hidden, key, features, space)
    return Learner(networks, begin(optimiser(settings), networks))


def update(
    learner: Learner, rollout: Rollout, objective: Objective, settings: PPOSettings, key: Array
) -> Learner:
    """One PPO update on a rollout, ``settings.epochs`` passes over its samples."""
    batch = _batch(learner.networks, rollout, objective.rewards, settings)
    samples = batch.target.shape[0]
    method = optimiser(settings)

    def minibatch(learner: Learner, rows: Array) -> tuple[Learner, None]:
        chosen = jax.tree.map(lambda x: x[rows], batch)
        gradient = jax.grad(loss)(learner.networks, chosen, objective.deviation, settings.clip)
        return Learner(*descend(method, gradient, learner.optimiser, learner.networks, objective.share)), None

    order = jax.vmap(lambda k: shuffled(samples, k))(jax.random.split(key, settings.epochs))
    return jax.lax.scan(minibatch, learner, order.reshape(-1, samples // settings.minibatches))[0]


def shuffled(samples: int, key: Array) -> Int[Array, "samples"]:
    """The numbers 0, ..., samples - 1 in random order.

    Random high bits over the number in the low bits, sorted: one sort of plain integers, a tenth of the time
    of ``jax.random.permutation`` on CPUs. Equal high bits keep their order, which 2^20 values for 3000
    samples make too rare to matter.
    """
    low = (samples - 1).bit_length()
    bits = jax.random.bits(key, (samples,), jnp.uint32) >> low << low
    return (jnp.sort(bits | jnp.arange(samples, dtype=jnp.uint32)) & (2**low - 1)).astype(int)


def _batch(networks: ActorCritic, rollout: Rollout, rewards: Array, settings: PPOSettings) -> Batch:
    values = networks.values(rollout.transitions.features)
    last = networks.values(rollout.transitions.next_features[-1])
    next_values = jnp.concatenate([values[1:], last[None]])
    advantage = advantages(rewards, values, next_values, settings)
    normal = (advantage - advantage.mean()) / (advantage.std() + 1e-6)
    batch = Batch(rollout.transitions, rollout.log_density, normal, advantage + values)
    return flattened(batch)
