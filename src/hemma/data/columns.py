"""Series of one file on one clock, named as the columns of the canonical trace file."""

from collections.abc import Mapping
from dataclasses import dataclass

from hemma.data.clock import Clock, Series

REQUIRED = ("pv_kw", "load_kw", "outdoor_c", "buy_per_kwh")
OPTIONAL = ("sell_per_kwh", "indoor_c", "hvac_kw")


@dataclass(frozen=True)
class Columns:
    """Series with a value a slot, and what was done to them."""

    clock: Clock
    series: Mapping[str, Series]
    """By column, NaN where a value is missing."""
    notes: tuple[str, ...] = ()
    """What was repaired, one sentence each."""

    def window(self, start: int, stop: int) -> "Columns":
        """The slots from ``start`` (included) to ``stop`` (excluded)."""
        series = {name: column[start:stop] for name, column in self.series.items()}
        return Columns(self.clock.window(start, stop), series, self.notes)
