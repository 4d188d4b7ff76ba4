"""Methods one below the other, in their groups: the rows of every figure that compares them."""

from collections.abc import Iterable
from dataclasses import dataclass

from matplotlib.axes import Axes

from hemma.report.drawing.canvas import FAINT, INK, on_white
from hemma.report.methods import grouped
from hemma.report.tables.cells import Metric
from hemma.results.records import MethodRuns
from hemma.results.results import HomeResults

FROM_ZERO = "No deviation is negative: an interval that reaches below zero is drawn from zero."
UNGROUPED = 8
"""Up to so many methods stand without the titles of their groups."""


@dataclass(frozen=True)
class MethodRows:
    """Where each method stands, from 0 downwards in steps of one row."""

    places: dict[str, float]
    """By method."""
    titles: dict[str, float]
    """Of groups, where they have any."""
    count: float
    """Rows in all, with those of the titles."""


def method_rows(methods: Iterable[str]) -> MethodRows:
    """The rows of the methods; many of them stand under the titles of their groups."""
    groups = grouped(methods)
    has_titles = sum(map(len, groups.values())) > UNGROUPED and len(groups) > 1
    places: dict[str, float] = {}
    titles: dict[str, float] = {}
    place = 0.0
    for title, names in groups.items():
        if has_titles:
            titles[title] = place
            place += 1.0
        for name in names:
            places[name] = place
            place += 1.0
    return MethodRows(places, titles, place)


def rows_height(methods: Iterable[str]) -> float:
    """Height [inch] of a figure with these rows, its title, its legend and its axis."""
    return 1.15 + 0.19 * max(5.0, method_rows(methods).count)


def label_rows(axes: Axes, rows: MethodRows) -> None:
    """Names on the left, the titles of the groups inside the axes."""
    axes.set_yticks(list(rows.places.values()), list(rows.places))
    axes.set_ylim(rows.count - 0.4, -0.6)
    axes.tick_params(axis="y", length=0)
    axes.grid(axis="y", visible=False)
    for title, place in rows.titles.items():
        text = axes.text(0.005, place + 0.12, title, transform=axes.get_yaxis_transform(), va="center")
        text.set(fontsize=7.5, color=FAINT, zorder=5, bbox=on_white(0.6))


def write_value(axes: Axes, place: float, reach: float, text: str) -> None:
    """Write a number to the right of everything that is drawn in its row."""
    note = axes.annotate(text, (reach, place), xytext=(7, 0), textcoords="offset points", va="center")
    note.set(fontsize=8.0, color=INK, bbox=on_white(0.8))


def above_zero(interval: tuple[float, float] | None) -> tuple[float, float] | None:
    """The part of an interval that can be true of what is never negative, for drawing it."""
    return None if interval is None else (max(0.0, interval[0]), max(0.0, interval[1]))


@dataclass(frozen=True)
class Quantity:
    """A metric of a method and of its runs, as it is drawn."""

    read: Metric
    is_never_negative: bool = False

    def of_runs(self, method: MethodRuns) -> list[float]:
        """Of all runs that have it."""
        return [value for run in method.runs if (value := self.read(run)) is not None]

    def interval_of(self, method: MethodRuns) -> tuple[float, float] | None:
        """The part of the 95 % interval that can be true."""
        interval = self.read(method.interval)
        return above_zero(interval) if self.is_never_negative else interval


def draw_runs(axes: Axes, place: float, method: MethodRuns, quantity: Quantity, colour: str) -> float:
    """The 95 % interval with its two ends, and the seeds a little below it; how far right a row reaches."""
    seeds, interval = quantity.of_runs(method), quantity.interval_of(method)
    if len(seeds) > 1:
        axes.plot(seeds, [place + 0.27] * len(seeds), "o", color=colour, alpha=0.45, markersize=2.8, mew=0)
    if interval is not None:
        axes.hlines(place, *interval, color=colour, linewidth=1.8, zorder=3)
        axes.plot(interval, [place, place], "|", color=colour, markersize=6, markeredgewidth=1.4, zorder=3)
    return max([0.0, *seeds, *(interval or ()), quantity.read(method.mean) or 0.0])


def explain_marks(axes: Axes, home: HomeResults) -> None:
    """Interval and seeds in the legend, where there are any."""
    if all(len(method.runs) < 2 for method in home.methods.values()):
        return
    axes.plot([], [], "|-", color=INK, markersize=6, label="95 % interval")
    axes.plot([], [], "o", color=FAINT, alpha=0.6, markersize=3.2, mew=0, label="one seed")
