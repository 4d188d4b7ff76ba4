"""How well a thermal model predicts when it runs free: from one measured temperature, without correction."""

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Float

from hemma.errors import HemmaError
from hemma.home.thermal import AbstractThermalModel, ThermalDrivers, ThermalState
from hemma.identification.record import ThermalRecord
from hemma.types import Array

LONGEST = 24.0
"""Hours of the longest horizon that is measured."""


class FreeRunErrors(eqx.Module):
    """Root mean square errors of the free run [degC]."""

    one_hour: float
    """One hour after a measurement, over all start points."""
    six_hours: float
    """Six hours after a measurement, over all start points."""
    day: float
    """24 hours after a measurement, over all start points."""
    month: float
    """Over all slots of the whole record (usually a month), which knows its first temperature only."""


def run_free(model: AbstractThermalModel, drivers: ThermalDrivers, indoor_temperature: Array) -> ThermalState:
    """States at the fence posts (first axis), from measured temperatures [degC] and (slots, ...) drivers."""
    initial = model.initial(jnp.asarray(indoor_temperature, float))

    def slot(state: ThermalState, now: ThermalDrivers) -> tuple[ThermalState, ThermalState]:
        after = model(state, now)
        return after, after

    _, states = jax.lax.scan(slot, initial, drivers)
    return jax.tree.map(lambda first, rest: jnp.concatenate([first[None], rest]), initial, states)


@eqx.filter_jit
def free_run(model: AbstractThermalModel, record: ThermalRecord) -> Float[Array, "posts"]:
    """Predicted indoor temperature [degC] at all fence posts, given the first measured one."""
    return run_free(model, record.drivers, record.indoor_temperature[0]).indoor_temperature


def free_run_errors(model: AbstractThermalModel, record: ThermalRecord) -> FreeRunErrors:
    """Errors of ``model`` on ``record``; a horizon is rounded to whole slots, and is one slot at least."""
    whole = free_run(model, record) - record.indoor_temperature
    return FreeRunErrors(
        one_hour=_error_after(model, record, 1.0),
        six_hours=_error_after(model, record, 6.0),
        day=_error_after(model, record, LONGEST),
        month=float(jnp.sqrt(jnp.mean(whole[1:] ** 2))),
    )


def _error_after(model: AbstractThermalModel, record: ThermalRecord, hours: float) -> float:
    horizon = max(1, round(hours / float(record.slot_length)))
    if horizon > record.slots:
        raise HemmaError(
            f"validation: expected a record of at least {hours:g} h, got {record.slots} slots of "
            f"{float(record.slot_length):g} h; give a longer period"
        )
    return float(_horizon_error(model, record, horizon))


@eqx.filter_jit
def _horizon_error(model: AbstractThermalModel, record: ThermalRecord, horizon: int) -> Array:
    starts = jnp.arange(record.slots - horizon + 1)
    drivers, measured = windows(record, starts, horizon)
    predicted = run_free(model, drivers, measured[0]).indoor_temperature
    return jnp.sqrt(jnp.mean((predicted[-1] - measured[-1]) ** 2))


def windows(record: ThermalRecord, starts: Array, length: int) -> tuple[ThermalDrivers, Array]:
    """Drivers (length, starts) and indoor temperatures (length + 1, starts) of the windows at ``starts``."""
    index = jnp.arange(length + 1)[:, None] + starts[None, :]
    return jax.tree.map(lambda x: x[index[:-1]], record.drivers), record.indoor_temperature[index]
