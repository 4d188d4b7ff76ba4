"""One week of the test period: the exogenous series and what every method did in it."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Shaped

from hemma.errors import HemmaError
from hemma.report.methods import in_order, shown_over_time
from hemma.report.numbers import plain
from hemma.report.series import ExogenousSeries, ScheduleSeries, SeriesReader
from hemma.results.results import HomeResults

WEEK_DAYS = 7
_REST = 1e-6
"""A battery whose energy moves less than this [kWh] in a week rests."""


@dataclass(frozen=True)
class Week:
    """A week of a home's test period."""

    number: int
    """From 1."""
    exogenous: ExogenousSeries
    """Of this week."""
    schedules: dict[str, ScheduleSeries]
    """By method in their order, of the run of median cost of each, this week."""
    posts: Shaped[np.ndarray, "posts"]
    """Local time at the start of every slot and at the end of the last."""

    @property
    def days(self) -> float:
        """Its length [days]: less than seven at the end of a period."""
        return float((self.posts[-1] - self.posts[0]) / np.timedelta64(1, "D"))

    @property
    def selected(self) -> dict[str, ScheduleSeries]:
        """Of a few methods, whose lines can be told apart in one panel."""
        return {name: self.schedules[name] for name in shown_over_time(self.schedules)}

    @property
    def price_range(self) -> tuple[float, float]:
        """From zero or the lowest price below it to the highest buying price [currency/kWh]."""
        price = self.exogenous.buying_price
        return min(0.0, float(np.min(price))), max(float(np.max(price)), 1e-9)


def battery_rests(schedule: ScheduleSeries) -> bool:
    """Whether the battery does nothing."""
    return float(np.ptp(schedule.battery_energy)) <= _REST


def require_week(name: str, home: HomeResults, week: int) -> None:
    """Raise ``HemmaError`` unless the home's test period has a week of that number."""
    weeks = -(-home.test.slots // _slots_a_week(home))
    if not 1 <= week <= weeks:
        raise HemmaError(
            f"Week {week} of the report: expected 1 to {weeks}, since the test period of {name} has "
            f"{plain(round(home.test_days, 1))} days from {home.test.start}; choose one of these weeks"
        )


def read_week(reader: SeriesReader, name: str, home: HomeResults, number: int = 1) -> Week:
    """Read the week of that number, counted from 1; the last one of a period may be shorter."""
    require_week(name, home, number)
    first = (number - 1) * _slots_a_week(home)
    slots = min(home.test.slots - first, _slots_a_week(home))
    part = slice(first, first + slots)
    exogenous = reader.exogenous(name, home.test.slots, part)
    runs = {method: home.methods[method].typical_run for method in in_order(home.methods)}
    return Week(
        number=number,
        exogenous=exogenous,
        schedules={
            method: reader.schedule(run.schedule, home.test.slots, part)
            for method, run in runs.items()
            if run.schedule is not None
        },
        posts=exogenous.clock.fence_posts(slots, first),
    )


def _slots_a_week(home: HomeResults) -> int:
    return round(WEEK_DAYS * 24 / home.slot_length_h)
