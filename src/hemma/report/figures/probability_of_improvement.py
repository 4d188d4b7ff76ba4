"""Who beats whom: the probability that a run of one method has a lower regret than a run of another."""

from collections.abc import Iterable
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from hemma.report.drawing.canvas import FULL_WIDTH, new_figure
from hemma.report.figures.figure import HomeFigure, ReportFigure, ReportSection, Words
from hemma.report.methods import in_order
from hemma.report.numbers import decimals
from hemma.results.findings import ImprovementRecord
from hemma.results.results import HomeResults, Results

_COLOURS = LinearSegmentedColormap.from_list(
    "better", ["#EDA873", "#FBEDE1", "#FFFFFF", "#E3EFF7", "#74B3DC"]
)
"""Vermillion for worse, blue for better, both light enough for black numbers."""
_PALE = 0.25
"""What is left of the colour where the interval holds one half and nobody can tell which is better."""
NOT_LEARNED = ("MPC forecast", "thresholds")
"""What the learned methods are compared with, run by run, beside each other."""
_CELL = 0.72
"""Side [inch] of a cell."""


@dataclass(frozen=True)
class Chances:
    """All pairs of methods."""

    methods: tuple[str, ...]
    pairs: dict[tuple[str, str], ImprovementRecord]
    """By (method, over); both directions of every pair that is known."""


def comparison_of(improvements: Iterable[ImprovementRecord], methods: set[str]) -> Chances:
    """The pairs among the methods; a pair given one way only is turned around."""
    known = [one for one in improvements if one.probability is not None and {one.method, one.over} <= methods]
    pairs = {(entry.over, entry.method): _turned(entry) for entry in known}
    pairs |= {(entry.method, entry.over): entry for entry in known}
    named = in_order(dict.fromkeys(name for pair in pairs for name in pair))
    return Chances(tuple(named), pairs)


def improvement_figure(comparison: Chances) -> Figure:
    """A table of colours and numbers; a row is the method that is asked about, a column the one it meets."""
    methods = comparison.methods
    side = _CELL * len(methods)
    figure = new_figure(max(FULL_WIDTH, side + 2.0), max(2.6, 0.62 * side + 1.3))
    axes = figure.add_subplot()
    for (method, over), entry in comparison.pairs.items():
        _draw_cell(axes, methods.index(method), methods.index(over), entry)
    axes.set_xticks(range(len(methods)), methods, rotation=30, ha="left", rotation_mode="anchor")
    axes.set_yticks(range(len(methods)), methods)
    axes.set_xlim(-0.5, len(methods) - 0.5)
    axes.set_ylim(len(methods) - 0.5, -0.5)
    axes.tick_params(top=True, labeltop=True, bottom=False, labelbottom=False, length=0)
    axes.grid(visible=False)
    axes.spines[:].set_visible(False)
    axes.set_ylabel("a run of …")
    axes.set_xlabel("… has a lower regret than a run of the method above with this probability")
    return figure


def _draw_cell(axes: Axes, row: int, column: int, entry: ImprovementRecord) -> None:
    """A rectangle and not a pixel of an image: the figure stays sharp and holds no foreign file."""
    corner, colour = (column - 0.5, row - 0.5), _colour(entry)
    axes.add_patch(Rectangle(corner, 1, 1, facecolor=colour, edgecolor="white", lw=1.5))
    lift = 0.0 if entry.interval is None else 0.13
    axes.text(column, row - lift, decimals(entry.probability, 2), ha="center", va="center", fontsize=8.5)
    if entry.interval is not None:
        said = "–".join(decimals(bound, 2) for bound in entry.interval)
        axes.text(column, row + 0.25, said, ha="center", va="center", fontsize=6.2)


def _colour(entry: ImprovementRecord) -> tuple[float, float, float, float]:
    """Of the probability; pale where its interval leaves open which of the two is better."""
    chance = 0.5 if entry.probability is None else entry.probability
    is_open = entry.interval is not None and entry.interval[0] <= 0.5 <= entry.interval[1]
    return _COLOURS(0.5 + (_PALE if is_open else 1.0) * (chance - 0.5))


def _turned(entry: ImprovementRecord) -> ImprovementRecord:
    """The same pair seen from the other method: 1 - p."""
    chance = None if entry.probability is None else 1 - entry.probability
    interval = None if entry.interval is None else (1 - entry.interval[1], 1 - entry.interval[0])
    return ImprovementRecord(method=entry.over, over=entry.method, probability=chance, interval=interval)


def _over_homes(results: Results) -> Chances | None:
    pairs = results.aggregate.probability_of_improvement if results.aggregate else ()
    return _among_learned(pairs, results.finished.values())


def _among_learned(improvements: Iterable[ImprovementRecord], homes: Iterable[HomeResults]) -> Chances | None:
    """Among the learned methods and two others: what knows nothing by chance either beats another or not."""
    learned = {name for home in homes for name, method in home.methods.items() if method.is_learned}
    found = comparison_of(improvements, learned.union(NOT_LEARNED) if learned else set())
    return found if found.methods else None


def _words(comparison: Chances, over: str) -> Words:
    """``over`` says what the runs are of."""
    pairs = "; ".join(
        f"{method} over {other} {decimals(entry.probability, 2)}"
        for (method, other), entry in comparison.pairs.items()
        if comparison.methods.index(method) < comparison.methods.index(other)
    )
    return Words(
        "How probably one method beats another",
        f"Probability that a run of the first has the lower regret: {pairs}.",
        f"Over all pairs of runs {over}, ties count half; below it the 95 % interval, which is over other "
        "seeds alone. One half means that nobody can tell which is better; the colour is pale where the "
        "interval holds one half and leaves it open.",
    )


PROBABILITY_OF_IMPROVEMENT = HomeFigure[Chances](
    name="probability-of-improvement",
    section=ReportSection("How sure the differences are"),
    needs=lambda subject: _among_learned(subject.home.probability_of_improvement, [subject.home]),
    draw=improvement_figure,
    words=lambda comparison: _words(comparison, "of this home"),
    missing="No learned method is compared with another run by run in this folder.",
)
IMPROVEMENT_OVER_HOMES = ReportFigure[Results, Chances](
    name="probability-of-improvement",
    section=ReportSection("How sure the differences are"),
    needs=_over_homes,
    draw=improvement_figure,
    words=lambda comparison: _words(comparison, "on the same home"),
)
