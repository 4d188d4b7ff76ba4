"""Holes in logged series: short ones are filled and reported, long ones refused one by one.

What flows (power, temperature) is interpolated; what holds (a price) keeps the value before.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Int

from hemma.data.clock import Clock, duration, runs
from hemma.data.columns import Columns, Series
from hemma.errors import HemmaError

HOLDS = "_per_kwh"
"""Columns whose name ends so hold their value until the next: prices."""
LONGEST_HOLD = 24.0
"""Values that come less often than this [h] are no price list."""
MOST_NAMED = 10
"""So many holes are named one by one; more are summed up."""


@dataclass(frozen=True)
class Hole:
    """Slots without a value, from ``start`` (included) to ``stop`` (excluded)."""

    start: int
    stop: int
    columns: tuple[str, ...]
    """Columns that have this very hole."""

    def duration(self, clock: Clock) -> str:
        """How long it is, for people."""
        return duration((self.stop - self.start) * clock.slot_length)


def fill_gaps(name: str, columns: Columns, longest: float) -> Columns:
    """Fill holes (NaN) of at most ``longest`` [h] that have values on both sides.

    Prices hold the value before them, everything else is interpolated linearly. Prices that come regularly
    once in several slots hold until the next, whatever ``longest``. Other holes raise a HemmaError that names
    each of them and the longest stretch without one.
    """
    clock = columns.clock
    series, notes = _spread(columns)
    holes = _holes(series)
    refused = [
        hole
        for hole in holes
        if hole.start == 0
        or hole.stop == clock.slots
        or (hole.stop - hole.start) * clock.step > longest * 3600 + 1e-6
    ]
    if refused:
        raise HemmaError(_refusal(name, clock, refused, len(series), longest))
    filled = {name: _without_holes(name, column) for name, column in series.items()}
    return Columns(clock, filled, (*columns.notes, *notes, *_notes(clock, holes, len(series))))


def _spread(columns: Columns) -> tuple[dict[str, Series], list[str]]:
    """Prices that come once in several slots, held over the slots that they are given for."""
    clock, spread, notes = columns.clock, dict(columns.series), []
    for name, column in columns.series.items():
        period = _period(column) if name.endswith(HOLDS) else 1
        if 1 < period <= LONGEST_HOLD / clock.slot_length:
            latest = _latest(column)
            held = np.isnan(column) & (np.arange(clock.slots) - latest < period)
            spread[name] = np.where(held, column[latest], column)
            every = duration(period * clock.slot_length)
            notes.append(f"{name} comes once in {every}: each value is held until the next")
    return spread, notes


def _period(column: Series) -> int:
    """Number of slots between most of the values that follow each other."""
    distances = np.diff(np.flatnonzero(np.isfinite(column)))
    if len(distances) < 2:
        return 1
    lengths, counts = np.unique(distances, return_counts=True)
    return int(lengths[np.argmax(counts)]) if 2 * counts.max() > len(distances) else 1


def _latest(column: Series) -> Int[np.ndarray, "slots"]:
    """The slot of the latest value in each slot, the first slot before there is one."""
    return np.maximum.accumulate(np.where(np.isfinite(column), np.arange(len(column)), 0))


def _without_holes(name: str, column: Series) -> Series:
    if name.endswith(HOLDS):
        return column[_latest(column)]
    slots, known = np.arange(len(column)), np.isfinite(column)
    return np.interp(slots, slots[known], column[known])


def _holes(series: Mapping[str, Series]) -> list[Hole]:
    owners: dict[tuple[int, int], list[str]] = {}
    for name, column in series.items():
        for run in runs(np.isnan(column)):
            owners.setdefault(run, []).append(name)
    return [Hole(start, stop, tuple(owners[start, stop])) for start, stop in sorted(owners)]


def _where(hole: Hole, columns: int) -> str:
    return "every column" if 1 < columns == len(hole.columns) else ", ".join(hole.columns)


def _refusal(name: str, clock: Clock, holes: list[Hole], columns: int, longest: float) -> str:
    named = "; ".join(
        f"{hole.duration(clock)} missing from {clock.text(hole.start)} in {_where(hole, columns)}"
        for hole in holes[:MOST_NAMED]
    )
    more = f"; and {len(holes) - MOST_NAMED} more" if len(holes) > MOST_NAMED else ""
    return (
        f"{name}: expected no hole longer than {duration(longest)} and none at the ends, got {len(holes)}: "
        f"{named}{more}. {_longest_stretch(clock, holes)}Fill the holes from elsewhere, or cut the period"
    )


def _longest_stretch(clock: Clock, holes: list[Hole]) -> str:
    missing = np.zeros(clock.slots, bool)
    for hole in holes:
        missing[hole.start : hole.stop] = True
    stretches = runs(~missing)
    if not stretches:
        return ""
    start, stop = max(stretches, key=lambda stretch: stretch[1] - stretch[0])
    days = (stop - start) * clock.slot_length / 24
    return f"The longest stretch without one has {days:.1f} days, {clock.text(start)} to {clock.text(stop)}. "


def _notes(clock: Clock, holes: list[Hole], columns: int) -> list[str]:
    notes = []
    for filled, holds in (("interpolated", False), ("held", True)):
        parts = [
            replace(hole, columns=tuple(name for name in hole.columns if name.endswith(HOLDS) == holds))
            for hole in holes
        ]
        parts = [hole for hole in parts if hole.columns]
        if len(parts) > MOST_NAMED:
            notes.append(_summed(clock, parts, filled))
            continue
        for hole in parts:
            where = f"from {clock.text(hole.start)} in {_where(hole, columns)}"
            notes.append(f"{hole.duration(clock)} {filled} {where}")
    return notes


def _summed(clock: Clock, holes: list[Hole], filled: str) -> str:
    total = duration(sum(hole.stop - hole.start for hole in holes) * clock.slot_length)
    touched = sorted({column for hole in holes for column in hole.columns})
    return (
        f"{len(holes)} holes {filled}, {total} in all, the first at {clock.text(holes[0].start)}, "
        f"in {', '.join(touched)}"
    )


def counted(number: int, what: str) -> str:
    """A number of things for people: ``1 row``, ``2 rows``."""
    return f"{number} {what}{'' if number == 1 else 's'}"
