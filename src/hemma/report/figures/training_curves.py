"""Learning curves: how cost and comfort on the training days went with the training of every method."""

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from hemma.report.drawing.canvas import INK, new_figure, plain_numbers
from hemma.report.drawing.spread import COST, DEVIATION, SHARE_LABEL, Spread, mark_shares, spreads_of
from hemma.report.figures.figure import LEARNING, HomeFigure, Words
from hemma.report.methods import look_of
from hemma.report.numbers import money
from hemma.report.subject import HomeSubject

COLUMNS, _FEWEST_COLUMNS = 5, 3
_OTHERS = "#C9C9C9"
_LINEAR_BELOW = 0.1
"""Deviation [degC/day] below which its axis is linear."""


def learning_figure(subject: HomeSubject) -> Figure:
    """Cost above, deviation below: a small panel a method, the others' means in grey behind it."""
    costs, deviations = (spreads_of(subject.curves, quantity) for quantity in (COST, DEVIATION))
    rows = -(-max(len(costs), len(deviations)) // COLUMNS)
    figure = new_figure(9.2, 1.0 + 3.1 * rows)
    above, below = figure.subfigures(2, 1, squeeze=False).ravel()
    panels = _block(above, costs, f"Energy cost on the training days ({subject.home.currency}/day)")
    if panels:
        panels[0].set_ylim(_limits(costs))
    panels = _block(below, deviations, "Temperature deviation on the training days (°C/day)")
    for axes in panels:
        axes.set_yscale("symlog", linthresh=_LINEAR_BELOW)
        plain_numbers(axes.yaxis)
        axes.set_ylim(0.0, 1.6 * max([_LINEAR_BELOW, *_edges(deviations)]))
    below.supxlabel(SHARE_LABEL, fontsize=9.0)
    return figure


def _block(figure: SubFigure, spreads: dict[str, Spread], title: str) -> list[Axes]:
    """The panels of one quantity; those that are drawn."""
    figure.suptitle(title, x=0.01, ha="left", fontsize=10.0, fontweight="bold", color=INK)
    columns = min(COLUMNS, max(_FEWEST_COLUMNS, len(spreads)))
    grid = figure.subplots(-(-len(spreads) // columns) or 1, columns, sharex=True, sharey=True, squeeze=False)
    panels = list(grid.ravel())
    for axes in panels[len(spreads) :]:
        axes.set_axis_off()
    for place, (axes, name) in enumerate(zip(panels, spreads, strict=False)):
        _draw(axes, spreads, name)
        axes.tick_params(labelsize=7.5, labelbottom=place + columns >= len(spreads))
    return panels[: len(spreads)]


def _draw(axes: Axes, spreads: dict[str, Spread], name: str) -> None:
    for other, spread in spreads.items():
        if other != name:
            axes.plot(spread.share, spread.mean, color=_OTHERS, lw=0.7, zorder=1)
    mine, look = spreads[name], look_of(name)
    axes.fill_between(mine.share, mine.low, mine.high, color=look.colour, alpha=0.25, lw=0, zorder=2)
    axes.plot(mine.share, mine.mean, color=look.colour, lw=1.5, zorder=3)
    axes.set_title(name, fontsize=8.5, pad=3.0)
    mark_shares(axes)


def _limits(spreads: dict[str, Spread]) -> tuple[float, float]:
    """From the least to what 19 of 20 values stay below: the first iterations of a method may be far off."""
    values = _edges(spreads)
    if not len(values):
        return 0.0, 1.0
    low, high = float(np.min(values)), float(np.quantile(values, 0.95))
    margin = 0.1 * (high - low) or 0.5
    return low - margin, high + margin


def _edges(spreads: dict[str, Spread]) -> np.ndarray:
    """All ends of the ranges that are numbers: a learner may lose itself."""
    values = np.concatenate([edge for spread in spreads.values() for edge in (spread.low, spread.high)])
    return values[np.isfinite(values)]


def _measured(subject: HomeSubject) -> HomeSubject | None:
    """None where no run was measured on its training days."""
    return subject if any(spreads_of(subject.curves, quantity) for quantity in (COST, DEVIATION)) else None


def _words(subject: HomeSubject) -> Words:
    ends = "; ".join(
        f"{name} {_last(spread, subject.home.currency)} a day"
        for name, spread in spreads_of(subject.curves, COST).items()
    )
    return Words(
        "Learning curves",
        "Energy cost and temperature deviation on the training days over the training. Cost at the end: "
        f"{ends}.",
        "Line: mean over the seeds; area: their range; grey: the means of the other methods. Measured with "
        "the mean action on the training days, never on the test period. The shares of training make methods "
        "comparable whose iterations are of another kind.",
    )


def _last(spread: Spread, currency: str) -> str:
    """The mean at the end of the training; a dash where a learner lost itself."""
    cost = float(spread.mean[-1])
    return money(cost if math.isfinite(cost) else None, currency)


TRAINING_CURVES = HomeFigure[HomeSubject](
    name="training-curves",
    section=LEARNING,
    needs=_measured,
    draw=learning_figure,
    words=_words,
    missing="No training curve in this folder.",
)
