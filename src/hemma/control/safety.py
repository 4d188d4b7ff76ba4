"""The safety layer between a controller and the home."""

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Int

from hemma.home import AbstractController, Home, Memory, WrapperMemory
from hemma.home.comfort import observed_comfort_power
from hemma.types import Action, Array, Observation, Scalar

TINY = 1e-6
"""Changes of a power up to this are rounding [kW]."""


class Interventions(eqx.Module):
    """How often the safety layer changed an action."""

    limited: Int[Array, ""]
    """An action that was no number, or not feasible by the readings."""
    comfort: Int[Array, ""]
    """An HVAC power that fought the occupants."""


class SafetyLayer(AbstractController):
    """The last word on an action: it is a number, it is feasible, and it does not fight the occupants.

    Where T_in as read lies more than ``margin`` beyond the edge of comfort that the HVAC guards, it runs with
    the comfort action of ``home`` at least; more than ``margin`` beyond the other edge it stays off. A power
    that is not a number becomes the comfort action, or a battery at rest. It remembers how often it changed
    something (``Interventions``).
    """

    controller: AbstractController
    """Whose actions are guarded."""
    home: Home
    """As it is believed to be."""
    margin: Scalar = 1.0
    """[degC]."""

    @property
    def is_traceable(self) -> bool:
        """As the controller inside."""
        return self.controller.is_traceable

    def start(self) -> WrapperMemory:
        """Nothing changed yet."""
        none = jnp.zeros((), int)
        return WrapperMemory(Interventions(none, none), self.controller.start())

    def __call__(self, observation: Observation, memory: Memory, key: Array) -> tuple[Action, WrapperMemory]:
        """What goes to the home."""
        asked, inner = self.controller(observation, memory.inner, key)
        action, changed = self.guarded(observation, asked)
        return action, WrapperMemory(jax.tree.map(jnp.add, memory.own, changed), inner)

    def guarded(self, observation: Observation, asked: Action) -> tuple[Action, Interventions]:
        """What goes to the home when so much is ``asked``, and what was changed."""
        comfort = observed_comfort_power(self.home, observation)
        is_number = jnp.isfinite(asked.battery_power) & jnp.isfinite(asked.hvac_power)
        e = jnp.where(jnp.isfinite(asked.battery_power), asked.battery_power, 0.0)
        h = jnp.where(jnp.isfinite(asked.hvac_power), asked.hvac_power, comfort)
        low, high = self.home.battery.power_limits(observation.battery_energy, self.home.slot_length)
        limited = Action(jnp.clip(e, low, high), jnp.clip(h, 0.0, self.home.hvac.max_power))
        band, temperature = self.home.comfort, observation.indoor_temperature
        warm, cold = temperature > band.high + self.margin, temperature < band.low - self.margin
        needed, idle = (cold, warm) if self.home.hvac.heats else (warm, cold)
        guarded = jnp.where(needed, jnp.maximum(limited.hvac_power, comfort), limited.hvac_power)
        guarded = jnp.where(idle, 0.0, guarded)
        beyond = (jnp.abs(limited.battery_power - e) > TINY) | (jnp.abs(limited.hvac_power - h) > TINY)
        interventions = Interventions(
            limited=(beyond | ~is_number).astype(int),
            comfort=(jnp.abs(guarded - limited.hvac_power) > TINY).astype(int),
        )
        return Action(limited.battery_power, guarded), interventions
