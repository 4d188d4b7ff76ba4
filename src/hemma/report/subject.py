"""A home of a results folder with all series that are drawn, those over time for one week."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Shaped

from hemma.errors import HemmaError
from hemma.report.methods import in_order, shown_over_time
from hemma.report.numbers import plain
from hemma.report.series import ExogenousSeries, FreeRun, ScheduleSeries, SeriesReader, TrainingCurve
from hemma.results.results import HomeResults

WEEK_DAYS = 7
_REST = 1e-6
"""A battery whose energy moves less than this [kWh] in a week rests."""
Curves = dict[str, list[TrainingCurve]]
"""The training curves of a home by method; methods without any are left out."""


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


@dataclass(frozen=True)
class HomeSubject:
    """What the figures of a home are drawn from."""

    home: HomeResults
    week: Week
    curves: Curves
    free_run: FreeRun | None


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
    return Week(
        number=number,
        exogenous=exogenous,
        schedules={
            method: reader.schedule(path, home.test.slots, part)
            for method in in_order(home.methods)
            if (path := home.methods[method].typical_run.schedule) is not None
        },
        posts=exogenous.clock.fence_posts(slots, first),
    )


def read_subject(reader: SeriesReader, name: str, home: HomeResults, week: int = 1) -> HomeSubject:
    """Read all series of a home; every file that ``results.json`` names must exist, drawn or not."""
    methods = [*home.methods.values(), *home.data_efficiency]
    for run in (run for method in methods for run in method.runs):
        for path in filter(None, (run.schedule, run.curve)):
            reader.located(path)
    runs = {method: home.methods[method].runs for method in in_order(home.methods)}
    paths = {method: [run.curve for run in ran if run.curve] for method, ran in runs.items()}
    free_run = home.identification.free_run if home.identification else None
    return HomeSubject(
        home=home,
        week=read_week(reader, name, home, week),
        curves={method: [reader.curve(path) for path in found] for method, found in paths.items() if found},
        free_run=reader.free_run(free_run) if free_run else None,
    )


def _slots_a_week(home: HomeResults) -> int:
    return round(WEEK_DAYS * 24 / home.slot_length_h)
