"""Sensors that err, lag and fail between a home and its controller."""

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Bool, Float, Int

from hemma.home import AbstractController, Battery, Memory, WrapperMemory
from hemma.types import Action, Array, Exogenous, Observation


class Readings(eqx.Module):
    """What sensors make of a period, one value a slot, and what disturbs the building meanwhile."""

    exogenous: Exogenous
    """As it is read: a missing reading is the last one before it."""
    temperature_error: Float[Array, "slots"]
    """Added to T_in [degC]."""
    energy_error: Float[Array, "slots"]
    """Added to E [kWh]; the reading stays within the battery's limits."""
    is_temperature_missing: Bool[Array, "slots"]
    is_energy_missing: Bool[Array, "slots"]
    lag: Int[Array, ""]
    """1 where T_in is that of the slot before, else 0."""
    disturbance: Float[Array, "slots"]
    """epsilon_t [degC]."""


def faultless(exogenous: Exogenous) -> Readings:
    """Everything as it is, nothing disturbed."""
    nothing = jnp.zeros(exogenous.slots)
    present = jnp.zeros(exogenous.slots, bool)
    return Readings(exogenous, nothing, nothing, present, present, jnp.zeros((), int), nothing)


class Sensors(AbstractController):
    """A controller that sees the home by its ``readings``; T_in or E is NaN where it is missing.

    Before the first slot everything was as it is, so the first reading is never missing. It remembers T_in of
    the slot before as it was [degC].
    """

    controller: AbstractController
    """Who sees it so."""
    readings: Readings
    battery: Battery
    """Within whose limits E is read."""

    @property
    def is_traceable(self) -> bool:
        """As the controller inside."""
        return self.controller.is_traceable

    def start(self) -> WrapperMemory:
        """Nothing seen yet."""
        return WrapperMemory(jnp.full((), jnp.nan), self.controller.start())

    def __call__(self, observation: Observation, memory: Memory, key: Array) -> tuple[Action, WrapperMemory]:
        """What the controller does by the readings."""
        read = _read(self.readings, self.battery, observation, memory.own)
        action, inner = self.controller(read, memory.inner, key)
        return action, WrapperMemory(observation.indoor_temperature, inner)


@eqx.filter_jit
def _read(readings: Readings, battery: Battery, observation: Observation, earlier: Array) -> Observation:
    """The observation as the sensors give it; ``earlier`` is T_in of the slot before [degC]."""
    r, slot = readings, observation.slot
    seen, is_first = jax.tree.map(lambda x: x[slot], r.exogenous), slot == 0
    T, E = observation.indoor_temperature, observation.battery_energy
    temperature = jnp.where((r.lag > 0) & ~is_first, earlier, T) + r.temperature_error[slot]
    energy = jnp.clip(E + r.energy_error[slot], battery.min_energy, battery.max_energy)

    def read(reading: Array, true: Array, is_missing: Array) -> Array:
        return jnp.where(is_missing, jnp.where(is_first, true, jnp.nan), reading)

    quantities = {name: getattr(seen, name) for name in seen.__dataclass_fields__}
    return Observation(
        **quantities,
        indoor_temperature=read(temperature, T, r.is_temperature_missing[slot]),
        battery_energy=read(energy, E, r.is_energy_missing[slot]),
        previous_hvac_power=observation.previous_hvac_power,
        slot=slot,
    )
