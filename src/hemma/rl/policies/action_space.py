"""What the two numbers that a policy decides on mean: how they become powers, and how likely powers are."""

from typing import Protocol, runtime_checkable

import equinox as eqx
from jaxtyping import Float

from hemma.home import Home
from hemma.rl.policies.scaling import StateScaler
from hemma.types import Action, Array, Observation


class Deed(eqx.Module):
    """A decision as it was carried out, or what somebody did as a decision would have had it."""

    action: Action
    """(e, h) [kW], feasible."""
    fractions: Float[Array, "*batch actions"]
    """The same as rewards and discriminators read it, of about unit size."""
    reach: Float[Array, "*batch bounds"]
    """Which decisions about the battery end in this power, from and to; empty where each has its own."""


@runtime_checkable
class ActionSpace(Protocol):
    """A way to decide; frozen and hashable, because compiled code depends on it."""

    @property
    def name(self) -> str:
        """As settings and files call it."""
        ...

    @property
    def bounds(self) -> int:
        """How many numbers ``Deed.reach`` has: 2, or 0 where each decision has a power of its own."""
        ...

    def carry_out(
        self,
        planning_home: Home,
        observation: Observation,
        decision: Float[Array, "*batch actions"],
        scaler: StateScaler,
    ) -> Deed:
        """What a decision does in the observed state; ``planning_home`` is the home as far as it is known."""
        ...

    def shown(
        self, planning_home: Home, observation: Observation, action: Action, scaler: StateScaler
    ) -> Deed:
        """The deed of this space that is nearest to a feasible ``action`` [kW]."""
        ...

    def tried(
        self,
        planning_home: Home,
        observation: Observation,
        fractions: Float[Array, "*batch actions"],
    ) -> Deed:
        """What rewards read as these fractions, or the nearest that is feasible."""
        ...

    def noise(self, key: Array, shape: tuple[int, ...]) -> Float[Array, "*shape actions"]:
        """What is added, times a deviation, to the mean decision of a policy that explores."""
        ...

    def log_density(
        self,
        fractions: Float[Array, "*batch actions"],
        reach: Float[Array, "*batch bounds"],
        mean: Float[Array, "*batch actions"],
        deviation: Float[Array, "actions"],
    ) -> Float[Array, "*batch"]:
        """log pi of a deed, of a policy with this mean that explores with this deviation."""
        ...

    def surprise(
        self,
        reach: Float[Array, "*batch bounds"],
        mean: Float[Array, "*batch actions"],
        deviation: Float[Array, "actions"],
    ) -> Float[Array, "*batch"]:
        """The part of -log pi whose expectation a policy can change by its mean; 0 where there is none."""
        ...

    def jitter(self, key: Array, shape: tuple[int, ...]) -> Float[Array, "*shape actions"]:
        """What is added, times a deviation, to fractions that were shown, so that they have a density."""
        ...

    @property
    def heeds(self) -> tuple[bool, ...]:
        """Which of the eight features of the paper's state the mean decision about the battery depends on."""
        ...

    def bent(self, raw: Float[Array, "actions"]) -> Float[Array, "actions"]:
        """The mean decision of a network's unbounded outputs."""
        ...

    def agreed(self, decisions: Float[Array, "members actions"]) -> Float[Array, "actions"]:
        """What several policies agree on."""
        ...

    def error(
        self,
        mean: Float[Array, "*batch actions"],
        fractions: Float[Array, "*batch actions"],
        reach: Float[Array, "*batch bounds"],
    ) -> Float[Array, "*batch actions"]:
        """How far the mean decision is from one that would have done what was shown; 0 where it would."""
        ...
