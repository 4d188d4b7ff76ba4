"""Ways to improve a policy against any reward: PPO from samples, or the gradient through the home."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Protocol, runtime_checkable

import equinox as eqx
import jax
import jax.numpy as jnp
import optax
from jaxtyping import Float

from hemma.home.checks import require
from hemma.rl import ppo
from hemma.rl.descent import begin, descend
from hemma.rl.environment import Environment, Rollout, collect
from hemma.rl.policy import GaussianPolicy
from hemma.rl.ppo import PPOSettings
from hemma.types import Array

Reward = Callable[[Rollout], Array]
"""r of every transition of a rollout, shape (slots, rollouts)."""


class Effort(eqx.Module):
    """How boldly to improve."""

    deviation: Float[Array, "actions"]
    """Standard deviation with which the policy acts."""
    share: Array | float = 1.0
    """Share of the learning rates to use, for rates that fall as training goes on."""


class Measured(eqx.Module):
    """What the policy earned and cost while it was improved, as means over a slot."""

    reward: Float[Array, ""]
    energy_cost: Float[Array, ""]
    """X1 + X2 [currency]; shown, never used."""
    temperature_deviation: Float[Array, ""]
    """X3 [degC]; shown, never used."""


@runtime_checkable
class Improvement(Protocol):
    """A way to improve a policy; frozen and hashable. What it carries from step to step has a ``policy``."""

    @property
    def discount(self) -> float:
        """gamma."""
        ...

    def start(self, key: Array) -> Any:
        """A learner with a random policy."""
        ...

    def policy(self, learner: Any) -> GaussianPolicy:
        """The learner's policy."""
        ...

    def improve(
        self, learner: Any, environment: Environment, reward: Reward, effort: Effort, key: Array
    ) -> tuple[Any, Measured]:
        """The learner after one step towards more ``reward`` in ``environment``."""
        ...


@dataclass(frozen=True)
class Proximal:
    """PPO, as in the paper: the home is a black box that is sampled."""

    settings: PPOSettings = field(default_factory=PPOSettings)

    @property
    def discount(self) -> float:
        """gamma."""
        return self.settings.discount

    def start(self, key: Array) -> ppo.Learner:
        """Random policy and value function."""
        return ppo.start(self.settings, key)

    def policy(self, learner: ppo.Learner) -> GaussianPolicy:
        """The policy."""
        return learner.networks.policy

    def improve(
        self, learner: ppo.Learner, environment: Environment, reward: Reward, effort: Effort, key: Array
    ) -> tuple[ppo.Learner, Measured]:
        """Collect rollouts and make one PPO update."""
        collect_key, update_key = jax.random.split(key)
        shape = (self.settings.slots, self.settings.rollouts)
        rollout = collect(environment, learner.networks.policy, effort.deviation, shape, collect_key)
        rewards = reward(rollout)
        objective = ppo.Objective(rewards, effort.deviation, effort.share)
        return ppo.update(learner, rollout, objective, self.settings, update_key), measured(rollout, rewards)


@dataclass(frozen=True)
class AnalyticSettings:
    """Sizes and rates of the analytic policy gradient; where a value comes from stands in docs/airl.md."""

    rollouts: int = 64
    """Rollouts of one step."""
    slots: int = 48
    """Length of a rollout."""
    discount: float = 0.95
    """gamma of the shaping; the objective itself is the undiscounted mean of r."""
    learning_rate: float = 1e-3
    """Of Adam."""
    max_gradient_norm: float = 0.5
    """Longer gradients are shortened to this."""
    hidden: tuple[int, ...] = (64, 64)
    """Units of the hidden layers of the battery's mean."""

    def __post_init__(self):
        """Refuse settings without meaning."""
        for name in ("rollouts", "slots"):
            require("analytic", getattr(self, name) >= 1, f"{name} >= 1", getattr(self, name))
        for name in ("learning_rate", "max_gradient_norm"):
            require("analytic", getattr(self, name) > 0, f"{name} > 0", getattr(self, name))
        require("analytic", 0 < self.discount < 1, "0 < discount < 1", self.discount)


class AnalyticLearner(eqx.Module):
    """What the analytic gradient carries from step to step."""

    network: GaussianPolicy
    optimiser: optax.OptState


@dataclass(frozen=True)
class Analytic:
    """The gradient of the mean reward over a rollout, through home and reward, by the policy's weights.

    grad_theta (1 / T) sum_t r(s_t, a_t, s_{t+1}), a_t = mu_theta(s_t) + sigma xi_t: a home is differentiable
    and a learned reward is, so neither value function nor score-function estimate is needed (compare Baram
    et al. 2017, end-to-end differentiable adversarial imitation learning).
    """

    settings: AnalyticSettings = field(default_factory=AnalyticSettings)

    @property
    def discount(self) -> float:
        """gamma."""
        return self.settings.discount

    def start(self, key: Array) -> AnalyticLearner:
        """Random policy."""
        policy = GaussianPolicy(self.settings.hidden, key)
        return AnalyticLearner(policy, begin(self._optimiser(), policy))

    def policy(self, learner: AnalyticLearner) -> GaussianPolicy:
        """The policy."""
        return learner.network

    def improve(
        self, learner: AnalyticLearner, environment: Environment, reward: Reward, effort: Effort, key: Array
    ) -> tuple[AnalyticLearner, Measured]:
        """One Adam step along the gradient over fresh rollouts."""
        shape = (self.settings.slots, self.settings.rollouts)

        def loss(policy: GaussianPolicy) -> tuple[Array, Measured]:
            rollout = collect(environment, policy, effort.deviation, shape, key)
            rewards = reward(rollout)
            return -jnp.mean(rewards), measured(rollout, rewards)

        gradient, found = jax.grad(loss, has_aux=True)(learner.network)
        stepped = descend(self._optimiser(), gradient, learner.optimiser, learner.network, effort.share)
        return AnalyticLearner(*stepped), found

    def _optimiser(self) -> optax.GradientTransformation:
        clip = optax.clip_by_global_norm(self.settings.max_gradient_norm)
        return optax.chain(clip, optax.adam(self.settings.learning_rate))


def measured(rollout: Rollout, rewards: Array) -> Measured:
    """Means over a rollout's slots."""
    costs = rollout.costs
    return Measured(
        reward=jnp.mean(rewards),
        energy_cost=jnp.mean(costs.transaction + costs.ageing),
        temperature_deviation=jnp.mean(costs.temperature_deviation),
    )
