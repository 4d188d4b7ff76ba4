"""What runs a home: in every slot it sees, decides, and remembers what it likes."""

from abc import abstractmethod
from typing import Any, TypeAlias

import equinox as eqx
import jax
import jax.numpy as jnp

from hemma.types import Action, Array, Observation

Memory: TypeAlias = Any
"""A pytree of arrays whose shapes stay the same from slot to slot."""


class AbstractController(eqx.Module):
    """The one type of every method: rule, planner, policy, schedule, and whatever wraps one of them."""

    @property
    def is_traceable(self) -> bool:
        """Whether JAX can compile it; what calls a solver or a device says no."""
        return True

    def start(self) -> Memory:
        """What it remembers before the first slot; nothing unless it says otherwise."""
        return ()

    @abstractmethod
    def __call__(self, observation: Observation, memory: Memory, key: Array) -> tuple[Action, Memory]:
        """The action of the observed slot [kW], and what is to be remembered until the next one.

        An action that breaks a limit of the home is moved to the nearest feasible one (``Home.step``).
        """


class Schedule(AbstractController):
    """Carries out a list of actions, one a slot, whatever it sees."""

    actions: Action
    """Shape (slots,)."""

    def __call__(self, observation: Observation, memory: Memory, key: Array) -> tuple[Action, Memory]:
        """The action of the observed slot."""
        return jax.tree.map(lambda x: jnp.asarray(x)[observation.slot], self.actions), memory


class WrapperMemory(eqx.Module):
    """What a controller around another one remembers."""

    own: Any
    inner: Any
    """Of the controller inside."""
