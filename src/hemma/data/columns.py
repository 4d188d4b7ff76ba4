"""Series of one file on one clock, named as the columns of the canonical trace file."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from hemma.data.clock import Clock

REQUIRED = ("pv_kw", "load_kw", "outdoor_c", "buy_per_kwh")
OPTIONAL = ("sell_per_kwh", "indoor_c", "hvac_kw")

Series = Float[np.ndarray, "slots"]


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
