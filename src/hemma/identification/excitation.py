"""Exciting inputs: a thermostat at work shows little of a building, random steps of power show it all."""

from dataclasses import dataclass

import jax
import jax.numpy as jnp

from hemma.home.checks import require
from hemma.home.home import Home
from hemma.home.thermal import ThermalState
from hemma.identification.record import ThermalRecord
from hemma.types import Array, Exogenous


@dataclass(frozen=True)
class Excitation:
    """Random HVAC levels, each held for a random time, inside a safe range of temperatures."""

    mean_hold: float = 3.0
    """Mean time for which a level is held [h], geometrically distributed: the scale of responses."""
    extreme_share: float = 0.5
    """Share of the levels that are fully on or off, half each; the others lie evenly between."""
    margin: float = 4.0
    """How far the temperature may leave the comfort band [degC] before the HVAC is set fully on or off."""

    def __post_init__(self):
        """Refuse settings without meaning."""
        require("excitation", self.mean_hold > 0, "mean_hold > 0", self.mean_hold)
        require("excitation", 0 <= self.extreme_share <= 1, "extreme_share in [0, 1]", self.extreme_share)
        require("excitation", self.margin >= 0, "margin >= 0", self.margin)


def excite(home: Home, exogenous: Exogenous, excitation: Excitation, key: Array) -> ThermalRecord:
    """Run the building of ``home`` through ``exogenous`` under random HVAC powers, drawn from ``key``.

    The home's thermal disturbance acts on the temperatures; the record, like any measurement, does not
    tell it. Call it compiled or not: it is one scan.
    """
    noise_key, draw_key, level_key = jax.random.split(key, 3)
    slots = exogenous.slots
    disturbances = home.disturbances(noise_key, slots)
    change = jax.random.bernoulli(
        draw_key, jnp.minimum(1.0, home.slot_length / excitation.mean_hold), (slots,)
    )
    levels = _levels(excitation, level_key, slots)

    def slot(
        carry: tuple[ThermalState, Array], now: tuple[Exogenous, Array, Array, Array]
    ) -> tuple[tuple[ThermalState, Array], tuple[Array, Array]]:
        thermal, held = carry
        outside, disturbance, changes, level = now
        held = jnp.where(changes, level, held)
        power = home.hvac.max_power * _safe(home, excitation, thermal.indoor_temperature, held)
        thermal = home.thermal_model(thermal, home.thermal_drivers(outside, power, disturbance))
        return (thermal, held), (thermal.indoor_temperature, power)

    initial = home.reset().thermal
    inputs = (exogenous, disturbances, change, levels)
    _, (temperatures, powers) = jax.lax.scan(slot, (initial, jnp.zeros((), float)), inputs)
    return ThermalRecord(
        drivers=home.thermal_drivers(exogenous, powers, jnp.zeros_like(powers)),
        indoor_temperature=jnp.concatenate([initial.indoor_temperature[None], temperatures]),
        slot_length=home.slot_length,
    )


def _levels(excitation: Excitation, key: Array, slots: int) -> Array:
    """Candidate levels as shares of the largest power, one a slot."""
    extreme_key, side_key, between_key = jax.random.split(key, 3)
    is_extreme = jax.random.bernoulli(extreme_key, excitation.extreme_share, (slots,))
    side = jax.random.bernoulli(side_key, 0.5, (slots,)).astype(float)
    return jnp.where(is_extreme, side, jax.random.uniform(between_key, (slots,)))


def _safe(home: Home, excitation: Excitation, temperature: Array, level: Array) -> Array:
    """The level, unless the building is so warm or cold that the HVAC must run fully or rest."""
    too_warm = temperature > home.comfort.high + excitation.margin
    too_cold = temperature < home.comfort.low - excitation.margin
    on, off = (too_cold, too_warm) if home.hvac.heats else (too_warm, too_cold)
    return jnp.where(on, 1.0, jnp.where(off, 0.0, level))
