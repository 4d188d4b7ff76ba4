"""Actions as learners see them: fractions of what is feasible now, the HVAC's counted from comfort."""

import jax.numpy as jnp
from jaxtyping import Float

from hemma.home import Home
from hemma.home.comfort import observed_comfort_power
from hemma.types import Action, Array, Observation

FINENESS = 5.0
"""kappa: an HVAC fraction is sinh(kappa) / kappa = 15 times as fine at comfort as linear ones would be."""


def to_power(planning_home: Home, observation: Observation, fractions: Float[Array, "*batch 2"]) -> Action:
    """The action (e, h) [kW] of two fractions in [-1, 1]; values beyond are clipped to the bound.

    Battery: +1 charges at the highest power that is feasible at the observed energy, -1 discharges at the
    highest, 0 rests. HVAC: 0 is the comfort action h_c, the least power that ends the slot within the band as
    far as the thermal model of ``planning_home`` knows; -1 is off and +1 full power. Between them

        h = h_c + f (h^max - h_c) for f > 0, h_c + f h_c for f < 0, f = sinh(kappa a) / sinh(kappa).

    A tenth of a degree is a few per cent of the power: comfort needs fine strokes, and only there.
    """
    low, high = planning_home.battery.power_limits(observation.battery_energy, planning_home.slot_length)
    bounded = jnp.clip(fractions, -1.0, 1.0)
    battery = bounded[..., 0]
    comfort = observed_comfort_power(planning_home, observation)
    share = jnp.sinh(FINENESS * bounded[..., 1]) / jnp.sinh(FINENESS)
    room = jnp.where(share > 0, planning_home.hvac.max_power - comfort, comfort)
    return Action(
        battery_power=jnp.where(battery > 0, battery * high, -battery * low),
        hvac_power=comfort + share * room,
    )


def to_fractions(planning_home: Home, observation: Observation, action: Action) -> Float[Array, "*batch 2"]:
    """The inverse of ``to_power``; where only one power is feasible, or on one side of comfort, 0."""
    low, high = planning_home.battery.power_limits(observation.battery_energy, planning_home.slot_length)
    battery = _share(action.battery_power, jnp.where(action.battery_power > 0, high, -low))
    comfort = observed_comfort_power(planning_home, observation)
    more = action.hvac_power - comfort
    share = _share(more, jnp.where(more > 0, planning_home.hvac.max_power - comfort, comfort))
    hvac = jnp.arcsinh(share * jnp.sinh(FINENESS)) / FINENESS
    return jnp.stack([battery, hvac], axis=-1)


def _share(power: Array, limit: Array) -> Array:
    feasible = limit > 1e-6  # of a kW: less is a rounding error
    return jnp.clip(jnp.where(feasible, power / jnp.where(feasible, limit, 1.0), 0.0), -1.0, 1.0)
