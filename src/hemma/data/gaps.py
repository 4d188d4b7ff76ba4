"""Holes in logged series: short ones are interpolated and reported, long ones refused one by one."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from hemma.data.clock import Clock
from hemma.errors import HemmaError

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


@dataclass(frozen=True)
class Filled:
    """Series without holes, and what was done to them."""

    columns: Sequence[Float[np.ndarray, "slots"]]
    notes: tuple[str, ...]


def fill_gaps(
    name: str,
    clock: Clock,
    names: Sequence[str],
    columns: Sequence[Float[np.ndarray, "slots"]],
    longest: float,
) -> Filled:
    """Interpolate linearly over holes (NaN) of at most ``longest`` [h] that have values on both sides.

    Others raise a HemmaError that names each of them and the longest stretch without one.
    """
    holes = _holes(names, columns)
    refused = [
        hole
        for hole in holes
        if hole.start == 0
        or hole.stop == clock.slots
        or (hole.stop - hole.start) * clock.step > longest * 3600 + 1e-6
    ]
    if refused:
        raise HemmaError(_refusal(name, clock, refused, len(names), longest))
    slots = np.arange(clock.slots)
    filled = [np.interp(slots, slots[np.isfinite(c)], c[np.isfinite(c)]) for c in columns]
    return Filled(filled, _notes(clock, holes, len(names)))


def runs(mask: Bool[np.ndarray, "slots"]) -> list[tuple[int, int]]:
    """Start (included) and stop (excluded) of each run of true values."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]]).astype(int)))
    return [(int(start), int(stop)) for start, stop in edges.reshape(-1, 2)]


def duration(hours: float) -> str:
    """A duration for people: ``14 hours``, ``45 minutes``."""
    number, unit = (hours, "hour") if hours >= 1 else (60 * hours, "minute")
    return f"{number:.4g} {unit}{'' if number == 1 else 's'}"


def _holes(names: Sequence[str], columns: Sequence[Float[np.ndarray, "slots"]]) -> list[Hole]:
    owners: dict[tuple[int, int], list[str]] = {}
    for name, column in zip(names, columns, strict=True):
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


def _notes(clock: Clock, holes: list[Hole], columns: int) -> tuple[str, ...]:
    if len(holes) > MOST_NAMED:
        total = duration(sum(hole.stop - hole.start for hole in holes) * clock.slot_length)
        touched = sorted({column for hole in holes for column in hole.columns})
        return (
            f"{len(holes)} holes interpolated, {total} in all, the first at {clock.text(holes[0].start)}, "
            f"in {', '.join(touched)}",
        )
    return tuple(
        f"{hole.duration(clock)} interpolated from {clock.text(hole.start)} in {_where(hole, columns)}"
        for hole in holes
    )


def counted(number: int, what: str) -> str:
    """A number of things for people: ``1 row``, ``2 rows``."""
    return f"{number} {what}{'' if number == 1 else 's'}"
