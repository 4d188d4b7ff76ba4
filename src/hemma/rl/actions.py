"""Actions as learners see them: fractions of what is feasible now."""

import jax.numpy as jnp
from jaxtyping import Float

from hemma.home import Home
from hemma.types import Action, Array


def to_power(home: Home, battery_energy: Array, fractions: Float[Array, "*batch 2"]) -> Action:
    """The action (e, h) [kW] of two fractions in [-1, 1]; values beyond are clipped to the bound.

    Battery: +1 charges at the highest power that is feasible at ``battery_energy`` [kWh], -1 discharges at
    the highest, 0 rests. HVAC: -1 is off, +1 is full power.
    """
    low, high = home.battery.power_limits(battery_energy, home.slot_length)
    bounded = jnp.clip(fractions, -1.0, 1.0)
    battery = bounded[..., 0]
    return Action(
        battery_power=jnp.where(battery > 0, battery * high, -battery * low),
        hvac_power=(bounded[..., 1] + 1) / 2 * home.hvac.max_power,
    )


def to_fractions(home: Home, battery_energy: Array, action: Action) -> Float[Array, "*batch 2"]:
    """The inverse of ``to_power``; where nothing is feasible but rest, the battery's fraction is 0."""
    low, high = home.battery.power_limits(battery_energy, home.slot_length)
    limit = jnp.where(action.battery_power > 0, high, -low)
    battery = action.battery_power / jnp.where(limit > 0, limit, 1.0)
    hvac = 2 * action.hvac_power / jnp.where(home.hvac.max_power > 0, home.hvac.max_power, 1.0) - 1
    return jnp.clip(jnp.stack([jnp.where(limit > 0, battery, 0.0), hvac], axis=-1), -1.0, 1.0)
