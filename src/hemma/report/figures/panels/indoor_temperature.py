"""Panel (e): what a few controllers made of the indoor temperature."""

import numpy as np
from matplotlib.axes import Axes

from hemma.methods.looks import GREEN
from hemma.report.drawing.canvas import FULL_WIDTH, single
from hemma.report.drawing.over_time import draw_line, finish_week
from hemma.report.figures.figure import PANELS, HomeFigure, Words, listed
from hemma.report.numbers import plain
from hemma.report.subject import HomeSubject
from hemma.report.week import Week
from hemma.results.results import HomeResults


def draw_indoor_temperature(axes: Axes, home: HomeResults, week: Week) -> None:
    """Indoor temperature at the end of each slot, the comfort band and the price."""
    axes.set_title("(e) Indoor temperature")
    low, high = home.comfort_c
    axes.axhspan(low, high, color=GREEN, alpha=0.10, linewidth=0, label="comfort band", zorder=0)
    schedules = week.selected
    for method, schedule in schedules.items():
        draw_line(axes, method, week.posts[1:], schedule.indoor_temperature)
    axes.set_ylabel("Indoor temperature (°C)")
    values = [schedule.indoor_temperature for schedule in schedules.values()]
    bottom, top = min([low, *map(np.min, values)]), max([high, *map(np.max, values)])
    axes.set_ylim(bottom - 0.08 * (top - bottom), top + 0.08 * (top - bottom))
    finish_week(axes, home, week)


def _words(subject: HomeSubject) -> Words:
    (low, high), week = subject.home.comfort_c, subject.week
    return Words(
        "(e) Indoor temperature",
        f"Indoor temperature of {listed(week.selected)} over {plain(round(week.days, 1))} days, with the "
        f"comfort band from {plain(low)} to {plain(high)} °C and the buying price.",
        f"Week {week.number} of the test period; of several seeds the one of median cost. "
        "Staying near the edge of the band needs the least energy.",
    )


INDOOR_TEMPERATURE = HomeFigure[HomeSubject](
    name="indoor-temperature",
    section=PANELS,
    needs=lambda subject: subject,
    draw=lambda it: single(FULL_WIDTH, 2.9, lambda axes: draw_indoor_temperature(axes, it.home, it.week)),
    words=_words,
)
