"""Comfort held with the least power: the one-slot law that the expert, the baselines and learners share."""

import jax
import jax.numpy as jnp

from hemma.home.home import Home
from hemma.home.thermal import ThermalState
from hemma.types import Array, Exogenous, Observation


def comfort_power(home: Home, thermal: ThermalState, exogenous: Exogenous) -> Array:
    """Smallest h in [0, h^max] [kW] that ends the slot at T^upp or below (heating: at T^low or above).

    h = clip((T^upp - T'(0)) / (dT'/dh)(0), 0, h^max), with the temperature T' at the end of the slot and
    its slope taken from the home's own thermal model; h^max where even that does not reach the band. On
    the explicit model this is clip((eps T + (1 - eps) T_out - T^upp) A / ((1 - eps) eta), 0, h^max).

    Exact where T' is affine in h, as in the explicit model and the physically consistent network;
    elsewhere it is the first Newton step from h = 0. The disturbance is unknown and taken as 0. A model
    in which the HVAC has no effect, or the wrong one, gives 0.

    Shapes: all values of one slot, or all of the same batch.
    """

    def temperature_after(h: Array) -> Array:
        drivers = home.thermal_drivers(exogenous, h, jnp.zeros_like(h))
        return home.thermal_model(thermal, drivers).indoor_temperature

    idle = jnp.zeros_like(thermal.indoor_temperature)
    temperature, slope = jax.jvp(temperature_after, (idle,), (jnp.ones_like(idle),))
    target = home.comfort.low if home.hvac.heats else home.comfort.high
    works = slope > 0 if home.hvac.heats else slope < 0
    needed = jnp.where(works, (target - temperature) / jnp.where(works, slope, 1.0), 0.0)
    return jnp.clip(needed, 0.0, home.hvac.max_power)


def observed_comfort_power(home: Home, observation: Observation) -> Array:
    """``comfort_power`` from what a controller sees: the building is taken as just measured."""
    thermal = home.thermal_model.initial(observation.indoor_temperature)
    return comfort_power(home, thermal, observed_exogenous(observation))


def observed_exogenous(observation: Observation) -> Exogenous:
    """What a controller sees that the home does not decide."""
    o = observation
    return Exogenous(
        pv_generation=o.pv_generation,
        load=o.load,
        outdoor_temperature=o.outdoor_temperature,
        buying_price=o.buying_price,
        selling_price=o.selling_price,
        hour_of_day=o.hour_of_day,
    )
