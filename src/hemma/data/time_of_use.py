"""A tariff with a dearer time of the day, for homes whose data come without prices."""

import math
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from hemma.data.clock import Clock
from hemma.data.tariff import require_ratio
from hemma.errors import HemmaError


@dataclass(frozen=True)
class TimeOfUse:
    """u+ is ``peak_per_kwh`` between two wall clock hours and ``off_peak_per_kwh`` otherwise."""

    off_peak_per_kwh: float
    """[currency/kWh]."""
    peak_per_kwh: float
    """[currency/kWh]."""
    peak_from: float = 15.0
    """Wall clock hour at which the peak begins, in [0, 24]."""
    peak_until: float = 20.0
    """Wall clock hour at which it ends; before ``peak_from`` if it lasts over midnight."""
    weekdays_only: bool = False
    """Whether Saturday and Sunday have no peak."""
    selling_ratio: float = 0.9
    """u- / u+."""

    def __post_init__(self):
        """Refuse prices that are no numbers and hours that no day has."""
        require_ratio("time of use: selling_ratio", self.selling_ratio)
        if not (math.isfinite(self.off_peak_per_kwh) and math.isfinite(self.peak_per_kwh)):
            raise HemmaError(
                f"time of use: expected two prices in currency/kWh, got {self.off_peak_per_kwh} "
                f"and {self.peak_per_kwh}. Correct them"
            )
        if not (0 <= self.peak_from <= 24 and 0 <= self.peak_until <= 24):
            raise HemmaError(
                f"time of use: expected hours between 0 and 24, got {self.peak_from} to {self.peak_until}. "
                "Correct them"
            )

    def buying_price(self, clock: Clock) -> Float[np.ndarray, "slots"]:
        """u+ [currency/kWh], the mean over slots that the peak begins or ends in."""
        share = self._peak_share(clock)
        return self.off_peak_per_kwh + share * (self.peak_per_kwh - self.off_peak_per_kwh)

    def selling_price(self, clock: Clock) -> Float[np.ndarray, "slots"]:
        """u- [currency/kWh]."""
        return self.selling_ratio * self.buying_price(clock)

    def _peak_share(self, clock: Clock) -> Float[np.ndarray, "slots"]:
        """Fraction of each slot that lies in the peak; slots are shorter than a day."""
        begin = clock.hour_of_day()
        end = begin + clock.slot_length
        hours = np.zeros(clock.slots)
        for start, stop in self._peaks():
            hours += np.clip(np.minimum(end, stop) - np.maximum(begin, start), 0.0, None)
        return hours / clock.slot_length * (clock.weekdays() < 5 if self.weekdays_only else 1.0)

    def _peaks(self) -> list[tuple[float, float]]:
        """The peaks of two days as intervals of hours, so that a slot may reach into the second."""
        if self.peak_from <= self.peak_until:
            today = [(self.peak_from, self.peak_until)]
        else:
            today = [(0.0, self.peak_until), (self.peak_from, 24.0)]
        return [*today, *((start + 24, stop + 24) for start, stop in today)]
