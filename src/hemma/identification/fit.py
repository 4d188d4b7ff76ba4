"""Fit the physically consistent neural network to a record: multi-step sequences and the best checkpoint."""

from collections.abc import Callable
from typing import TypeVar

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Float

from hemma.errors import HemmaError
from hemma.identification.pcnn import InputScaling, PcnnWeights, PhysicallyConsistentNetwork, ThermalResponse
from hemma.identification.record import ThermalRecord
from hemma.identification.settings import IdentificationSettings
from hemma.identification.start import input_scaling, least_squares_response
from hemma.identification.training import NetworkTraining
from hemma.types import Array

Numbers = TypeVar("Numbers", ThermalResponse, InputScaling)
Progress = Callable[[int, int], None]
"""``on_progress(done, total)`` in updates; early stopping ends before total."""


class LearningCurve(eqx.Module):
    """Errors at the chunks of training; the first entry is the start."""

    updates: Float[Array, "chunks"]
    """Updates done."""
    training: Float[Array, "chunks"]
    """Root mean square error over the updates of the chunk [degC]; at the start that of validation."""
    validation: Float[Array, "chunks"]
    """Root mean square error over the validation windows [degC]."""


class Fit(eqx.Module):
    """A fitted model and how it came about."""

    model: PhysicallyConsistentNetwork
    """The checkpoint with the least validation error."""
    curve: LearningCurve
    settings: IdentificationSettings = eqx.field(static=True)
    best_update: int = eqx.field(static=True)
    """The update of the checkpoint; 0 means that training did not better the physical start."""


def fit(
    record: ThermalRecord,
    settings: IdentificationSettings,
    key: Array,
    start: ThermalResponse | None = None,
    on_progress: Progress | None = None,
) -> Fit:
    """Fit a PCNN to ``record``; the same arguments give the same model.

    ``start`` is the physical response to start from, by default that of constrained least squares.
    Raises ``HemmaError`` when the record is too short for the windows and when the loss is not a number.
    """
    length, first = parted(record.slots, float(record.slot_length), settings)
    training, validation = record.window(0, first), record.window(first, record.slots)
    weights_key, batch_key = jax.random.split(key)
    model = PhysicallyConsistentNetwork(
        weights=PcnnWeights.create(weights_key, settings.width, settings.depth),
        start=_as_arrays(least_squares_response(training) if start is None else start),
        scaling=_as_arrays(input_scaling(training)),
        slot_length=record.slot_length,
    )
    return _run(NetworkTraining(settings, length, training, validation), model, batch_key, on_progress)


def _as_arrays(numbers: Numbers) -> Numbers:
    """Numbers that are traced, so that another home does not mean another compilation."""
    return jax.tree.map(lambda x: jnp.asarray(x, float), numbers)


def parted(slots: int, slot_length: float, settings: IdentificationSettings) -> tuple[int, int]:
    """Slots of a window, and the first slot of the part of the record that validates."""
    length = max(1, round(settings.window / slot_length))
    first = slots - round(settings.validation_share * slots)
    if min(first, slots - first) < length:
        needed = settings.window / min(settings.validation_share, 1 - settings.validation_share)
        raise HemmaError(
            f"identification: expected a record of at least {needed:g} h for windows of "
            f"{settings.window:g} h, got {slots * slot_length:g} h; give a longer period or set a shorter "
            "window"
        )
    return length, first


def _run(
    training: NetworkTraining, start: PhysicallyConsistentNetwork, key: Array, on_progress: Progress | None
) -> Fit:
    """Chunks of updates are compiled; between them the host looks, reports and stops."""
    settings, state = training.settings, training.initial(start)
    first = float(training.validation_error(start))
    best, least, best_update = start, first, 0
    curve = [(0, first, first)]
    for done in range(0, settings.updates, settings.chunk):
        count = min(settings.chunk, settings.updates - done)
        state, losses = training.updates(state, jax.random.split(jax.random.fold_in(key, done), count))
        _require_finite(losses, done, settings)
        error = float(training.validation_error(state.model))
        curve.append((done + count, float(losses.mean()) ** 0.5, error))
        if error < least:
            best, least, best_update = state.model, error, done + count
        if on_progress is not None:
            on_progress(done + count, settings.updates)
        if done + count - best_update >= settings.patience * settings.chunk:
            break
    if least > (1 - settings.least_improvement) * first:
        best, best_update = start, 0
    return Fit(best, LearningCurve(*jnp.asarray(curve, float).T), settings, best_update)


def _require_finite(losses: Array, done: int, settings: IdentificationSettings) -> None:
    is_finite = jnp.isfinite(losses)
    if not bool(is_finite.all()):
        update = done + int(jnp.argmin(is_finite)) + 1
        raise HemmaError(
            f"identification: the loss is no longer a finite number at update {update} of "
            f"{settings.updates}; lower learning_rate (now {settings.learning_rate:g}) or shorten the "
            f"window (now {settings.window:g} h)"
        )
