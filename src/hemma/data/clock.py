"""Time stamps, and the regular clock they stand on. Daylight saving time is handled here and nowhere else."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta, timezone

import numpy as np
from jaxtyping import Bool, Float, Int

from hemma.errors import HemmaError

MOST_SLOTS_PER_ROW = 10
"""A file whose span has more slots than this per row has a wrong time stamp rather than holes."""
OTHER_LENGTH = 6
"""So many rows in succession at one other distance are slots of another length rather than holes."""
EARLIEST_OFFSET, LATEST_OFFSET = -12.0, 14.0
"""Wall clocks of the world minus UTC [h]."""
LARGEST_CHANGE = 2.0
"""No daylight saving moves the wall clock by more than this [h]."""
SHORTEST_SEASON = 14 * 86400
"""Nobody changes the wall clock again before this [s]; the month of Ramadan is the shortest season."""
DAY = 86400
THURSDAY = 3
"""Day of the week of 1 January 1970, Monday being 0."""

Series = Float[np.ndarray, "slots"]
"""A value for every slot of a clock."""


@dataclass(frozen=True)
class Stamps:
    """The time stamps of a file's rows."""

    seconds: Int[np.ndarray, "rows"]
    """Moment, in seconds since 1970-01-01T00:00:00Z."""
    offset: Float[np.ndarray, "rows"]
    """Wall clock minus UTC [h]."""
    places: Sequence[str]
    """Where each row stands, such as ``line 12``."""

    def text(self, row: int) -> str:
        """ISO 8601 with the offset."""
        return iso_text(int(self.seconds[row]), float(self.offset[row]))


@dataclass(frozen=True)
class Clock:
    """Regular slots and their wall clock."""

    start: int
    """Start of the first slot [s since 1970-01-01T00:00:00Z]."""
    step: int
    """Length of a slot [s]."""
    offset: Float[np.ndarray, "slots"]
    """Wall clock minus UTC [h]."""

    @property
    def slots(self) -> int:
        """Number of slots."""
        return len(self.offset)

    @property
    def slot_length(self) -> float:
        """dt [h]."""
        return self.step / 3600

    @property
    def seconds(self) -> Int[np.ndarray, "slots"]:
        """Start of each slot [s since 1970-01-01T00:00:00Z]."""
        return self.start + self.step * np.arange(self.slots, dtype=np.int64)

    @property
    def wall(self) -> Int[np.ndarray, "slots"]:
        """Wall clock at the start of each slot [s since its 1970-01-01T00:00:00]."""
        return wall_clock(self.seconds, self.offset)

    def hour_of_day(self) -> Float[np.ndarray, "slots"]:
        """Local wall clock hour at the start of each slot, in [0, 24)."""
        return (self.wall % DAY) / 3600

    def weekdays(self) -> Int[np.ndarray, "slots"]:
        """Day of the week of each slot by the wall clock, Monday 0."""
        return (self.wall // DAY + THURSDAY) % 7

    def stamps(self) -> list[str]:
        """Start of each slot, ISO 8601 with the offset: ``2021-08-01T00:00:00-06:00``."""
        return [iso_text(*slot) for slot in zip(self.seconds.tolist(), self.offset.tolist(), strict=True)]

    def text(self, slot: int) -> str:
        """Start of a slot, ISO 8601 with the offset; the slot after the last is the end."""
        offset = float(self.offset[min(slot, self.slots - 1)])
        return iso_text(self.start + slot * self.step, offset)

    def window(self, start: int, stop: int) -> "Clock":
        """The slots from ``start`` (included) to ``stop`` (excluded)."""
        return Clock(self.start + start * self.step, self.step, self.offset[start:stop])


@dataclass(frozen=True)
class Placement:
    """The regular clock of a file, and the slot of each of its rows."""

    clock: Clock
    slot: Int[np.ndarray, "rows"]

    def placed(self, values: Float[np.ndarray, "rows"]) -> Float[np.ndarray, "slots"]:
        """The values of the rows in their slots, NaN in slots that have no row."""
        series = np.full(self.clock.slots, np.nan)
        series[self.slot] = values
        return series


def regular_clock(stamps: Stamps, name: str) -> Placement:
    """The regular clock on which the rows of the file ``name`` stand, in order, each slot at most once."""
    if len(stamps.seconds) < 2:
        raise HemmaError(
            f"{name}: expected at least two rows, got {len(stamps.seconds)}. Give a file with some days"
        )
    steps = np.diff(stamps.seconds)
    _check_order(stamps, steps, name)
    _check_offsets(stamps, name)
    lengths, counts = np.unique(steps, return_counts=True)
    step = int(lengths[np.argmax(counts)])
    _check_one_length(stamps, steps, step, name)
    slot = (stamps.seconds - stamps.seconds[0]) // step
    slots = int(slot[-1]) + 1
    if slots > MOST_SLOTS_PER_ROW * (len(slot) + 10):
        raise HemmaError(
            f"{name}: expected about one row every {step / 3600:g} h, got {len(slot)} rows between "
            f"{stamps.text(0)} and {stamps.text(-1)}. Correct the time stamps"
        )
    latest_row = np.maximum.accumulate(np.bincount(slot, np.arange(len(slot)), slots).astype(int))
    return Placement(Clock(int(stamps.seconds[0]), step, stamps.offset[latest_row]), slot)


def require_whole_days(clock: Clock, name: str) -> None:
    """Refuse slots that do not divide a day: forecasts and schedules go by the time of the day."""
    if DAY % clock.step:
        raise HemmaError(
            f"{name}: expected slots that divide a day, such as 15, 30 or 60 minutes, got slots of "
            f"{clock.step / 60:.4g} minutes ({clock.text(0)}, {clock.text(1)}). Bring the rows to such a "
            "length: means for powers and temperatures, the price that holds"
        )


def _check_order(stamps: Stamps, steps: Int[np.ndarray, "steps"], name: str) -> None:
    bad = np.flatnonzero(steps <= 0)
    if not len(bad):
        return
    row = int(bad[0]) + 1
    what = "is there twice" if steps[bad[0]] == 0 else f"comes after {stamps.text(row - 1)}"
    raise HemmaError(
        f"{name}, {stamps.places[row]}: expected time stamps in increasing order, each once, but "
        f"{stamps.text(row)} {what} ({len(bad)} such rows). Sort the rows and take the doubles out"
    )


def _check_offsets(stamps: Stamps, name: str) -> None:
    """Offsets that exist, and no more changes of them than daylight saving makes."""
    offset = stamps.offset
    strange = (offset < EARLIEST_OFFSET) | (offset > LATEST_OFFSET) | (offset % 0.25 != 0)
    changes = np.flatnonzero(np.diff(offset)) + 1
    again = np.flatnonzero(np.diff(stamps.seconds[changes]) < SHORTEST_SEASON)
    large = np.flatnonzero(np.abs(np.diff(offset)[changes - 1]) > LARGEST_CHANGE)
    if strange.any():
        row = int(np.argmax(strange))
        expected = "an offset from UTC that exists, quarters of an hour between -12:00 and +14:00"
    elif len(set(offset.tolist())) > 2:
        seen = set(offset[: changes[1]].tolist())
        row = next(int(change) for change in changes if offset[change] not in seen)
        expected = "at most two offsets from UTC, standard and daylight saving time"
    elif len(large):
        row = int(changes[large[0]])
        expected = f"an offset from UTC that daylight saving changes by at most {LARGEST_CHANGE:g} hours"
    elif len(again):
        row = int(changes[again[0] + 1])
        expected = "offsets from UTC that change in spring and autumn, not back and forth"
    else:
        return
    before = f" after {stamps.text(row - 1)}" if row else ""
    raise HemmaError(
        f"{name}, {stamps.places[row]}: expected {expected}, got {stamps.text(row)}{before}. "
        "Write each row with the offset of the home's wall clock at that moment"
    )


def _check_one_length(stamps: Stamps, steps: Int[np.ndarray, "steps"], step: int, name: str) -> None:
    """Rows off the clock, and stretches of rows on every second or fourth of its slots, are refused."""
    ends = np.concatenate([[0], np.flatnonzero(np.diff(steps)) + 1, [len(steps)]])
    other = (np.diff(ends) >= OTHER_LENGTH) & (steps[ends[:-1]] != step)
    if other.any():
        first = int(ends[np.argmax(other)])
        raise HemmaError(
            f"{name}, {stamps.places[first + 1]}: expected slots of one length, mostly {step / 60:g} "
            f"minutes, but from {stamps.text(first)} on they have {steps[first] / 60:g} minutes. Bring all "
            "rows to one length, or cut the file there"
        )
    irregular = steps % step != 0
    if irregular.any():
        row = int(np.argmax(irregular)) + 1
        raise HemmaError(
            f"{name}, {stamps.places[row]}: expected slots of one length, mostly {step / 60:g} minutes, but "
            f"{stamps.text(row)} follows {stamps.text(row - 1)} ({int(irregular.sum())} such rows). "
            "Bring the rows to a regular clock"
        )


def wall_clock(
    seconds: Int[np.ndarray, "rows"], offset: Float[np.ndarray, "rows"]
) -> Int[np.ndarray, "rows"]:
    """Moments [s since 1970-01-01T00:00:00Z] on wall clocks ``offset`` [h] ahead of UTC."""
    return seconds + np.round(offset * 3600).astype(np.int64)


def runs(mask: Bool[np.ndarray, "slots"]) -> list[tuple[int, int]]:
    """Start (included) and stop (excluded) of each run of true values."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]]).astype(int)))
    return [(int(start), int(stop)) for start, stop in edges.reshape(-1, 2)]


def duration(hours: float) -> str:
    """A duration for people: ``14 hours``, ``45 minutes``."""
    number, unit = (hours, "hour") if hours >= 1 else (60 * hours, "minute")
    return f"{number:.4g} {unit}{'' if number == 1 else 's'}"


def iso_text(seconds: int, offset: float) -> str:
    """ISO 8601 of a moment [s since 1970-01-01T00:00:00Z] on a wall clock ``offset`` [h] ahead of UTC."""
    zone = timezone(timedelta(hours=offset))
    return datetime.fromtimestamp(seconds, UTC).astimezone(zone).isoformat()
