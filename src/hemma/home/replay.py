"""Run a controller on a home over a period: the loop that every layer above shares."""

from collections.abc import Callable

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Float

from hemma.home.home import Home, HomeState, Step, observe
from hemma.types import Action, Array, Exogenous, Observation

Controller = Callable[[Observation, Array], Action]
"""``controller(observation, key) -> action`` [kW]: the one type of every method."""


class Schedule(eqx.Module):
    """A controller that carries out a list of actions, one a slot, whatever it sees."""

    actions: Action

    def __call__(self, observation: Observation, key: Array) -> Action:
        """The action of the observed slot."""
        return jax.tree.map(lambda x: jnp.asarray(x)[observation.slot], self.actions)


class Trajectory(eqx.Module):
    """A period as it went: ``slots`` entries of what happened, and the fence posts after each slot."""

    observations: Observation
    """What the controller saw, shape (slots,)."""
    steps: Step
    """What each slot did, shape (slots,); ``steps.state`` stands at the end of the slot."""

    @property
    def energy_cost(self) -> Float[Array, ""]:
        """Sum of X1 + X2 over the period [currency], objective (1)."""
        return jnp.sum(self.steps.costs.transaction + self.steps.costs.ageing)

    @property
    def temperature_deviation(self) -> Float[Array, ""]:
        """Sum of X3 over the period [degC], objective (2)."""
        return jnp.sum(self.steps.costs.temperature_deviation)


def replay(
    home: Home, exogenous: Exogenous, controller: Controller, initial: HomeState, key: Array
) -> Trajectory:
    """Let ``controller`` run ``home`` from ``initial`` through all slots of ``exogenous``.

    The slot counter starts at 0. The key feeds the disturbance and the controller, each its own part.
    """
    noise_key, controller_key = jax.random.split(key)
    slots = exogenous.slots
    disturbances = home.disturbances(noise_key, slots)
    keys = jax.random.split(controller_key, slots)

    def slot(
        state: HomeState, inputs: tuple[Exogenous, Array, Array]
    ) -> tuple[HomeState, tuple[Observation, Step]]:
        now, disturbance, key = inputs
        observation = observe(state, now)
        step = home.step(state, now, controller(observation, key), disturbance)
        return step.state, (observation, step)

    _, (observations, steps) = jax.lax.scan(slot, initial, (exogenous, disturbances, keys))
    return Trajectory(observations=observations, steps=steps)
