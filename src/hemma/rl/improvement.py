"""Ways to improve a policy against any reward, whoever gives it: PPO is one."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Protocol, runtime_checkable

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Float

from hemma.rl import ppo
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


def measured(rollout: Rollout, rewards: Array) -> Measured:
    """Means over a rollout's slots."""
    costs = rollout.costs
    return Measured(
        reward=jnp.mean(rewards),
        energy_cost=jnp.mean(costs.transaction + costs.ageing),
        temperature_deviation=jnp.mean(costs.temperature_deviation),
    )
