"""Several learners of the same kind, each by itself; what they agree on is the result."""

from dataclasses import dataclass
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Float

from hemma.home.checks import require
from hemma.rl.policies.action_space import ActionSpace
from hemma.rl.policies.policy import Policy
from hemma.rl.task import Task
from hemma.rl.training import Algorithm
from hemma.types import Array


class CommitteePolicy(eqx.Module):
    """What several policies agree on."""

    members: Policy
    """Stacked along a first axis."""

    def mean(self, features: Float[Array, "features"]) -> Float[Array, "actions"]:
        """The mean of the members' decisions, each within its bounds."""
        return self.space.agreed(eqx.filter_vmap(lambda policy: policy.mean(features))(self.members))

    @property
    def space(self) -> ActionSpace:
        """That of the members."""
        return self.members.space


@dataclass(frozen=True)
class Committee:
    """``members`` runs of an algorithm on one task, with random numbers of their own (bagging, Breiman 1996).

    They learn from the same days and differ by their weights and what they happened to try. Where the days
    leave no doubt they agree; where they leave some, the mean errs less than most members do.
    """

    algorithm: Algorithm
    members: int = 3

    def __post_init__(self):
        """Refuse a committee of nobody."""
        require("committee", self.members >= 1, "members >= 1", self.members)

    @property
    def iterations(self) -> int:
        """How many iterations each member takes."""
        return self.algorithm.iterations

    def start(self, task: Task, key: Array) -> Any:
        """The members' states, stacked along a first axis."""
        keys = jax.random.split(key, self.members)
        return jax.vmap(lambda k: self.algorithm.start(task, k))(keys)

    def iterate(self, state: Any, task: Task) -> tuple[Any, Any]:
        """Each member one iteration further; the progress is the mean of theirs."""
        state, progress = jax.vmap(lambda member: self.algorithm.iterate(member, task))(state)
        return state, jax.tree.map(lambda x: jnp.mean(x, axis=0), progress)

    def policy(self, state: Any) -> CommitteePolicy:
        """The mean of the members' policies."""
        return CommitteePolicy(eqx.filter_vmap(self.algorithm.policy)(state))
