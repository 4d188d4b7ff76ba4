"""How the learners got there: training curves, and the identified network running on its own."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hemma.report.canvas import FAINT, INK, days_below, legend_above, new_figure
from hemma.report.methods import BLUE, VERMILLION, in_order, look_of
from hemma.report.results import HomeResults
from hemma.report.series import FreeRun, SeriesReader, TrainingCurve

MOST_POINTS = 150
"""A longer curve is drawn as means of equally many neighbouring rows."""


@dataclass(frozen=True)
class CurveQuantity:
    """One quantity of a training curve."""

    title: str
    unit: str
    read: Callable[[TrainingCurve], np.ndarray | None]


def curve_quantities(currency: str) -> tuple[CurveQuantity, ...]:
    """What is drawn of the training, in this order."""
    return (
        CurveQuantity("Energy cost, training days", f"{currency}/day", lambda curve: curve.train_energy_cost),
        CurveQuantity(
            "Temperature deviation, training days", "°C/day", lambda curve: curve.train_temperature_deviation
        ),
        CurveQuantity("Discriminator loss", "nat", lambda curve: curve.discriminator_loss),
        CurveQuantity("Mean learned reward", "no unit", lambda curve: curve.learned_reward),
        CurveQuantity("Expert transitions recognised", "fraction", lambda curve: curve.expert_accuracy),
        CurveQuantity("Agent transitions recognised", "fraction", lambda curve: curve.agent_accuracy),
        CurveQuantity("Policy change (KL)", "nat", lambda curve: curve.policy_kl),
        CurveQuantity("Policy entropy", "nat", lambda curve: curve.policy_entropy),
    )


def read_curves(reader: SeriesReader, home: HomeResults) -> dict[str, list[TrainingCurve]]:
    """The training curves of a home by method; methods without any are left out."""
    named = {
        name: [run.curve for run in home.methods[name].runs if run.curve] for name in in_order(home.methods)
    }
    return {name: [reader.curve(path) for path in paths] for name, paths in named.items() if paths}


def training_figure(home: HomeResults, curves: dict[str, list[TrainingCurve]]) -> Figure:
    """Small multiples, one panel a quantity that any method has, one thin line a seed."""
    drawn = [
        quantity
        for quantity in curve_quantities(home.currency)
        if any(quantity.read(curve) is not None for runs in curves.values() for curve in runs)
    ]
    rows = max(1, -(-len(drawn) // 2))
    figure = new_figure(9.2, 0.5 + 2.0 * rows)
    panels = figure.subplots(rows, 2, squeeze=False).ravel()
    for axes, quantity in zip(panels, drawn, strict=False):
        _draw_curves(axes, quantity, curves)
    for axes in panels[len(drawn) :]:
        axes.set_axis_off()
    for axes in panels[max(0, len(drawn) - 2) : len(drawn)]:
        axes.set_xlabel("Iteration")
    handles = [panels[0].plot([], [], color=look_of(n).colour, linestyle=look_of(n).line)[0] for n in curves]
    figure.legend(handles, list(curves), loc="outside upper left", ncols=7)
    return figure


def thinned(values: np.ndarray) -> np.ndarray:
    """Means of neighbouring rows, at most about ``MOST_POINTS`` of them; the last group may be smaller."""
    size = -(-len(values) // MOST_POINTS)
    return np.array([np.mean(values[first : first + size]) for first in range(0, len(values), size)])


def free_run_figure(run: FreeRun, slots: int) -> Figure:
    """The first ``slots`` slots of a free run beside the measurement, and its error over the whole period."""
    figure = new_figure(9.2, 5.0)
    above, below = figure.subplots(2, 1)
    count = min(slots, len(run.measured))
    posts = run.clock.fence_posts(count)
    above.set_title("The identified network on its own, first days")
    above.plot(posts[:-1], run.measured[:count], color=INK, label="measured")
    above.plot(posts[:-1], run.predicted[:count], color=BLUE, linestyle="--", label="predicted")
    above.set_ylabel("Indoor temperature (°C)")
    days_below(above, posts[0], posts[-1])
    legend_above(above, columns=2)
    whole = run.clock.fence_posts(len(run.measured))
    below.set_title("Error over the whole period")
    below.axhline(0.0, color=FAINT, lw=0.9)
    below.plot(whole[:-1], run.predicted - run.measured, color=VERMILLION, lw=1.0)
    below.set_ylabel("Predicted − measured (°C)")
    days_below(below, whole[0], whole[-1])
    below.set_xlabel(f"Local time ({run.clock.offset})")
    return figure


def _draw_curves(axes: Axes, quantity: CurveQuantity, curves: dict[str, list[TrainingCurve]]) -> None:
    axes.set_title(quantity.title)
    axes.set_ylabel(quantity.unit)
    for name, runs in curves.items():
        for curve in runs:
            values = quantity.read(curve)
            if values is not None:
                look = look_of(name)
                axes.plot(
                    thinned(curve.iteration),
                    thinned(values),
                    color=look.colour,
                    linestyle=look.line,
                    lw=1.1,
                    alpha=0.75,
                )
