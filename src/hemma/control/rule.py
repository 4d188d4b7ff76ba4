"""Rule: a thermostat with hysteresis and no use of the battery."""

import jax.numpy as jnp

from hemma.home import AbstractController, ComfortBand, Hvac, Memory
from hemma.types import Action, Array, Observation


class Rule(AbstractController):
    """The benchmark ``Rule`` of the paper: on/off HVAC, battery idle.

    Cooling: h = h^max if T_in > T^upp, 0 if T_in < T^low, else the power of the slot before. Heating is
    the mirror image: h^max if T_in < T^low, 0 if T_in > T^upp.
    """

    hvac: Hvac
    """What is switched."""
    comfort: ComfortBand
    """Where it is switched."""

    def __call__(self, observation: Observation, memory: Memory, key: Array) -> tuple[Action, Memory]:
        """Action of the observed slot [kW]; no randomness, nothing to remember."""
        temperature = observation.indoor_temperature
        too_warm, too_cold = temperature > self.comfort.high, temperature < self.comfort.low
        on, off = (too_cold, too_warm) if self.hvac.heats else (too_warm, too_cold)
        kept = jnp.where(off, 0.0, observation.previous_hvac_power)
        hvac_power = jnp.where(on, self.hvac.max_power, kept)
        return Action(battery_power=jnp.zeros_like(temperature), hvac_power=hvac_power), memory
