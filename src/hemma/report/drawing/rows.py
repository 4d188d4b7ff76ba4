"""Methods one below the other, in their groups: the rows of every figure that compares them."""

from collections.abc import Iterable
from dataclasses import dataclass

from matplotlib.axes import Axes

from hemma.report.drawing.canvas import FAINT, INK
from hemma.report.methods import grouped
from hemma.results.results import HomeResults

FROM_ZERO = "No deviation is negative: an interval that reaches below zero is drawn from zero."
UNGROUPED = 8
"""Up to so many methods stand without the titles of their groups."""


@dataclass(frozen=True)
class GroupTitle:
    """A line of text above the rows of a group."""

    text: str
    place: float


@dataclass(frozen=True)
class MethodRows:
    """Where each method stands, from 0 downwards in steps of one row."""

    places: dict[str, float]
    """By method."""
    titles: tuple[GroupTitle, ...]
    count: float
    """Rows in all, with those of the titles."""


def method_rows(methods: Iterable[str]) -> MethodRows:
    """The rows of the methods; many of them stand under the titles of their groups."""
    groups = grouped(methods)
    has_titles = sum(map(len, groups.values())) > UNGROUPED and len(groups) > 1
    places: dict[str, float] = {}
    titles: list[GroupTitle] = []
    place = 0.0
    for title, names in groups.items():
        if has_titles:
            titles.append(GroupTitle(title, place))
            place += 1.0
        for name in names:
            places[name] = place
            place += 1.0
    return MethodRows(places, tuple(titles), place)


def rows_height(methods: Iterable[str]) -> float:
    """Height [inch] of a figure with these rows, its title, its legend and its axis."""
    return 1.15 + 0.19 * max(5.0, method_rows(methods).count)


def label_rows(axes: Axes, rows: MethodRows) -> None:
    """Names on the left, the titles of the groups inside the axes."""
    axes.set_yticks(list(rows.places.values()), list(rows.places))
    axes.set_ylim(rows.count - 0.4, -0.6)
    axes.tick_params(axis="y", length=0)
    axes.grid(axis="y", visible=False)
    for title in rows.titles:
        axes.text(
            0.005,
            title.place + 0.12,
            title.text,
            transform=axes.get_yaxis_transform(),
            va="center",
            fontsize=7.5,
            color=FAINT,
            zorder=5,
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.6},
        )


def write_value(axes: Axes, place: float, reach: float, text: str) -> None:
    """Write a number to the right of everything that is drawn in its row."""
    axes.annotate(
        text,
        (reach, place),
        xytext=(7, 0),
        textcoords="offset points",
        va="center",
        fontsize=8.0,
        color=INK,
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.8},
    )


def above_zero(interval: tuple[float, float] | None) -> tuple[float, float] | None:
    """The part of an interval that can be true of what is never negative, for drawing it."""
    return None if interval is None else (max(0.0, interval[0]), max(0.0, interval[1]))


def draw_interval(axes: Axes, place: float, interval: tuple[float, float] | None, colour: str) -> None:
    """A 95 % interval with its two ends."""
    if interval is not None:
        axes.hlines(place, *interval, color=colour, linewidth=1.8, zorder=3)
        axes.plot(interval, [place, place], "|", color=colour, markersize=6, markeredgewidth=1.4, zorder=3)


def draw_seeds(axes: Axes, place: float, values: Iterable[float | None], colour: str) -> list[float]:
    """Faint points, a little below the mean; the values that exist."""
    drawn = [value for value in values if value is not None]
    if len(drawn) > 1:
        axes.plot(drawn, [place + 0.27] * len(drawn), "o", color=colour, alpha=0.45, markersize=2.8, mew=0)
    return drawn


def explain_marks(axes: Axes, home: HomeResults) -> None:
    """Interval and seeds in the legend, where there are any."""
    if all(len(method.runs) < 2 for method in home.methods.values()):
        return
    axes.plot([], [], "|-", color=INK, markersize=6, label="95 % interval")
    axes.plot([], [], "o", color=FAINT, alpha=0.6, markersize=3.2, mew=0, label="one seed")
