"""Panels (c) and (d): energy cost and comfort of the methods side by side."""

from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from hemma.report.drawing.canvas import (
    GRID,
    INK,
    LINEAR_BELOW,
    label_deviation,
    legend_above,
)
from hemma.report.drawing.rows import (
    FROM_ZERO,
    Quantity,
    draw_runs,
    explain_marks,
    label_rows,
    method_rows,
    rows_height,
    write_value,
)
from hemma.report.figures.figure import Words, half_panel
from hemma.report.methods import in_order, look_of
from hemma.report.numbers import decimals, degrees, fine, money
from hemma.results.results import HomeResults

_COST = Quantity(lambda it: it.energy_cost)
_DEVIATION = Quantity(lambda it: it.mean_temperature_deviation, is_never_negative=True)


def draw_costs(axes: Axes, home: HomeResults) -> None:
    """Energy cost of each method, the 95 % interval, every seed, and the optimum."""
    axes.set_title("(c) Energy cost")
    rows = method_rows(home.methods)
    for name, place in rows.places.items():
        method, colour = home.methods[name], look_of(name).colour
        mean = method.mean.energy_cost
        if mean is not None:
            axes.barh(place, mean, height=0.66, color=colour, alpha=0.75, linewidth=0)
        write_value(axes, place, draw_runs(axes, place, method, _COST, INK), decimals(mean, 2))
    label_rows(axes, rows)
    optimum = home.optimum.energy_cost if home.optimum else None
    if optimum is not None:
        axes.axvline(optimum, color=INK, linewidth=1.2, linestyle=look_of("optimum").line, label="optimum")
    explain_marks(axes, home)
    axes.set_xlabel(f"Energy cost of the test period ({home.currency})")
    axes.xaxis.set_major_locator(MaxNLocator(5))
    axes.margins(x=0.18)
    legend_above(axes, columns=3)


def draw_deviations(axes: Axes, home: HomeResults) -> None:
    """Mean temperature deviation of each method, on an axis that has room for 0 and for 1 degC."""
    axes.set_title("(d) Mean temperature deviation")
    axes.set_xscale("symlog", linthresh=LINEAR_BELOW)
    rows = method_rows(home.methods)
    largest = LINEAR_BELOW
    for name, place in rows.places.items():
        method, colour = home.methods[name], look_of(name).colour
        mean = method.mean.mean_temperature_deviation
        reach = draw_runs(axes, place, method, _DEVIATION, colour)
        largest = max(largest, reach)
        write_value(axes, place, reach, fine(mean))
        if mean is not None:
            axes.hlines(place, 0.0, mean, color=GRID, linewidth=3.5, zorder=1)
            axes.plot(mean, place, marker="o", color=colour, markersize=5.5, clip_on=False, zorder=4)
    label_rows(axes, rows)
    axes.tick_params(axis="y", pad=7)
    axes.set_xlim(0.0, largest * 6.0)
    label_deviation(axes)
    axes.plot([], [], "o", color=INK, markersize=5.5, label="mean")
    explain_marks(axes, home)
    legend_above(axes, columns=3)


def _words_of_costs(home: HomeResults) -> Words:
    named = [(name, home.methods[name].mean.energy_cost) for name in in_order(home.methods)]
    costs = "; ".join(f"{name} {money(cost, home.currency)}" for name, cost in named)
    return Words(
        "(c) Energy cost of each method",
        f"Bars of the energy cost: {costs}.",
        "Bar and number: mean over the seeds. Read it together with (d): a home that is allowed to drift "
        "warm costs less.",
    )


def _words_of_deviations(home: HomeResults) -> Words:
    named = [(name, home.methods[name].mean.mean_temperature_deviation) for name in in_order(home.methods)]
    deviations = "; ".join(f"{name} {degrees(deviation)}" for name, deviation in named)
    return Words(
        "(d) Mean temperature deviation of each method",
        f"Points of the mean temperature deviation: {deviations}.",
        "Mean over all slots of the distance from the comfort band; 0 is always comfortable. The axis is "
        f"linear below 0.001 °C, logarithmic above. {FROM_ZERO}",
    )


def _height(home: HomeResults) -> float:
    return rows_height(home.methods)


ENERGY_COST = half_panel("energy-cost", draw_costs, _words_of_costs, _height)
TEMPERATURE_DEVIATION = half_panel("temperature-deviation", draw_deviations, _words_of_deviations, _height)
