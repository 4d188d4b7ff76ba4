"""Panels (c) and (d): the methods side by side."""

from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, MaxNLocator, NullLocator

from hemma.report.canvas import FAINT, GRID, INK, legend_above
from hemma.report.methods import in_order, look_of
from hemma.report.numbers import DASH, decimals, fine, plain
from hemma.report.results import HomeResults, Method

LINEAR_BELOW = 0.001
"""Mean deviation [degC] below which the axis is linear, so that zero has a place."""


def draw_costs(axes: Axes, home: HomeResults) -> None:
    """Panel (c): energy cost of each method, the 95 % interval, every seed, and the optimum."""
    axes.set_title("(c) Energy cost")
    names = _name_rows(axes, home)
    for row, name in enumerate(names):
        method, look = home.methods[name], look_of(name)
        mean = method.mean.energy_cost
        if mean is not None:
            axes.barh(row, mean, height=0.66, color=look.colour, alpha=0.75, linewidth=0)
        _draw_interval(axes, row, method.interval.energy_cost, INK)
        values = _draw_seeds(axes, row, [run.energy_cost for run in method.runs], INK)
        reach = max([0.0, *values, *(method.interval.energy_cost or ()), mean or 0.0])
        _write_value(axes, row, reach, DASH if mean is None else decimals(mean, 2))
    optimum = home.optimum.energy_cost if home.optimum else None
    if optimum is not None:
        axes.axvline(optimum, color=INK, linewidth=1.2, linestyle=look_of("optimum").line, label="optimum")
    _explain_marks(axes, home)
    axes.set_xlabel(f"Energy cost of the test period ({home.currency})")
    axes.xaxis.set_major_locator(MaxNLocator(5))
    axes.margins(x=0.18)
    legend_above(axes, columns=3)


def draw_deviations(axes: Axes, home: HomeResults) -> None:
    """Panel (d): mean temperature deviation of each method, on an axis that has room for 0 and for 1 degC."""
    axes.set_title("(d) Mean temperature deviation")
    axes.set_xscale("symlog", linthresh=LINEAR_BELOW)
    names = _name_rows(axes, home)
    axes.tick_params(axis="y", pad=7)
    largest = LINEAR_BELOW
    for row, name in enumerate(names):
        method, look = home.methods[name], look_of(name)
        mean = method.mean.mean_temperature_deviation
        values = _draw_seeds(axes, row, [run.mean_temperature_deviation for run in method.runs], look.colour)
        reach = max([0.0, *values, *(method.interval.mean_temperature_deviation or ()), mean or 0.0])
        largest = max(largest, reach)
        _write_value(axes, row, reach, fine(mean))
        _draw_interval(axes, row, method.interval.mean_temperature_deviation, look.colour)
        if mean is not None:
            axes.hlines(row, 0.0, mean, color=GRID, linewidth=3.5, zorder=1)
            axes.plot(mean, row, marker="o", color=look.colour, markersize=6, clip_on=False, zorder=4)
    axes.set_xlim(0.0, largest * 6.0)
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: plain(value)))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xlabel(f"Mean deviation (°C, linear below {plain(LINEAR_BELOW)})")
    axes.plot([], [], "o", color=INK, markersize=6, label="mean")
    _explain_marks(axes, home)
    legend_above(axes, columns=3)


def _name_rows(axes: Axes, home: HomeResults) -> list[str]:
    names = in_order(home.methods)
    axes.set_yticks(range(len(names)), names)
    axes.set_ylim(len(names) - 0.4, -0.6)
    axes.tick_params(axis="y", length=0)
    axes.grid(axis="y", visible=False)
    return names


def _write_value(axes: Axes, row: int, reach: float, text: str) -> None:
    """Write the mean to the right of everything that is drawn in its row."""
    axes.annotate(
        text,
        (reach, row),
        xytext=(7, 0),
        textcoords="offset points",
        va="center",
        fontsize=8.5,
        color=INK,
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.8},
    )


def _draw_interval(axes: Axes, row: int, interval: tuple[float, float] | None, colour: str) -> None:
    if interval is not None:
        axes.hlines(row, *interval, color=colour, linewidth=1.8, zorder=3)
        axes.plot(interval, [row, row], "|", color=colour, markersize=6, markeredgewidth=1.4, zorder=3)


def _draw_seeds(axes: Axes, row: int, values: list[float | None], colour: str) -> list[float]:
    """Faint points, a little below the mean; the values that exist."""
    drawn = [value for value in values if value is not None]
    if len(drawn) > 1:
        axes.plot(drawn, [row + 0.24] * len(drawn), "o", color=colour, alpha=0.45, markersize=3.2, mew=0)
    return drawn


def _explain_marks(axes: Axes, home: HomeResults) -> None:
    if any(_has_seeds(method) for method in home.methods.values()):
        axes.plot([], [], "|-", color=INK, markersize=6, label="95 % interval")
        axes.plot([], [], "o", color=FAINT, alpha=0.6, markersize=3.2, mew=0, label="one seed")


def _has_seeds(method: Method) -> bool:
    return len(method.runs) > 1
