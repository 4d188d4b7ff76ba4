"""Ways to improve a policy against any reward, whoever gives it: PPO is one."""

from dataclasses import dataclass, field
from typing import Any, Protocol, runtime_checkable

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Float

from hemma.rl import ppo
from hemma.rl.environment import Environment, Rollout, collect
from hemma.rl.policies.action_space import ActionSpace
from hemma.rl.policies.policy import FEATURES, StochasticPolicy
from hemma.rl.policies.spaces import FRACTIONS
from hemma.rl.ppo import PPOSettings
from hemma.types import Array


class Effort(eqx.Module):
    """How boldly to improve."""

    deviation: Float[Array, "actions"]
    """Standard deviation with which the policy acts."""
    share: Array | float = 1.0
    """Share of the learning rates to use, for rates that fall as training goes on."""


class RolloutMeans(eqx.Module):
    """What the policy earned and cost while it was improved, as means over a slot."""

    reward: Float[Array, ""]
    energy_cost: Float[Array, ""]
    """X1 + X2 [currency]; shown, never used."""
    temperature_deviation: Float[Array, ""]
    """X3 [degC]; shown, never used."""


@runtime_checkable
class PolicyImprovement(Protocol):
    """A way to improve a policy; frozen and hashable. What it carries from step to step has a ``policy``."""

    @property
    def discount(self) -> float:
        """gamma."""
        ...

    def start(self, key: Array, features: int = FEATURES) -> Any:
        """A learner with a random policy of so many features."""
        ...

    def policy(self, learner: Any) -> StochasticPolicy:
        """The learner's policy."""
        ...

    def explore(self, learner: Any, environment: Environment, effort: Effort, key: Array) -> Rollout:
        """What the learner's policy does in ``environment``, for ``improve`` and whoever else looks."""
        ...

    def improve(
        self,
        learner: Any,
        rollout: Rollout,
        rewards: Float[Array, "slots rollouts"],
        effort: Effort,
        key: Array,
    ) -> Any:
        """The learner after one step towards more of the ``rewards`` of the rollout, whoever gives them."""
        ...


@dataclass(frozen=True)
class Proximal:
    """PPO, as in the paper: the home is a black box that is sampled."""

    settings: PPOSettings = field(default_factory=PPOSettings)
    space: ActionSpace = FRACTIONS
    """What the policy decides on."""

    @property
    def discount(self) -> float:
        """gamma."""
        return self.settings.discount

    def start(self, key: Array, features: int = FEATURES) -> ppo.Learner:
        """Random policy and value function."""
        return ppo.start(self.settings, key, features, self.space)

    def policy(self, learner: ppo.Learner) -> StochasticPolicy:
        """The policy."""
        return learner.networks.policy

    def explore(self, learner: ppo.Learner, environment: Environment, effort: Effort, key: Array) -> Rollout:
        """Rollouts from random states."""
        shape = (self.settings.slots, self.settings.rollouts)
        return collect(environment, learner.networks.policy, effort.deviation, shape, key)

    def improve(
        self, learner: ppo.Learner, rollout: Rollout, rewards: Array, effort: Effort, key: Array
    ) -> ppo.Learner:
        """One PPO update."""
        objective = ppo.Objective(rewards, effort.deviation, effort.share)
        return ppo.update(learner, rollout, objective, self.settings, key)


def standard(rewards: Float[Array, "slots rollouts"]) -> Float[Array, "slots rollouts"]:
    """Rewards with mean 0 and deviation 1: neither matters to the policy, both to its value function."""
    return (rewards - jnp.mean(rewards)) / (jnp.std(rewards) + 1e-6)


def measured(rollout: Rollout, rewards: Array) -> RolloutMeans:
    """Means over a rollout's slots."""
    costs = rollout.costs
    return RolloutMeans(
        reward=jnp.mean(rewards),
        energy_cost=jnp.mean(costs.transaction + costs.ageing),
        temperature_deviation=jnp.mean(costs.temperature_deviation),
    )
