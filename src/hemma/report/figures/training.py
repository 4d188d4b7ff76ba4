"""What the training of every method was like: cost and comfort on the training days, losses, rewards."""

import math
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from hemma.report.drawing.canvas import INK, new_figure, plain_numbers
from hemma.report.figures.figure import LEARNING, HomeFigure, Words
from hemma.report.methods import look_of
from hemma.report.numbers import money
from hemma.report.series import TrainingCurve
from hemma.report.subject import Curves, HomeSubject

COST, DEVIATION = "train_energy_cost", "train_temperature_deviation"
MOST_POINTS = 150
"""A longer curve is drawn as means of equally many neighbouring rows."""
SHARE_LABEL = "Share of training (%)"
COLUMNS, _FEWEST_COLUMNS = 5, 3
_PANELS_A_ROW = 3
_OTHERS = "#C9C9C9"
_LINEAR_BELOW = 0.1
"""Deviation [degC/day] below which its axis is linear."""


@dataclass(frozen=True)
class Spread:
    """A quantity over the training, over the seeds of a method."""

    share: Float[np.ndarray, "points"]
    """How much of the training was over, as a fraction."""
    mean: Float[np.ndarray, "points"]
    low: Float[np.ndarray, "points"]
    high: Float[np.ndarray, "points"]


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


def spreads_of(curves: Curves, quantity: str) -> dict[str, Spread]:
    """By method, of those that have the quantity."""
    found = {name: spread_of(runs, quantity) for name, runs in curves.items()}
    return {name: spread for name, spread in found.items() if spread is not None}


def thinned(values: np.ndarray) -> np.ndarray:
    """Means of neighbouring rows, at most about ``MOST_POINTS`` of them; the last group may be smaller."""
    size = -(-len(values) // MOST_POINTS)
    return np.array([np.mean(values[first : first + size]) for first in range(0, len(values), size)])


def mark_shares(axes: Axes) -> None:
    """The start, the middle and the end of the training below the axes."""
    axes.set_xlim(0.0, 1.0)
    axes.set_xticks([0.0, 0.5, 1.0], ["0", "50", "100"])


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
        _draw_curve(axes, spreads, name)
        axes.tick_params(labelsize=7.5, labelbottom=place + columns >= len(spreads))
    return panels[: len(spreads)]


def _draw_curve(axes: Axes, spreads: dict[str, Spread], name: str) -> None:
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


def _words_of_curves(subject: HomeSubject) -> Words:
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
    words=_words_of_curves,
    missing="No training curve in this folder.",
)


@dataclass(frozen=True)
class Diagnostic:
    """A column of the learning curves, for people."""

    column: str
    title: str
    unit: str


KNOWN = (
    Diagnostic("discriminator_loss", "Discriminator loss", "nat"),
    Diagnostic("expert_accuracy", "Expert transitions recognised", "fraction"),
    Diagnostic("agent_accuracy", "Agent transitions recognised", "fraction"),
    Diagnostic("learned_reward", "Mean learned reward", "no unit"),
    Diagnostic("reward_gap", "Learned reward, expert − agent", "no unit"),
    Diagnostic("reward", "Hand-written reward", "a slot"),
    Diagnostic("training_loss", "Loss, days learned from", "no unit"),
    Diagnostic("held_out_loss", "Loss, days held out", "no unit"),
    Diagnostic("best_held_out_loss", "Least loss so far, held out", "no unit"),
    Diagnostic("energy_cost", "Energy cost while exploring", "a slot"),
    Diagnostic("temperature_deviation", "Deviation while exploring", "°C"),
    Diagnostic("policy_kl", "Policy change (KL)", "nat"),
    Diagnostic("policy_entropy", "Policy entropy", "nat"),
)


def diagnostics_of(curves: Curves) -> list[Diagnostic]:
    """What the runs hold beside the two curves of every method: known ones first, then as they come."""
    columns = dict.fromkeys(column for runs in curves.values() for run in runs for column in run.quantities)
    known = [diagnostic for diagnostic in KNOWN if diagnostic.column in columns]
    named = {diagnostic.column for diagnostic in known} | {COST, DEVIATION}
    return known + [
        Diagnostic(column, column.replace("_", " ").capitalize(), "")
        for column in columns
        if column not in named
    ]


def diagnostics_figure(curves: Curves) -> Figure:
    """A panel a quantity, a line a method: mean and range over the seeds."""
    diagnostics = diagnostics_of(curves)
    columns = min(_PANELS_A_ROW, len(diagnostics))
    rows = -(-len(diagnostics) // columns)
    figure = new_figure(9.2, 0.7 + 1.9 * rows)
    panels = list(figure.subplots(rows, columns, squeeze=False).ravel())
    for axes, diagnostic in zip(panels, diagnostics, strict=False):
        _draw_diagnostic(axes, diagnostic, curves)
    for axes in panels[len(diagnostics) :]:
        axes.set_axis_off()
    for axes in panels[max(0, len(diagnostics) - columns) : len(diagnostics)]:
        axes.set_xlabel(SHARE_LABEL)
    shown = {one.column for one in diagnostics}
    names = [name for name, runs in curves.items() if any(shown & run.quantities.keys() for run in runs)]
    handles = [panels[0].plot([], [], color=look_of(n).colour, linestyle=look_of(n).line)[0] for n in names]
    figure.legend(handles, names, loc="outside upper left", ncols=6)
    return figure


def _draw_diagnostic(axes: Axes, diagnostic: Diagnostic, curves: Curves) -> None:
    axes.set_title(diagnostic.title, fontsize=9.0)
    axes.set_ylabel(diagnostic.unit, fontsize=8.0)
    axes.tick_params(labelsize=7.5)
    mark_shares(axes)
    for name, spread in spreads_of(curves, diagnostic.column).items():
        look = look_of(name)
        axes.fill_between(spread.share, spread.low, spread.high, color=look.colour, alpha=0.18, lw=0)
        axes.plot(spread.share, spread.mean, color=look.colour, linestyle=look.line, lw=1.3)


def _words_of_diagnostics(curves: Curves) -> Words:
    names = [diagnostic.title.lower() for diagnostic in diagnostics_of(curves)]
    return Words(
        "What else the learners wrote down",
        f"Over the training: {', '.join(names)}.",
        "Line: mean over the seeds; area: their range. Recognised transitions near one half mean that the "
        "discriminator can no longer tell agent from expert.",
    )


TRAINING_DIAGNOSTICS = HomeFigure[Curves](
    name="training-diagnostics",
    section=LEARNING,
    needs=lambda subject: subject.curves if diagnostics_of(subject.curves) else None,
    draw=diagnostics_figure,
    words=_words_of_diagnostics,
)
