"""Several homes in one figure: what each method keeps of the possible savings, home by home."""

from collections.abc import Iterator
from itertools import cycle

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import PercentFormatter

from hemma.report.comfort import at_equal_comfort
from hemma.report.drawing.canvas import FAINT, INK, new_figure
from hemma.report.drawing.rows import label_rows, method_rows, rows_height, write_value
from hemma.report.figures.figure import ReportFigure, ReportSection, Words
from hemma.report.methods import look_of
from hemma.report.numbers import percent
from hemma.results.findings import Aggregated, AggregateMethod
from hemma.results.results import Results

LOWEST = -0.5
"""A share below this is drawn at the edge as an arrow: it would flatten all others."""
_MARKERS = "os^DvPX*"


def shares_by_home(results: Results) -> dict[str, dict[str, float]]:
    """Mean share of savings by method and home, where there is one."""
    shares: dict[str, dict[str, float]] = {}
    for title, home in results.finished.items():
        for name, method in home.methods.items():
            if method.mean.share_of_savings is not None:
                shares.setdefault(name, {})[title] = method.mean.share_of_savings
    return shares


def over_homes(results: Results, method: str) -> Aggregated:
    """A method's share of savings over all homes; nothing where the folder does not say."""
    methods = results.aggregate.methods if results.aggregate else {}
    return methods.get(method, AggregateMethod()).share_of_savings


def homes_figure(results: Results) -> Figure:
    """A row a method: a mark a home, and the mean over all with its interval where the folder has it."""
    shares = shares_by_home(results)
    rows = method_rows(shares)
    figure = new_figure(9.2, rows_height(shares) + 0.25)
    axes = figure.add_subplot()
    for method, place in rows.places.items():
        by_home, found = shares[method], over_homes(results, method)
        for home, marker in _markers(results):
            share = by_home.get(home)
            if share is not None and share >= LOWEST:
                axes.plot(share, place + 0.16, marker, color=FAINT, alpha=0.75, ms=4.5, mew=0, zorder=3)
        _write_homes_below(axes, place, by_home, found.mean)
        _draw_mean(axes, place, found, look_of(method).colour)
        top = max([*by_home.values(), *(found.interval or ()), LOWEST])
        if found.mean is not None and top > LOWEST:
            write_value(axes, place, top, percent(found.mean))
    label_rows(axes, rows)
    axes.axvline(1.0, color=INK, lw=1.2, linestyle=look_of("optimum").line)
    axes.axvline(0.0, color=FAINT, lw=0.9)
    lowest = min(min(by_home.values()) for by_home in shares.values())
    axes.set_xlim(max(LOWEST, min(0.0, lowest)) - 0.03, 1.12)
    axes.xaxis.set_major_formatter(PercentFormatter(1.0, symbol="\u00a0%"))
    condition = at_equal_comfort(*results.finished.values())
    axes.set_xlabel(f"Share of savings: 0 % is no battery, 100 % perfect information, {condition}")
    _explain(figure, axes, results)
    return figure


def _markers(results: Results) -> Iterator[tuple[str, str]]:
    """Each home and its mark."""
    return zip(results.finished, cycle(_MARKERS), strict=False)


def _write_homes_below(axes: Axes, place: float, by_home: dict[str, float], mean: float | None) -> None:
    """What lies beyond the axis, in words: the homes there, and the mean if it lies there, too."""
    below = sorted(share for share in by_home.values() if share < LOWEST)
    if not below:
        return
    words = " to ".join(percent(share) for share in dict.fromkeys((below[0], below[-1])))
    if mean is not None and len(below) == len(by_home) > 1:
        words = f"{percent(mean)} ({words})"
    axes.text(LOWEST, place, f"◂ {words}", va="center", fontsize=7.5, color=FAINT)


def _draw_mean(axes: Axes, place: float, found: Aggregated, colour: str) -> None:
    if found.interval is not None:
        axes.hlines(place - 0.16, *found.interval, color=colour, linewidth=2.0, zorder=2)
    if found.mean is not None and found.mean >= LOWEST:
        axes.plot(found.mean, place - 0.16, "o", color=colour, markersize=6.5, mec="white", mew=0.7, zorder=4)


def _explain(figure: Figure, axes: Axes, results: Results) -> None:
    for name, marker in _markers(results):
        axes.plot([], [], marker, color=FAINT, markersize=4.5, mew=0, label=name)
    if results.aggregate is not None:
        axes.plot([], [], "o-", color=INK, lw=2.0, markersize=6.5, label="all homes, 95 % interval")
    figure.legend(loc="outside upper left", ncols=4)


def _words(results: Results) -> Words:
    shares = shares_by_home(results)
    means = {name: over_homes(results, name).mean for name in shares}
    overall = {name: "" if mean is None else f"{percent(mean)} over all, " for name, mean in means.items()}
    told = "; ".join(
        f"{name} {overall[name]}{', '.join(f'{home} {percent(share)}' for home, share in by_home.items())}"
        for name, by_home in shares.items()
    )
    coloured = (
        "The coloured mark and the number are the mean over all homes, the bar is its 95 % interval for "
        "other seeds on the same homes. "
    )
    return Words(
        "Share of savings on every home",
        f"Points of the share of savings: {told}.",
        f"One grey mark a home, the mean over its seeds. {coloured if any(overall.values()) else ''}"
        "Shares far below zero are written at the left edge.",
    )


SHARE_OF_SAVINGS = ReportFigure[Results, Results](
    name="share-of-savings",
    section=ReportSection("Home by home"),
    needs=lambda results: results if len(results.finished) > 1 and shares_by_home(results) else None,
    draw=homes_figure,
    words=_words,
)
