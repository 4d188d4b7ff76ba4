"""Learning curves: how cost and comfort on the training days went with the training of every method."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.ticker import FuncFormatter, NullLocator

from hemma.report.drawing.canvas import INK, new_figure
from hemma.report.methods import in_order, look_of
from hemma.report.numbers import plain
from hemma.report.series import SeriesReader, TrainingCurve
from hemma.results.results import HomeResults

COST, DEVIATION = "train_energy_cost", "train_temperature_deviation"
MOST_POINTS = 150
"""A longer curve is drawn as means of equally many neighbouring rows."""
COLUMNS, _FEWEST_COLUMNS = 5, 3
SHARE_LABEL = "Share of training (%)"
_OTHERS = "#C9C9C9"
_LINEAR_BELOW = 0.1
"""Deviation [degC/day] below which its axis is linear."""

Curves = dict[str, list[TrainingCurve]]
"""The training curves of a home by method."""


@dataclass(frozen=True)
class Spread:
    """A quantity over the training, over the seeds of a method."""

    share: Float[np.ndarray, "points"]
    """How much of the training was over, as a fraction."""
    mean: Float[np.ndarray, "points"]
    low: Float[np.ndarray, "points"]
    high: Float[np.ndarray, "points"]


def read_curves(reader: SeriesReader, home: HomeResults) -> Curves:
    """The training curves of a home by method; methods without any are left out."""
    named = {
        name: [run.curve for run in home.methods[name].runs if run.curve] for name in in_order(home.methods)
    }
    return {name: [reader.curve(path) for path in paths] for name, paths in named.items() if paths}


def spread_of(runs: list[TrainingCurve], quantity: str) -> Spread | None:
    """Mean and range over the runs that have the quantity; None if none has it.

    Runs of another number of iterations are brought to the shares of training of the first.
    """
    having = [run for run in runs if quantity in run.quantities]
    if not having:
        return None
    share = thinned(having[0].share)
    values = [np.interp(share, thinned(run.share), thinned(run.quantities[quantity])) for run in having]
    return Spread(share, np.mean(values, axis=0), np.min(values, axis=0), np.max(values, axis=0))


def thinned(values: np.ndarray) -> np.ndarray:
    """Means of neighbouring rows, at most about ``MOST_POINTS`` of them; the last group may be smaller."""
    size = -(-len(values) // MOST_POINTS)
    return np.array([np.mean(values[first : first + size]) for first in range(0, len(values), size)])


def learning_figure(home: HomeResults, curves: Curves) -> Figure | None:
    """Cost above, deviation below: a small panel a method, the others' means in grey behind it.

    None where no run was measured on its training days.
    """
    costs, deviations = _spreads(curves, COST), _spreads(curves, DEVIATION)
    if not costs and not deviations:
        return None
    rows = -(-max(len(costs), len(deviations)) // COLUMNS)
    figure = new_figure(9.2, 1.0 + 3.1 * rows)
    above, below = figure.subfigures(2, 1, squeeze=False).ravel()
    panels = _block(above, costs, f"Energy cost on the training days ({home.currency}/day)")
    if panels:
        panels[0].set_ylim(_limits(costs))
    panels = _block(below, deviations, "Temperature deviation on the training days (°C/day)")
    for axes in panels:
        axes.set_yscale("symlog", linthresh=_LINEAR_BELOW)
        axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: plain(value)))
        axes.yaxis.set_minor_locator(NullLocator())
        axes.set_ylim(0.0, 1.6 * max([_LINEAR_BELOW, *_edges(deviations)]))
    below.supxlabel(SHARE_LABEL, fontsize=9.0)
    return figure


def mark_shares(axes: Axes) -> None:
    """The start, the middle and the end of the training below the axes."""
    axes.set_xlim(0.0, 1.0)
    axes.set_xticks([0.0, 0.5, 1.0], ["0", "50", "100"])


def _spreads(curves: Curves, quantity: str) -> dict[str, Spread]:
    found = {name: spread_of(runs, quantity) for name, runs in curves.items()}
    return {name: spread for name, spread in found.items() if spread is not None}


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
