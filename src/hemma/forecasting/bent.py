"""A series as forecasts see it: bent, so that spikes do not rule, and counted from its usual day."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from hemma.forecasting.outlook import Outlook, last_known, profile
from hemma.home.selling import fit_selling
from hemma.types import Array, Exogenous


@dataclass(frozen=True)
class _Bend:
    """y -> asinh((y - centre) / width): a line around the middle, a logarithm in the tails."""

    centre: float
    width: float

    def bent(self, values: np.ndarray) -> np.ndarray:
        return np.arcsinh((values - self.centre) / self.width)

    def unbent(self, values: np.ndarray) -> np.ndarray:
        return self.centre + self.width * np.sinh(values)


@dataclass(frozen=True)
class BentSeries:
    """z: a quantity bent to asinh((y - median) / width), less its mean over the past at the time of day."""

    values: Float[np.ndarray, "joined"]
    """y, past and period."""
    past: int
    """Slots of the past."""
    bend: _Bend
    level: Float[np.ndarray, "day"]
    """Mean of the bent past at each time of day."""
    times: Int[np.ndarray, "places"]
    """Slot of the day of every place, a horizon beyond the end included."""

    @property
    def z(self) -> Float[np.ndarray, "joined"]:
        """Distance of the bent series from its usual day."""
        return self.bend.bent(self.values) - self.level[self.times[: len(self.values)]]

    def forecast(
        self, ahead: Float[np.ndarray, "slots horizon"], targets: Int[np.ndarray, "slots horizon"]
    ) -> Float[np.ndarray, "slots horizon"]:
        """y from z forecast for ``targets``; no forecast leaves the range seen so far."""
        y = self.bend.unbent(ahead + self.level[self.times[targets]])
        lowest, highest = np.minimum.accumulate(self.values), np.maximum.accumulate(self.values)
        return np.clip(y, lowest[self.past :, None], highest[self.past :, None])


def bent_series(outlook: Outlook, values: Array) -> BentSeries:
    """The series of one quantity of ``outlook.joined()``; bend and level are those of the past alone."""
    values, times, past = np.asarray(values), outlook.times(), outlook.past.slots
    bend = _bend(values[:past])
    level = profile(bend.bent(values[:past]), times[:past], outlook.day)
    return BentSeries(values, past, bend, level, times)


Regression = Callable[[BentSeries], Float[np.ndarray, "slots horizon"]]
"""What is expected of z in each slot of the period, for each slot of its horizon."""


def assembled(outlook: Outlook, regression: Regression) -> Exogenous:
    """The forecast of every quantity by ``regression``, and what is known for certain.

    PV stays below what its time of day has seen, so nights are dark. The selling price lies on the training
    period's line over the buying price; where it is none, it is forecast as the buying price is, and exceeds
    it by no more than it has so far.
    """
    joined, asked = outlook.joined(), outlook.targets()

    def expected(values: Array) -> Float[np.ndarray, "slots horizon"]:
        series = bent_series(outlook, values)
        return series.forecast(regression(series), asked)

    line, buying_price = fit_selling(outlook.past), expected(joined.buying_price)
    if line is None:
        dearest = np.maximum.accumulate(joined.selling_price - joined.buying_price)[outlook.past.slots :]
        selling_price = np.minimum(expected(joined.selling_price), buying_price + dearest[:, None])
    else:
        selling_price = np.asarray(line(buying_price))
    return outlook.with_present(
        Exogenous(
            pv_generation=np.minimum(
                expected(joined.pv_generation), _brightest(outlook, joined.pv_generation)
            ),
            load=expected(joined.load),
            outdoor_temperature=expected(joined.outdoor_temperature),
            buying_price=buying_price,
            selling_price=selling_price,
            hour_of_day=outlook.clock()[asked],
        )
    )


def _bend(values: Float[np.ndarray, "past"]) -> _Bend:
    """Median and half the range from 10 to 90 %; where that is none, the largest distance from the median."""
    low, centre, high = np.quantile(values, (0.1, 0.5, 0.9))
    furthest = float(np.max(np.abs(values - centre)))
    width = float(high - low) / 2
    return _Bend(float(centre), width if width > 1e-6 * furthest else furthest or 1.0)


def _brightest(outlook: Outlook, sun: Float[Array, "joined"]) -> Float[np.ndarray, "slots horizon"]:
    """Largest PV generation that the past or the last known day saw at the time of day of each target."""
    sun, times, asked = np.asarray(sun), outlook.times(), outlook.targets()
    most = np.zeros(outlook.day)
    np.maximum.at(most, times[: outlook.past.slots], sun[: outlook.past.slots])
    return np.maximum(most[times[asked]], sun[last_known(asked, outlook.day)])
