"""Forecasts made of others: their mean, and one that is fitted again as time goes on."""

from dataclasses import dataclass, replace

import jax
import numpy as np

from hemma.forecasting.outlook import Forecaster, Outlook
from hemma.home.checks import require
from hemma.types import Exogenous


@dataclass(frozen=True)
class MeanForecast:
    """The mean of several forecasts: their errors cancel in part (Bates and Granger 1969)."""

    parts: tuple[Forecaster, ...]

    def __call__(self, outlook: Outlook) -> Exogenous:
        """Slot by slot and step by step; the clock, which all of them know, is that of the first."""
        forecasts = [part(outlook) for part in self.parts]
        mean = jax.tree.map(lambda *values: np.mean(values, axis=0), *forecasts)
        return outlook.with_present(mean)


@dataclass(frozen=True)
class RefittedForecast:
    """A forecast that is fitted again every so many days, to all that has happened until then."""

    forecaster: Forecaster
    days: int = 7
    """Days between two fits."""

    def __post_init__(self):
        """Refuse a number of days without meaning."""
        require("forecast", self.days >= 1, "days >= 1", self.days)

    def __call__(self, outlook: Outlook) -> Exogenous:
        """Row t comes from the last fit before slot t."""
        joined, first = outlook.joined(), outlook.past.slots
        starts = range(first, first + outlook.period.slots, self.days * outlook.day)
        parts = []
        for start in starts:
            stop = min(start + self.days * outlook.day, first + outlook.period.slots)
            window = replace(outlook, past=joined.window(0, start), period=joined.window(start, stop))
            parts.append(self.forecaster(window))
        return jax.tree.map(lambda *rows: np.concatenate(rows), *parts)
