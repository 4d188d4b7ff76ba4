"""Panels (c) and (d): the methods side by side."""

from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, MaxNLocator, NullLocator

from hemma.report.drawing.canvas import GRID, INK, legend_above
from hemma.report.drawing.rows import (
    above_zero,
    draw_interval,
    draw_seeds,
    explain_marks,
    label_rows,
    method_rows,
    write_value,
)
from hemma.report.methods import look_of
from hemma.report.numbers import DASH, decimals, fine, plain
from hemma.results.results import HomeResults

LINEAR_BELOW = 0.001
"""Mean deviation [degC] below which the axis is linear, so that zero has a place."""


def draw_costs(axes: Axes, home: HomeResults) -> None:
    """Panel (c): energy cost of each method, the 95 % interval, every seed, and the optimum."""
    axes.set_title("(c) Energy cost")
    rows = method_rows(home.methods)
    for name, place in rows.places.items():
        method, look = home.methods[name], look_of(name)
        mean, interval = method.mean.energy_cost, method.interval.energy_cost
        if mean is not None:
            axes.barh(place, mean, height=0.66, color=look.colour, alpha=0.75, linewidth=0)
        draw_interval(axes, place, interval, INK)
        values = draw_seeds(axes, place, [run.energy_cost for run in method.runs], INK)
        reach = max([0.0, *values, *(interval or ()), mean or 0.0])
        write_value(axes, place, reach, DASH if mean is None else decimals(mean, 2))
    label_rows(axes, rows)
    optimum = home.optimum.energy_cost if home.optimum else None
    if optimum is not None:
        axes.axvline(optimum, color=INK, linewidth=1.2, linestyle=look_of("optimum").line, label="optimum")
    _explain(axes, home)
    axes.set_xlabel(f"Energy cost of the test period ({home.currency})")
    axes.xaxis.set_major_locator(MaxNLocator(5))
    axes.margins(x=0.18)
    legend_above(axes, columns=3)


def draw_deviations(axes: Axes, home: HomeResults) -> None:
    """Panel (d): mean temperature deviation of each method, on an axis that has room for 0 and for 1 degC."""
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
    _explain(axes, home)
    legend_above(axes, columns=3)


def _explain(axes: Axes, home: HomeResults) -> None:
    if any(len(method.runs) > 1 for method in home.methods.values()):
        explain_marks(axes)
