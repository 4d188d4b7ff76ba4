"""Re-optimisation: a policy improved on a reward that was learned before and learns no more.

Fu et al. 2018 (arXiv 1710.11248), their test of a reward: train on it again where the world changed.
"""

from dataclasses import dataclass, field
from typing import Protocol, runtime_checkable

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Float

from hemma.irl.reward import ShapedReward
from hemma.rl.environment import Rollout, Transitions
from hemma.rl.explicit import ExplicitLearning, ExplicitState
from hemma.rl.improvement import RolloutMeans, standard
from hemma.rl.policies.network import Network
from hemma.rl.policies.policy import StochasticPolicy
from hemma.rl.policies.scaling import StateScaler
from hemma.rl.task import ExplicitReward, Task
from hemma.types import Array


@runtime_checkable
class FrozenReward(Protocol):
    """A teacher who pays by what was learned elsewhere; a module of arrays."""

    def rewards(self, transitions: Transitions) -> Float[Array, "*batch"]:
        """r of each transition."""
        ...


class GroundReward(eqx.Module):
    """g alone: the part of r = g + gamma h' - h that does not depend on how the home moves."""

    approximator: Network
    """g(s, a)."""

    def rewards(self, transitions: Transitions) -> Float[Array, "*batch"]:
        """g of each transition."""
        inputs = jnp.concatenate([transitions.features, transitions.fractions], axis=-1)
        flat = inputs.reshape(-1, inputs.shape[-1])
        return jax.vmap(self.approximator)(flat).reshape(inputs.shape[:-1])


def ground(head: ShapedReward) -> GroundReward:
    """The g of a learned reward."""
    return GroundReward(head.approximator)


class Inheritance(eqx.Module):
    """A reward and the policy that was learned with it."""

    reward: ShapedReward
    policy: StochasticPolicy

    def rewards(self, transitions: Transitions) -> Float[Array, "*batch"]:
        """r of each transition."""
        return self.reward.rewards(transitions)


def frozen_task(task: Task[ExplicitReward], reward: FrozenReward, scaler: StateScaler) -> Task:
    """The same home, days and seed, paid by ``reward``, seen through the ``scaler`` that it reads."""
    environment = task.environment.seen_through(scaler)
    return Task(environment, reward, task.seed, task.stream)  # pyright: ignore[reportArgumentType]


@dataclass(frozen=True)
class Reoptimisation:
    """PPO on a ``FrozenReward``, brought to mean 0 and deviation 1 over the rollouts as in AIRL."""

    learning: ExplicitLearning = field(default_factory=ExplicitLearning)
    """The loop, its sizes and its exploration; what it pays is replaced."""
    entropy: float = 0.0
    """Weight of the policy's entropy beside the reward, as in AIRL."""

    @property
    def iterations(self) -> int:
        """How many iterations a training takes."""
        return self.learning.iterations

    def policy(self, state: ExplicitState) -> StochasticPolicy:
        """The averaged policy."""
        return self.learning.policy(state)

    def start(self, task: Task, key: Array) -> ExplicitState:
        """A random policy."""
        return self.learning.start(task, key)

    def iterate(self, state: ExplicitState, task: Task) -> tuple[ExplicitState, RolloutMeans]:
        """One improvement of the policy."""

        def paid(rollout: Rollout) -> Float[Array, "slots rollouts"]:
            return task.teacher.rewards(rollout.transitions) + self.entropy * rollout.surprise

        return self.learning.improved(state, task.environment, paid, standard)


@dataclass(frozen=True)
class InheritedReoptimisation:
    """The same from the policy of an ``Inheritance``: it begins where its reward was learned."""

    learning: Reoptimisation = field(default_factory=Reoptimisation)

    @property
    def iterations(self) -> int:
        """How many iterations a training takes."""
        return self.learning.iterations

    def policy(self, state: ExplicitState) -> StochasticPolicy:
        """The averaged policy."""
        return self.learning.policy(state)

    def start(self, task: Task, key: Array) -> ExplicitState:
        """The inherited policy, and a value function that knows nothing yet."""
        state, policy = self.learning.start(task, key), task.teacher.policy
        return eqx.tree_at(lambda s: (s.learner.networks.policy, s.average), state, (policy, policy))

    def iterate(self, state: ExplicitState, task: Task) -> tuple[ExplicitState, RolloutMeans]:
        """One improvement of the policy."""
        return self.learning.iterate(state, task)
