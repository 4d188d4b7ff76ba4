"""State estimation: from what is read to what a controller goes by."""

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Bool, Float

from hemma.control.adaptation import Adaptation, corrected, unadapted
from hemma.home import AbstractController, Home, Memory, WrapperMemory
from hemma.home.comfort import observed_exogenous
from hemma.types import Action, Array, Exogenous, Observation


class Estimate(eqx.Module):
    """What was read last."""

    temperature: Float[Array, ""]
    """T_in as last read [degC]."""
    energy: Float[Array, ""]
    """E as last read [kWh]."""
    reading: Float[Array, ""]
    """T_in in the slot before [degC]; NaN where it was missing."""
    exogenous: Exogenous
    """The slot before, as it was read."""
    has_begun: Bool[Array, ""]
    """Whether there was a slot before."""
    adaptation: Adaptation
    """What is known of the building."""


class StateEstimator(AbstractController):
    """A controller that goes by the last reading where one is missing (NaN).

    If it ``adapts``, late thermometers are noticed, and the controller acts by a building that is corrected
    in every slot by what was read in the slots before (``hemma.control.adaptation``).
    """

    controller: AbstractController
    """Who goes by the estimate; every home inside it is corrected."""
    home: Home
    """As it was identified."""
    adapts: bool = eqx.field(static=True, default=False)

    @property
    def is_traceable(self) -> bool:
        """As the controller inside."""
        return self.controller.is_traceable

    def start(self) -> WrapperMemory:
        """Nothing read yet."""
        unknown = jnp.full((), jnp.nan)
        adaptation = unadapted(self.home)
        begin = Estimate(unknown, unknown, unknown, adaptation.exogenous, jnp.zeros((), bool), adaptation)
        return WrapperMemory(begin, self.controller.start())

    def __call__(self, observation: Observation, memory: Memory, key: Array) -> tuple[Action, WrapperMemory]:
        """What the controller does by the estimate."""
        estimate, observation = _estimated(self.home, self.adapts, memory.own, observation)
        acting = corrected(self.controller, estimate.adaptation) if self.adapts else self.controller
        action, inner = acting(observation, memory.inner, key)
        return action, WrapperMemory(estimate, inner)


@eqx.filter_jit
def _estimated(
    home: Home, adapts: bool, last: Estimate, observation: Observation
) -> tuple[Estimate, Observation]:
    """The estimate of a slot, and the observation that goes by it."""
    reading, read = observation.indoor_temperature, observed_exogenous(observation)
    temperature = jnp.where(jnp.isnan(reading), last.temperature, reading)
    energy = jnp.where(jnp.isnan(observation.battery_energy), last.energy, observation.battery_energy)
    adaptation, now = last.adaptation, temperature
    if adapts:
        learned = adaptation.learned(
            home, (last.reading, reading), last.exogenous, observation.previous_hvac_power
        )
        adaptation = jax.tree.map(lambda new, old: jnp.where(last.has_begun, new, old), learned, adaptation)
        now = adaptation.temperature(home, temperature, read)
    estimate = Estimate(temperature, energy, reading, read, jnp.ones((), bool), adaptation)
    seen = eqx.tree_at(lambda o: (o.indoor_temperature, o.battery_energy), observation, (now, energy))
    return estimate, seen
