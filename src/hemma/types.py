"""Every quantity once: its name, symbol in the paper, unit, sign and shape.

Powers are mean values over a slot [kW], energies and temperatures stand at fence posts [kWh, degC],
prices are currency per kWh. Positive is into the home: buying, charging, HVAC power. PV generation and
load are magnitudes. A leading shape ``*slots`` is empty for one slot and ``slots`` for a period.
"""

from enum import IntEnum
from typing import TypeAlias

import equinox as eqx
import jax
import numpy as np
from jaxtyping import Float, Int

Array: TypeAlias = jax.Array | np.ndarray
Scalar: TypeAlias = float | Float[Array, ""]
"""A parameter: a Python float, or an array of shape () when traced (stacked homes are vmapped over)."""


class Exogenous(eqx.Module):
    """What the home does not decide, one value a slot."""

    pv_generation: Float[Array, "*slots"]
    """p, PV generation [kW], at least 0."""
    load: Float[Array, "*slots"]
    """l, non-shiftable load [kW], at least 0."""
    outdoor_temperature: Float[Array, "*slots"]
    """T_out, outdoor temperature [degC]."""
    buying_price: Float[Array, "*slots"]
    """u+, buying price [currency/kWh]; may be negative."""
    selling_price: Float[Array, "*slots"]
    """u-, selling price [currency/kWh]; may be negative."""
    hour_of_day: Float[Array, "*slots"]
    """t', local hour of the day at the start of the slot, in [0, 24)."""

    @property
    def slots(self) -> int:
        """Number of slots T."""
        return self.pv_generation.shape[0]

    def window(self, start: int, stop: int) -> "Exogenous":
        """The slots from ``start`` (included) to ``stop`` (excluded)."""
        return jax.tree.map(lambda x: x[start:stop], self)


class Action(eqx.Module):
    """a = (e, h), what the controller decides for a slot."""

    battery_power: Float[Array, "*slots"]
    """e, battery power at the grid side [kW], charging positive."""
    hvac_power: Float[Array, "*slots"]
    """h, HVAC electric power [kW], at least 0."""


class Costs(eqx.Module):
    """The three costs of a slot, equations (1) and (2). No reward: that is the learner's affair."""

    transaction: Float[Array, "*slots"]
    """X1, cost of the energy bought minus income of the energy sold [currency]."""
    ageing: Float[Array, "*slots"]
    """X2, ageing of the battery [currency]."""
    temperature_deviation: Float[Array, "*slots"]
    """X3, distance of the indoor temperature at the end of the slot from the comfort band [degC]."""


class Observation(eqx.Module):
    """What a controller may look at when it decides slot t. The paper's state is a part of it."""

    pv_generation: Float[Array, "*slots"]
    """p [kW] in the slot."""
    load: Float[Array, "*slots"]
    """l [kW] in the slot."""
    battery_energy: Float[Array, "*slots"]
    """E [kWh] at the start of the slot."""
    outdoor_temperature: Float[Array, "*slots"]
    """T_out [degC] in the slot."""
    indoor_temperature: Float[Array, "*slots"]
    """T_in [degC] at the start of the slot."""
    buying_price: Float[Array, "*slots"]
    """u [currency/kWh] in the slot."""
    selling_price: Float[Array, "*slots"]
    """u- [currency/kWh] in the slot; not in the paper's state."""
    hour_of_day: Float[Array, "*slots"]
    """t' in [0, 24)."""
    previous_hvac_power: Float[Array, "*slots"]
    """HVAC power of the slot before [kW]: what a thermostat with hysteresis keeps."""
    slot: Int[Array, "*slots"]
    """Index of the slot in the replayed period: where a schedule finds its row."""


class PaperState(IntEnum):
    """Positions in s = (p, l, E, T_out, T_in, u, t'), the state of the paper, named as in ``Observation``."""

    PV_GENERATION = 0
    LOAD = 1
    BATTERY_ENERGY = 2
    OUTDOOR_TEMPERATURE = 3
    INDOOR_TEMPERATURE = 4
    BUYING_PRICE = 5
    HOUR_OF_DAY = 6
