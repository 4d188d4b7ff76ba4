"""Comfort held without a battery: what a home costs when nothing shifts energy in time."""

import jax.numpy as jnp

from hemma.home import AbstractController, Home, Memory
from hemma.home.comfort import observed_comfort_power
from hemma.types import Action, Array, Observation


class ComfortHold(AbstractController):
    """The HVAC at the least power that ends each slot within the comfort band, battery idle.

    It knows the home's thermal model; give it a home with an identified model to hold comfort by that.
    """

    home: Home
    """Thermal model, HVAC and comfort band that the law goes by."""

    def __call__(self, observation: Observation, memory: Memory, key: Array) -> tuple[Action, Memory]:
        """Action of the observed slot [kW]; no randomness, nothing to remember."""
        rest = jnp.zeros_like(observation.indoor_temperature)
        return Action(rest, observed_comfort_power(self.home, observation)), memory
