"""A metric against demonstration length: what more days of demonstrations bring."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from hemma.evaluation import Intervals, Metrics
from hemma.report.drawing.canvas import FAINT, legend_above, say_nothing_to_show
from hemma.report.methods import in_order, look_of
from hemma.report.numbers import decimals, plain
from hemma.results.records import DemonstrationRuns
from hemma.results.results import HomeResults

REFERENCES = ("Rule", "PPO", "MaxEnt IRL", "DNLP", "optimum")
"""Methods whose level is drawn where they were not trained on demonstrations of several lengths."""
_SPREAD = 1.06
"""Factor between the places of two methods at the same length, so that their whiskers stand side by side."""


@dataclass(frozen=True)
class Quantity:
    """A metric and how to read it from means, runs and intervals."""

    label: str
    read: Callable[[Metrics], float | None]
    read_interval: Callable[[Intervals], tuple[float, float] | None]


def demonstration_lengths(home: HomeResults) -> tuple[DemonstrationRuns, ...]:
    """The runs by demonstration length; without such a study HA-1 and HA-2 are two lengths of one method."""
    if home.data_efficiency:
        return home.data_efficiency
    return tuple(
        DemonstrationRuns(days=days, method="AIRL", **home.methods[name].model_dump())
        for name, days in home.demonstration_days.items()
        if name in home.methods and name in ("HA-1", "HA-2")
    )


def draw_by_length(axes: Axes, home: HomeResults, quantity: Quantity) -> None:
    """Lines over the lengths, and the levels of methods that were not trained on several."""
    points = demonstration_lengths(home)
    if not points:
        say_nothing_to_show(axes, "No runs over demonstration length\nin this results folder.")
        return
    methods = in_order({point.method for point in points})
    for place, method in enumerate(methods):
        shift = _SPREAD ** (place - (len(methods) - 1) / 2)
        mine = sorted((point for point in points if point.method == method), key=lambda point: point.days)
        _draw_method(axes, mine, quantity, shift)
    _draw_references(axes, home, quantity, methods)
    _label_lengths(axes, sorted({point.days for point in points}))
    axes.set_ylabel(quantity.label)
    legend_above(axes, columns=3)


def _draw_method(axes: Axes, points: list[DemonstrationRuns], quantity: Quantity, shift: float) -> None:
    look = look_of(points[0].method)
    for point in points:
        seeds = [value for run in point.runs if (value := quantity.read(run)) is not None]
        axes.plot([point.days * shift] * len(seeds), seeds, ".", color=look.colour, alpha=0.35, ms=6, mew=0)
        interval = quantity.read_interval(point.interval)
        if interval is not None:
            axes.vlines(point.days * shift, *interval, color=look.colour, linewidth=1.6)
    means = [
        (point.days * shift, value) for point in points if (value := quantity.read(point.mean)) is not None
    ]
    axes.plot(
        [days for days, _ in means],
        [value for _, value in means],
        color=look.colour,
        linestyle=look.line,
        marker=look.marker,
        markersize=5,
        label=points[0].method,
    )


def _draw_references(axes: Axes, home: HomeResults, quantity: Quantity, trained: list[str]) -> None:
    """The levels of other methods as lines; one so far away that it would flatten the rest is only named."""
    values = {name: quantity.read(_reference(home, name)) for name in REFERENCES if name not in trained}
    levels = {name: value for name, value in values.items() if value is not None}
    seen = [*_ends(home, quantity), *(levels[name] for name in ("optimum",) if name in levels)]
    low, high = min(seen), max(seen)
    reach = high - low if axes.get_yscale() == "linear" and high > low else float("inf")
    far = {name: value for name, value in levels.items() if not low - reach <= value <= high + reach}
    for name, value in levels.items():
        if name not in far:
            axes.axhline(value, color=look_of(name).colour, linestyle=look_of(name).line, lw=1.3, label=name)
    if far:
        said = ", ".join(f"{name} {decimals(value, 2)}" for name, value in far.items())
        ground = {"facecolor": "white", "edgecolor": "none", "pad": 1.0}
        place = axes.transAxes
        axes.text(0.99, 0.98, f"far off: {said}", ha="right", va="top", transform=place, size=8, bbox=ground)


def _ends(home: HomeResults, quantity: Quantity) -> Iterator[float]:
    """Every mean and every end of an interval that is drawn."""
    for point in demonstration_lengths(home):
        yield from (quantity.read_interval(point.interval) or ())
        mean = quantity.read(point.mean)
        if mean is not None:
            yield mean


def _reference(home: HomeResults, name: str) -> Metrics:
    """A method's means; the plain optimum stands in its own place too."""
    if name in home.methods:
        return home.methods[name].mean
    best = home.optimum
    if name != "optimum" or best is None:
        return Metrics()
    mean = best.mean_temperature_deviation
    total = None if mean is None else mean * home.test.slots
    return Metrics(energy_cost=best.energy_cost, total_temperature_deviation=total)


def _label_lengths(axes: Axes, lengths: list[float]) -> None:
    axes.set_xscale("log")
    axes.set_xlim(lengths[0] / 1.35, lengths[-1] * 1.35)
    axes.xaxis.set_major_locator(FixedLocator(lengths))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: plain(value)))
    axes.set_xlabel("Days of demonstrations")
    if len(lengths) == 1:
        axes.text(
            0.97,
            0.5,
            f"one length so far:\n{plain(lengths[0])} days",
            ha="right",
            va="center",
            transform=axes.transAxes,
            color=FAINT,
        )


def told_by_length(home: HomeResults, written: Callable[[Metrics], str]) -> str:
    """Every method and length with its mean, in words."""
    points = sorted(demonstration_lengths(home), key=lambda point: point.days)
    told = "; ".join(f"{p.method} with {plain(p.days)} days {written(p.mean)}" for p in points)
    return told or "no such runs"
