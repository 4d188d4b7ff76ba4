"""Panels (a) and (b): energy cost and comfort against demonstration length, what more days of it bring."""

from collections.abc import Callable

from matplotlib.axes import Axes
from matplotlib.ticker import FixedLocator

from hemma.evaluation import Metrics
from hemma.report.drawing.canvas import (
    FAINT,
    legend_above,
    on_white,
    plain_numbers,
    say_nothing_to_show,
)
from hemma.report.drawing.rows import FROM_ZERO, Quantity
from hemma.report.figures.figure import Words, half_panel
from hemma.report.methods import in_order, look_of
from hemma.report.numbers import decimals, degrees, money, plain
from hemma.results.records import DemonstrationRuns
from hemma.results.results import HomeResults

REFERENCES = ("Rule", "PPO", "MaxEnt IRL", "DNLP", "optimum")
"""Methods whose level is drawn where they were not trained on demonstrations of several lengths."""
_SPREAD = 1.06
"""Factor between the places of two methods at the same length, so that their whiskers stand side by side."""
_COST = Quantity(lambda it: it.energy_cost)
_DEVIATION = Quantity(lambda it: it.total_temperature_deviation, is_never_negative=True)


def demonstration_lengths(home: HomeResults) -> tuple[DemonstrationRuns, ...]:
    """The runs by demonstration length; without such a study HA-1 and HA-2 are two lengths of one method."""
    if home.data_efficiency:
        return home.data_efficiency
    return tuple(
        DemonstrationRuns(days=days, method="AIRL", **home.methods[name].model_dump())
        for name, days in home.demonstration_days.items()
        if name in home.methods and name in ("HA-1", "HA-2")
    )


def draw_cost_by_length(axes: Axes, home: HomeResults) -> None:
    """Total energy cost against demonstration length."""
    axes.set_title("(a) Energy cost and demonstrations")
    _draw_by_length(axes, home, _COST, f"Energy cost of the test period ({home.currency})")


def draw_deviation_by_length(axes: Axes, home: HomeResults) -> None:
    """Total temperature deviation against demonstration length, linear below 1 degC."""
    axes.set_title("(b) Comfort and demonstrations")
    axes.set_yscale("symlog", linthresh=1.0)
    _draw_by_length(axes, home, _DEVIATION, "Total temperature deviation (°C)")
    if axes.axison:
        plain_numbers(axes.yaxis)
        axes.set_ylim(bottom=0.0)


def _draw_by_length(axes: Axes, home: HomeResults, quantity: Quantity, label: str) -> None:
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
    axes.set_ylabel(label)
    legend_above(axes, columns=3)


def _draw_method(axes: Axes, points: list[DemonstrationRuns], quantity: Quantity, shift: float) -> None:
    name, look = points[0].method, look_of(points[0].method)
    for point in points:
        seeds, place = quantity.of_runs(point), point.days * shift
        axes.plot([place] * len(seeds), seeds, ".", color=look.colour, alpha=0.35, ms=6, mew=0)
        interval = quantity.interval_of(point)
        if interval is not None:
            axes.vlines(place, *interval, color=look.colour, linewidth=1.6)
    known = [point for point in points if quantity.read(point.mean) is not None]
    days, means = [point.days * shift for point in known], [quantity.read(point.mean) for point in known]
    axes.plot(
        days, means, color=look.colour, linestyle=look.line, marker=look.marker, markersize=5, label=name
    )


def _draw_references(axes: Axes, home: HomeResults, quantity: Quantity, trained: list[str]) -> None:
    """The levels of other methods as lines; one so far away that it would flatten the rest is only named."""
    values = {name: quantity.read(_reference(home, name)) for name in REFERENCES if name not in trained}
    levels = {name: value for name, value in values.items() if value is not None}
    seen = [levels[name] for name in ("optimum",) if name in levels]
    for point in demonstration_lengths(home):
        ends = (quantity.read(point.mean), *(quantity.interval_of(point) or ()))
        seen.extend(end for end in ends if end is not None)
    low, high = min(seen), max(seen)
    reach = high - low if axes.get_yscale() == "linear" and high > low else float("inf")
    far = {name: value for name, value in levels.items() if not low - reach <= value <= high + reach}
    for name, value in levels.items():
        if name not in far:
            axes.axhline(value, color=look_of(name).colour, linestyle=look_of(name).line, lw=1.3, label=name)
    if far:
        said = ", ".join(f"{name} {decimals(value, 2)}" for name, value in far.items())
        look = {"size": 8, "bbox": on_white(1.0)}
        axes.text(0.99, 0.98, f"far off: {said}", ha="right", va="top", transform=axes.transAxes, **look)


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
    plain_numbers(axes.xaxis)
    axes.set_xlabel("Days of demonstrations")
    if len(lengths) == 1:
        said, place = f"one length so far:\n{plain(lengths[0])} days", axes.transAxes
        axes.text(0.97, 0.5, said, ha="right", va="center", transform=place, color=FAINT)


def _told(home: HomeResults, written: Callable[[Metrics], str]) -> str:
    """Every method and length with its mean, in words."""
    points = sorted(demonstration_lengths(home), key=lambda point: point.days)
    told = "; ".join(f"{p.method} with {plain(p.days)} days {written(p.mean)}" for p in points)
    return told or "no such runs"


def _words_of_cost(home: HomeResults) -> Words:
    costs = _told(home, lambda mean: money(mean.energy_cost, home.currency))
    return Words(
        "(a) Energy cost against demonstration length",
        f"Energy cost by days of demonstrations: {costs}.",
        "What more days of demonstrations bring. Line: mean; whisker: 95 % interval; dot: one seed. "
        "Lines from edge to edge are methods that were not trained on several lengths; one so far off "
        "that it would flatten the rest is only named.",
    )


def _words_of_deviation(home: HomeResults) -> Words:
    deviations = _told(home, lambda mean: degrees(mean.total_temperature_deviation))
    return Words(
        "(b) Temperature deviation against demonstration length",
        f"Total temperature deviation by days of demonstrations: {deviations}.",
        "Sum over all slots of the distance from the comfort band. The axis is linear below 1 °C, "
        f"logarithmic above. {FROM_ZERO}",
    )


COST_BY_DEMONSTRATIONS = half_panel(
    "cost-by-demonstrations", draw_cost_by_length, _words_of_cost, lambda _: 3.6
)
DEVIATION_BY_DEMONSTRATIONS = half_panel(
    "deviation-by-demonstrations", draw_deviation_by_length, _words_of_deviation, lambda _: 3.6
)
