"""Quantities over the training of a method: mean and range over its seeds."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from matplotlib.axes import Axes

from hemma.report.series import TrainingCurve
from hemma.report.subject import Curves

COST, DEVIATION = "train_energy_cost", "train_temperature_deviation"
MOST_POINTS = 150
"""A longer curve is drawn as means of equally many neighbouring rows."""
SHARE_LABEL = "Share of training (%)"


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
