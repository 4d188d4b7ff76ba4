"""Traces: what a home saw, slot by slot, and its split into a training and a test period."""

from dataclasses import dataclass, replace
from datetime import UTC, datetime

import numpy as np
from jaxtyping import Float, Int

from hemma.data.clock import DAY, Clock
from hemma.errors import HemmaError
from hemma.types import Exogenous

TEST_DAYS = 31
"""Length of the test period unless a start is given; the paper's month of August."""


@dataclass(frozen=True)
class Traces:
    """Regular time series of one home, without holes, one value a slot. Slot t covers [t, t+1)."""

    name: str
    """``austin2021-1``, or the stem of the file."""
    clock: Clock
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

    def __post_init__(self):
        """Refuse what is no regular series: fewer than two slots, lengths that differ."""
        if self.slots < 2 or self.exogenous.slots != self.slots:
            raise HemmaError(
                f"{self.name}: expected at least two slots and one value a slot; got {self.slots} time "
                f"stamps and {self.exogenous.slots} values"
            )

    @property
    def slots(self) -> int:
        """Number of slots T."""
        return self.clock.slots

    @property
    def slot_length(self) -> float:
        """dt [h]."""
        return self.clock.slot_length

    def window(self, start: int, stop: int) -> "Traces":
        """The slots from ``start`` (included) to ``stop`` (excluded); name and notes stay."""

        def cut(series: np.ndarray | None) -> np.ndarray | None:
            return None if series is None else series[start:stop]

        return replace(
            self,
            clock=self.clock.window(start, stop),
            exogenous=self.exogenous.window(start, stop),
            indoor_temperature=cut(self.indoor_temperature),
            hvac_power=cut(self.hvac_power),
        )

    def weekdays(self) -> Int[np.ndarray, "slots"]:
        """Day of the week of each slot by the local wall clock, Monday 0."""
        return self.clock.weekdays()

    def time_stamps(self) -> list[str]:
        """Start of each slot, ISO 8601 with the offset from UTC: ``2021-08-01T00:00:00-06:00``."""
        return self.clock.stamps()


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
    clock = traces.clock
    if test_from is None:
        return int(np.sum(clock.wall < clock.wall[-1] + clock.step - TEST_DAYS * DAY))
    try:
        moment = datetime.fromisoformat(test_from)
    except ValueError as error:
        raise HemmaError(
            f"--test-from: expected a day or a time such as 2021-08-01 or 2021-08-01T00:00:00-06:00, "
            f"got {test_from!r}. Correct it"
        ) from error
    if moment.tzinfo is None:
        return int(np.sum(clock.wall < moment.replace(tzinfo=UTC).timestamp()))
    return int(np.sum(clock.seconds < moment.timestamp()))
