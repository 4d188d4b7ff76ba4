"""Panel (d): the mean temperature deviation of the methods side by side."""

from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, NullLocator

from hemma.report.drawing.canvas import GRID, INK, PANEL_WIDTH, legend_above, single
from hemma.report.drawing.rows import (
    FROM_ZERO,
    above_zero,
    draw_interval,
    draw_seeds,
    explain_marks,
    label_rows,
    method_rows,
    rows_height,
    write_value,
)
from hemma.report.figures.figure import PANELS, HomeFigure, Words
from hemma.report.methods import in_order, look_of
from hemma.report.numbers import degrees, fine, plain
from hemma.results.results import HomeResults

LINEAR_BELOW = 0.001
"""Mean deviation [degC] below which the axis is linear, so that zero has a place."""


def draw_deviations(axes: Axes, home: HomeResults) -> None:
    """Mean temperature deviation of each method, on an axis that has room for 0 and for 1 degC."""
    axes.set_title("(d) Mean temperature deviation")
    axes.set_xscale("symlog", linthresh=LINEAR_BELOW)
    rows = method_rows(home.methods)
    largest = LINEAR_BELOW
    for name, place in rows.places.items():
        method, look = home.methods[name], look_of(name)
        mean = method.mean.mean_temperature_deviation
        interval = above_zero(method.interval.mean_temperature_deviation)
        values = draw_seeds(axes, place, [run.mean_temperature_deviation for run in method.runs], look.colour)
        reach = max([0.0, *values, *(interval or ()), mean or 0.0])
        largest = max(largest, reach)
        write_value(axes, place, reach, fine(mean))
        draw_interval(axes, place, interval, look.colour)
        if mean is not None:
            axes.hlines(place, 0.0, mean, color=GRID, linewidth=3.5, zorder=1)
            axes.plot(mean, place, marker="o", color=look.colour, markersize=5.5, clip_on=False, zorder=4)
    label_rows(axes, rows)
    axes.tick_params(axis="y", pad=7)
    axes.set_xlim(0.0, largest * 6.0)
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: plain(value)))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xlabel(f"Mean deviation (°C, linear below {plain(LINEAR_BELOW)})")
    axes.plot([], [], "o", color=INK, markersize=5.5, label="mean")
    explain_marks(axes, home)
    legend_above(axes, columns=3)


def _words(home: HomeResults) -> Words:
    named = [(name, home.methods[name].mean.mean_temperature_deviation) for name in in_order(home.methods)]
    deviations = "; ".join(f"{name} {degrees(deviation)}" for name, deviation in named)
    return Words(
        "(d) Mean temperature deviation of each method",
        f"Points of the mean temperature deviation: {deviations}.",
        "Mean over all slots of the distance from the comfort band; 0 is always comfortable. The axis is "
        f"linear below 0.001 °C, logarithmic above. {FROM_ZERO}",
    )


TEMPERATURE_DEVIATION = HomeFigure[HomeResults](
    name="temperature-deviation",
    section=PANELS,
    needs=lambda subject: subject.home,
    draw=lambda home: single(
        PANEL_WIDTH, rows_height(home.methods), lambda axes: draw_deviations(axes, home)
    ),
    words=_words,
    is_wide=False,
)
