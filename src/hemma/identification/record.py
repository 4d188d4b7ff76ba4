"""What a thermal model is identified from: drivers and measured indoor temperatures, simulated or logged."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jax.core import Tracer
from jaxtyping import Float

from hemma.errors import HemmaError
from hemma.home.checks import require
from hemma.home.home import Home
from hemma.home.thermal import ThermalDrivers
from hemma.types import Array, Exogenous, Scalar


class ThermalRecord(eqx.Module):
    """A period of T consecutive slots without holes."""

    drivers: ThermalDrivers
    """What acted on the building, shape (slots,); its disturbance is zero, for nobody measures it."""
    indoor_temperature: Float[Array, "posts"]
    """Measured indoor temperature [degC] at the T+1 fence posts."""
    slot_length: Scalar
    """dt [h]."""

    def __check_init__(self):
        """Refuse lengths that do not fit together and values that are not numbers."""
        shape, posts = self.drivers.hour_of_day.shape, self.indoor_temperature.shape[0]
        if shape != (posts - 1,):
            raise HemmaError(
                f"thermal record: expected one indoor temperature more than slots, got {posts} temperatures "
                f"for {shape[0]} slots; add the temperature at the end of the last slot"
            )
        require("thermal record", self.slot_length > 0, "slot_length > 0", self.slot_length)
        for path, leaf in jax.tree_util.tree_leaves_with_path((self.drivers, self.indoor_temperature)):
            if not isinstance(leaf, Tracer) and not np.isfinite(leaf).all():
                where = int(np.argmin(np.isfinite(leaf)))
                name = jax.tree_util.keystr(path[1:]).lstrip(".") or "indoor_temperature"
                raise HemmaError(
                    f"thermal record: expected finite numbers, got {float(leaf[where])} in slot {where} of "
                    f"{name}; fill the gap or cut the period there"
                )

    @property
    def slots(self) -> int:
        """Number of slots T."""
        return self.indoor_temperature.shape[0] - 1

    def window(self, start: int, stop: int) -> "ThermalRecord":
        """The slots from ``start`` (included) to ``stop`` (excluded) and their fence posts."""
        drivers = jax.tree.map(lambda x: x[start:stop], self.drivers)
        return ThermalRecord(drivers, self.indoor_temperature[start : stop + 1], self.slot_length)


def logged_record(
    home: Home, exogenous: Exogenous, indoor_temperature: Array, hvac_power: Array
) -> ThermalRecord:
    """The record of a log: indoor temperature [degC] at the start of each slot and HVAC power [kW].

    The last row gives only the temperature at the end of the slot before. Whether the power heated or
    cooled is said by ``home.hvac``. Logs with holes are refused: give their whole stretches one by one.
    """
    whole = exogenous.window(0, exogenous.slots - 1)
    power = jnp.asarray(hvac_power[:-1], float)
    drivers = home.thermal_drivers(whole, power, jnp.zeros_like(power))
    return ThermalRecord(drivers, jnp.asarray(indoor_temperature, float), home.slot_length)
