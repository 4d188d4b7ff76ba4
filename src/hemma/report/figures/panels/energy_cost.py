"""Panel (c): the energy cost of the methods side by side."""

from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from hemma.report.drawing.canvas import INK, PANEL_WIDTH, legend_above, single
from hemma.report.drawing.rows import (
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
from hemma.report.numbers import DASH, decimals, money
from hemma.results.results import HomeResults


def draw_costs(axes: Axes, home: HomeResults) -> None:
    """Energy cost of each method, the 95 % interval, every seed, and the optimum."""
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
    explain_marks(axes, home)
    axes.set_xlabel(f"Energy cost of the test period ({home.currency})")
    axes.xaxis.set_major_locator(MaxNLocator(5))
    axes.margins(x=0.18)
    legend_above(axes, columns=3)


def _words(home: HomeResults) -> Words:
    named = [(name, home.methods[name].mean.energy_cost) for name in in_order(home.methods)]
    costs = "; ".join(f"{name} {money(cost, home.currency)}" for name, cost in named)
    return Words(
        "(c) Energy cost of each method",
        f"Bars of the energy cost: {costs}.",
        "Bar and number: mean over the seeds. Read it together with (d): a home that is allowed to drift "
        "warm costs less.",
    )


ENERGY_COST = HomeFigure[HomeResults](
    name="energy-cost",
    section=PANELS,
    needs=lambda subject: subject.home,
    draw=lambda home: single(PANEL_WIDTH, rows_height(home.methods), lambda axes: draw_costs(axes, home)),
    words=_words,
    is_wide=False,
)
