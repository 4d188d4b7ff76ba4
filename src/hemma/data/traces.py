"""Traces: what a home saw, slot by slot, and its split into a training and a test period."""

from dataclasses import dataclass, replace
from datetime import datetime
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float, Int

from hemma.errors import HemmaError
from hemma.types import Exogenous

if TYPE_CHECKING:
    import pandas

TEST_DAYS = 31
"""Length of the test period unless a start is given; the paper's month of August."""


@dataclass(frozen=True)
class Traces:
    """Regular time series of one home, without holes, one value a slot. Slot t covers [t, t+1)."""

    name: str
    """``austin2021-1``, or the stem of the file."""
    time: "pandas.DatetimeIndex"
    """Start of each slot, with a time zone, regular."""
    exogenous: Exogenous
    """What the home did not decide, NumPy float64. Its hour of day is that of the local wall clock."""
    indoor_temperature: Float[np.ndarray, "slots"] | None
    """Logged T_in [degC] at the start of each slot, that is before the HVAC power of the slot acts."""
    hvac_power: Float[np.ndarray, "slots"] | None
    """Logged electric power of the HVAC [kW], mean over each slot."""
    sha256: str
    """Of the bytes of the file; of an embedded home, of the canonical file that it exports to."""
    source: str
    """One plain sentence, shown wherever results are shown."""
    notes: tuple[str, ...] = ()
    """What the reader repaired or found odd, one sentence each."""
    utc_offset: Float[np.ndarray, "slots"] | None = None
    """Wall clock minus UTC [h] in each slot, if it is not that of the zone of ``time``."""

    def __post_init__(self):
        """Refuse what is no regular series: fewer than two slots, lengths that differ, no time zone."""
        if self.time.tz is None or len(self.time) < 2 or self.exogenous.slots != len(self.time):
            raise HemmaError(
                f"{self.name}: expected at least two slots, a time zone, and one value a slot; got "
                f"{len(self.time)} time stamps (zone {self.time.tz}) and {self.exogenous.slots} values"
            )

    @property
    def slots(self) -> int:
        """Number of slots T."""
        return len(self.time)

    @property
    def slot_length(self) -> float:
        """dt [h]."""
        first, second = self.time[:2].tz_convert(None).to_numpy()
        return float((second - first) / np.timedelta64(1, "h"))

    def window(self, start: int, stop: int) -> "Traces":
        """The slots from ``start`` (included) to ``stop`` (excluded); name and notes stay."""

        def cut(series: np.ndarray | None) -> np.ndarray | None:
            return None if series is None else series[start:stop]

        return replace(
            self,
            time=self.time[start:stop],
            exogenous=self.exogenous.window(start, stop),
            indoor_temperature=cut(self.indoor_temperature),
            hvac_power=cut(self.hvac_power),
            utc_offset=cut(self.utc_offset),
        )

    def offsets(self) -> Float[np.ndarray, "slots"]:
        """Wall clock minus UTC [h] in each slot."""
        if self.utc_offset is not None:
            return self.utc_offset
        wall, utc = self.time.tz_localize(None), self.time.tz_convert("UTC").tz_localize(None)
        return np.asarray((wall - utc) / np.timedelta64(1, "h"), float)

    def wall_clock(self) -> "pandas.DatetimeIndex":
        """Local wall clock at the start of each slot, without a time zone."""
        import pandas as pd

        utc = self.time.tz_convert("UTC").tz_localize(None)
        return utc + pd.to_timedelta(np.round(self.offsets() * 3600), unit="s")

    def weekdays(self) -> Int[np.ndarray, "slots"]:
        """Day of the week of each slot by the local wall clock, Monday 0."""
        return np.asarray(self.wall_clock().day_of_week, int)

    def time_stamps(self) -> list[str]:
        """Start of each slot, ISO 8601 with the offset from UTC: ``2021-08-01T00:00:00-06:00``."""
        wall = self.wall_clock().strftime("%Y-%m-%dT%H:%M:%S")
        suffix = {offset: _iso_offset(offset) for offset in set(self.offsets().tolist())}
        return [f"{w}{suffix[o]}" for w, o in zip(wall, self.offsets().tolist(), strict=True)]


def hours_of_day(wall_clock: "pandas.DatetimeIndex") -> Float[np.ndarray, "slots"]:
    """Hour of the day with its fraction, in [0, 24), of local wall clock times."""
    seconds = np.asarray(wall_clock.hour * 3600 + wall_clock.minute * 60 + wall_clock.second, float)
    return seconds / 3600


def _iso_offset(hours: float) -> str:
    minutes = round(abs(hours) * 60)
    return f"{'-' if hours < 0 else '+'}{minutes // 60:02d}:{minutes % 60:02d}"


@dataclass(frozen=True)
class Split:
    """Two consecutive periods: what a method may learn from, and what it is measured on."""

    training: Traces
    test: Traces


def split(traces: Traces, test_from: str | None = None) -> Split:
    """Cut traces into a training and a test period.

    The test period begins with the first slot at or after ``test_from`` (``2021-08-01``, or a time stamp with
    or without an offset; without one it is local wall clock time). By default it is the last 31 days.
    """
    start = _first_test_slot(traces, test_from)
    if not 2 <= start <= traces.slots - 2:
        days = traces.slots * traces.slot_length / 24
        stamps = traces.time_stamps()
        wanted = f"the last {TEST_DAYS} days" if test_from is None else f"the time from {test_from} on"
        raise HemmaError(
            f"{traces.name}: expected at least two slots before the test period and two in it, but the "
            f"test period is {wanted} and the traces hold {days:.1f} days, {stamps[0]} to {stamps[-1]}. "
            "Give a longer file, or another start of the test period with --test-from"
        )
    return Split(traces.window(0, start), traces.window(start, traces.slots))


def _first_test_slot(traces: Traces, test_from: str | None) -> int:
    import pandas as pd

    wall = traces.wall_clock()
    if test_from is None:
        end = wall[-1] + pd.Timedelta(hours=traces.slot_length)
        return int(np.sum(wall < end - pd.Timedelta(days=TEST_DAYS)))
    try:
        moment = datetime.fromisoformat(test_from)
    except ValueError as error:
        raise HemmaError(
            f"--test-from: expected a day or a time such as 2021-08-01 or 2021-08-01T00:00:00-06:00, "
            f"got {test_from!r}. Correct it"
        ) from error
    return int(np.sum((wall if moment.tzinfo is None else traces.time) < pd.Timestamp(moment)))
