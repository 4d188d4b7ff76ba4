"""What every method did in a week: one small panel each, temperature above, battery below."""

from collections.abc import Iterator

import numpy as np
from matplotlib.axes import Axes
from matplotlib.dates import num2date
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from hemma.methods.looks import GREEN
from hemma.report.drawing.canvas import FAINT, midnights, new_figure
from hemma.report.drawing.over_time import PRICE_LOOK, step_values
from hemma.report.figures.figure import HomeFigure, ReportSection, Words
from hemma.report.methods import look_of
from hemma.report.numbers import plain
from hemma.report.subject import HomeSubject, Week
from hemma.results.results import HomeResults

COLUMNS = 3
_WIDTH, _ROW_HEIGHT = 9.2, 1.6
_HEAD, _FOOT, _LEFT, _RIGHT = 0.62, 0.62, 0.5, 0.12
"""Margins [inch] around the panels. They are the same for all, so the layout need not be searched for."""
_GAP = 0.3
"""Between the rows [inch], room for a title."""
_PRICE_SHARE = 0.75
"""The highest price reaches to this part of the battery's panel."""


def traces_figure(home: HomeResults, week: Week) -> Figure:
    """Small multiples of all methods that have a schedule, in the order of the table, on the same scales."""
    count, schedules = len(week.schedules), week.schedules.values()
    figure = new_figure(_WIDTH, _HEAD + _ROW_HEIGHT * -(-count // COLUMNS) + _FOOT - _GAP)
    figure.set_layout_engine("none")
    temperatures = np.concatenate([home.comfort_c, *(one.indoor_temperature for one in schedules)])
    low, high = temperatures.min(), temperatures.max()
    margin = 0.08 * (high - low)
    most = max([1e-3, *(np.max(one.battery_energy) for one in schedules)])
    for (above, below), (method, schedule) in zip(_cells(figure, count), week.schedules.items(), strict=True):
        above.set_title(method, fontsize=8.5, pad=2.5)
        above.axhspan(*home.comfort_c, color=GREEN, alpha=0.12, linewidth=0, zorder=0)
        above.set_ylim(low - margin, high + margin)
        _draw_price(below, week)
        below.set_ylim(0.0, 1.1 * most)
        for axes, values in ((above, schedule.indoor_temperature), (below, schedule.battery_energy)):
            axes.plot(week.posts[1:], values, color=look_of(method).colour, linewidth=1.0)
            axes.set_xlim(week.posts[0], week.posts[-1])
            axes.set_xticks(midnights(week.posts[0], week.posts[-1]))
            axes.xaxis.set_major_formatter(lambda days, _: str(num2date(days).day))
    _explain(figure, home, week)
    return figure


def _cells(figure: Figure, count: int) -> Iterator[tuple[Axes, Axes]]:
    """The two panels of each method, with labels at the left and at the lower edge only."""
    width, height = figure.get_size_inches()
    outer = figure.add_gridspec(
        -(-count // COLUMNS),
        COLUMNS,
        left=_LEFT / width,
        right=1 - _RIGHT / width,
        top=1 - _HEAD / height,
        bottom=_FOOT / height,
        wspace=0.06,
        hspace=_GAP / (_ROW_HEIGHT - _GAP),
    )
    for place in range(count):
        inner = outer[divmod(place, COLUMNS)].subgridspec(2, 1, height_ratios=(1.2, 1.0), hspace=0.1)
        above, below = (figure.add_subplot(inner[row]) for row in (0, 1))
        for axes, unit in ((above, "°C"), (below, "kWh")):
            axes.yaxis.set_major_locator(MaxNLocator(3, integer=True))
            axes.tick_params(labelsize=7.0, length=2.0, labelleft=place % COLUMNS == 0)
            axes.set_ylabel(unit if place % COLUMNS == 0 else "", fontsize=7.5)
        above.tick_params(labelbottom=False, bottom=False)
        below.tick_params(labelbottom=place + COLUMNS >= count)
        yield above, below


def _draw_price(axes: Axes, week: Week) -> None:
    lowest, highest = week.price_range
    price = _PRICE_SHARE * (step_values(week.exogenous.buying_price) - lowest) / (highest - lowest)
    axes.fill_between(week.posts, price, step="post", transform=axes.get_xaxis_transform(), **PRICE_LOOK)


def _explain(figure: Figure, home: HomeResults, week: Week) -> None:
    lowest, highest = week.price_range
    price = f"buying price, {lowest:.2g} to {highest:.2g} {home.currency}/kWh"
    patches = [
        Patch(color=GREEN, alpha=0.2, linewidth=0, label="comfort band"),
        Patch(label=price, **PRICE_LOOK),
    ]
    figure.legend(handles=patches, loc="upper left", ncols=2)
    start = num2date(float((week.posts[0] - np.datetime64(0, "D")) / np.timedelta64(1, "D")))
    figure.supxlabel(
        f"Day of the month, local time ({week.exogenous.clock.offset}), from {start.day} {start:%B %Y}",
        y=0.1 / figure.get_size_inches()[1],
        fontsize=8.0,
        color=FAINT,
    )


def _words(subject: HomeSubject) -> Words:
    (low, high), week = subject.home.comfort_c, subject.week
    ranges = "; ".join(
        f"{name} {_range(schedule.indoor_temperature)} °C, battery {_range(schedule.battery_energy)} kWh"
        for name, schedule in week.schedules.items()
    )
    return Words(
        f"What every method does in week {week.number} of the test period",
        f"Ranges of indoor temperature and battery energy of each method in the week: {ranges}.",
        f"Of each method, above: indoor temperature, with the comfort band from {plain(low)} to "
        f"{plain(high)} °C; below: battery energy, with the buying price in grey. All panels share their "
        "scales; of several seeds the one of median cost is shown.",
    )


def _range(values: np.ndarray) -> str:
    return f"{plain(round(float(values.min()), 1))} to {plain(round(float(values.max()), 1))}"


TRACES_WEEK = HomeFigure[HomeSubject](
    name="traces-week",
    section=ReportSection("A week of every method"),
    needs=lambda subject: subject if subject.week.schedules else None,
    draw=lambda subject: traces_figure(subject.home, subject.week),
    words=_words,
    missing="No schedule in this folder.",
)
