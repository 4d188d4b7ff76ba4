"""The two rewards of maximum-entropy inverse reinforcement learning, and how each learns."""

from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

import equinox as eqx
import jax
import jax.numpy as jnp
import optax
from jaxtyping import Int

from hemma.home.checks import require
from hemma.irl.discriminator import gradient_penalty
from hemma.irl.reward import ShapedReward
from hemma.irl.reward_features import LinearReward, demonstrated_scale
from hemma.rl.descent import begin, descend
from hemma.rl.environment import Transitions
from hemma.rl.task import ExpertData
from hemma.types import Array


class Comparison(eqx.Module):
    """What the expert and the agent did in the same slots."""

    expert: Transitions
    agent: Transitions


@runtime_checkable
class RewardLearner(Protocol):
    """A family of rewards r_w and a rule to climb E_expert[r_w] - E_agent[r_w].

    What it carries from step to step has a ``reward``, and that has ``batch(transitions)``.
    """

    def start(self, expert: ExpertData, discount: float, key: Array) -> Any:
        """r before the first comparison; ``discount`` is gamma."""
        ...

    def improve(self, learned: Any, comparison: Comparison, share: Array, key: Array) -> Any:
        """r after a comparison, with this ``share`` of the full rate."""
        ...


class LearnedWeights(eqx.Module):
    """A linear reward under way."""

    reward: LinearReward
    """r_n, which the policy is to answer."""
    average: LinearReward
    """Mean of r_1 to r_n: under it no policy is much better than the expert (``docs/maxent.md``)."""
    steps: Int[Array, "*runs"]
    """n."""


class LearnedNetworks(eqx.Module):
    """A neural reward under way."""

    reward: ShapedReward
    optimiser: optax.OptState


@dataclass(frozen=True)
class LinearMaxEnt:
    """r = w . phi / scale, |w| <= 1: projected gradient ascent with a quadratic price on w."""

    rate: float = 0.1
    """eta, step along the gradient at first; it falls with the policy's learning rates."""
    shrinkage: float = 0.2
    """lambda, price of |w|^2 / 2."""
    least_scale: float = 0.1
    """Features that vary less than this in the demonstrations are divided by this, not by their deviation."""

    def __post_init__(self):
        """Refuse settings without meaning."""
        for name in ("rate", "shrinkage", "least_scale"):
            require("maxent.linear", getattr(self, name) > 0, f"{name} > 0", getattr(self, name))
        stable = self.rate * self.shrinkage < 1
        require("maxent.linear", stable, "rate * shrinkage < 1", self.rate * self.shrinkage)

    def start(self, expert: ExpertData, discount: float, key: Array) -> LearnedWeights:
        """w = 0."""
        scale = demonstrated_scale(expert, self.least_scale)
        reward = LinearReward(jax.tree.map(jnp.zeros_like, scale), scale)
        return LearnedWeights(reward, reward, jnp.zeros((), int))

    def improve(
        self, learned: LearnedWeights, comparison: Comparison, share: Array, key: Array
    ) -> LearnedWeights:
        """w <- w + eta (E_expert[phi] - E_agent[phi] - lambda w), then back to |w| = 1 if it got longer."""
        reward, eta, steps = learned.reward, share * self.rate, learned.steps + 1

        def ascend(w: Array, expert: Array, agent: Array) -> Array:
            return w + eta * (jnp.mean(expert) - jnp.mean(agent) - self.shrinkage * w)

        sides = reward.features(comparison.expert), reward.features(comparison.agent)
        moved = jax.tree.map(ascend, reward.weights, *sides)
        length = jnp.maximum(jnp.linalg.norm(jnp.stack(jax.tree.leaves(moved))), 1.0)
        weights = jax.tree.map(lambda w: w / length, moved)
        average = jax.tree.map(lambda a, w: a + (w - a) / steps, learned.average.weights, weights)
        return LearnedWeights(LinearReward(weights, reward.scale), LinearReward(average, reward.scale), steps)


@dataclass(frozen=True)
class NeuralMaxEnt:
    """r = g + gamma h' - h of two networks, as in AIRL: the same gradient through the networks."""

    hidden: tuple[int, ...] = (64,)
    """Units of the hidden layers of g, and of h."""
    steps: int = 4
    """Adam steps an iteration."""
    learning_rate: float = 1e-3
    """Of Adam."""
    penalty: float = 1.0
    """Weight of the gradient penalty, which takes the place of the price on w."""

    def __post_init__(self):
        """Refuse settings without meaning."""
        for name in ("steps", "learning_rate", "penalty"):
            require("maxent.neural", getattr(self, name) > 0, f"{name} > 0", getattr(self, name))
        wide = all(width >= 1 for width in self.hidden)
        require("maxent.neural", wide, "hidden layers of at least 1 unit", self.hidden)

    def start(self, expert: ExpertData, discount: float, key: Array) -> LearnedNetworks:
        """Random networks."""
        width = expert.transitions.features.shape[-1]
        reward = ShapedReward.random(self.hidden, discount, key, width)
        return LearnedNetworks(reward, begin(self._method(), reward))

    def improve(
        self, learned: LearnedNetworks, comparison: Comparison, share: Array, key: Array
    ) -> LearnedNetworks:
        """``steps`` of Adam down E_agent[r] - E_expert[r] + lambda E[max(|grad r| - 1, 0)^2]."""

        def loss(reward: ShapedReward, key: Array) -> Array:
            gap = jnp.mean(reward.batch(comparison.agent)) - jnp.mean(reward.batch(comparison.expert))
            return gap + self.penalty * gradient_penalty(reward, comparison.expert, comparison.agent, key)

        def step(learned: LearnedNetworks, key: Array) -> tuple[LearnedNetworks, None]:
            gradient = jax.grad(loss)(learned.reward, key)
            moved = descend(self._method(), gradient, learned.optimiser, learned.reward, share)
            return LearnedNetworks(*moved), None

        return jax.lax.scan(step, learned, jax.random.split(key, self.steps))[0]

    def _method(self) -> optax.GradientTransformation:
        return optax.adam(self.learning_rate, b1=0.5)
