"""The battery (energy storage system): equations (3) to (5) of the paper."""

import equinox as eqx
import jax.numpy as jnp

from hemma.home.checks import require
from hemma.types import Array, Scalar


class Battery(eqx.Module):
    """A battery with separate charging and discharging efficiencies; power is measured at the grid side.

    The defaults are the constants of the authors' earlier benchmark (see ``docs/paper.md``).
    """

    max_energy: Scalar = 6.0
    """E^max [kWh]."""
    min_energy: Scalar = 0.6
    """E^min [kWh]."""
    initial_energy: Scalar = 1.2
    """E at the first slot [kWh]."""
    max_charging_power: Scalar = 3.0
    """c^max [kW]."""
    max_discharging_power: Scalar = 3.0
    """d^max [kW], a magnitude."""
    charging_efficiency: Scalar = 0.95
    """eta_c, energy stored per energy drawn."""
    discharging_efficiency: Scalar = 0.95
    """eta_d, energy delivered per energy taken from the store."""
    ageing_cost: Scalar = 0.001
    """k_e [currency/kWh of throughput]; the paper's $/kW per slot at its slot length of one hour."""

    def __check_init__(self):
        """Refuse a battery that cannot exist."""
        require("battery", self.min_energy >= 0, "min_energy >= 0", self.min_energy)
        require("battery", self.max_energy >= self.min_energy, "max_energy >= min_energy", self.max_energy)
        inside = (self.min_energy <= self.initial_energy) & (self.initial_energy <= self.max_energy)
        require("battery", inside, "min_energy <= initial_energy <= max_energy", self.initial_energy)
        require("battery", self.max_charging_power >= 0, "max_charging_power >= 0", self.max_charging_power)
        require(
            "battery",
            self.max_discharging_power >= 0,
            "max_discharging_power >= 0",
            self.max_discharging_power,
        )
        for name in ("charging_efficiency", "discharging_efficiency"):
            value = getattr(self, name)
            require("battery", (value > 0) & (value <= 1), f"0 < {name} <= 1", value)
        require("battery", self.ageing_cost >= 0, "ageing_cost >= 0", self.ageing_cost)

    def power_limits(self, energy: Array, slot_length: Scalar) -> tuple[Array, Array]:
        """Lowest (discharging, <= 0) and highest (charging, >= 0) feasible power [kW] at ``energy`` [kWh].

        Equation (4), tightened so that equation (3) holds at the end of a slot of ``slot_length`` [h]:
        -min(d^max, (E - E^min) eta_d / dt) <= e <= min(c^max, (E^max - E) / (eta_c dt)).
        """
        room = jnp.maximum(self.max_energy - energy, 0.0) / (self.charging_efficiency * slot_length)
        store = jnp.maximum(energy - self.min_energy, 0.0) * self.discharging_efficiency / slot_length
        return -jnp.minimum(self.max_discharging_power, store), jnp.minimum(self.max_charging_power, room)

    def next_energy(self, energy: Array, power: Array, slot_length: Scalar) -> Array:
        """Energy [kWh] after a slot of ``slot_length`` [h] at ``power`` [kW], equation (5).

        E' = E + eta_c e dt if e > 0, else E + e dt / eta_d.
        """
        gain = jnp.where(power > 0, self.charging_efficiency * power, power / self.discharging_efficiency)
        return jnp.clip(energy + gain * slot_length, self.min_energy, self.max_energy)

    def ageing(self, power: Array, slot_length: Scalar) -> Array:
        """X2 = k_e |e| dt [currency]; at the paper's slot length of one hour this is its k_e |e|."""
        return self.ageing_cost * jnp.abs(power) * slot_length
