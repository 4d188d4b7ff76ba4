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
from hemma.results.findings import Aggregated
from hemma.results.results import Results

LOWEST = -0.5
"""A share below this is drawn at the edge as an arrow: it would flatten all others."""
_MARKERS = "os^DvPX*"


def shares_by_home(results: Results) -> dict[str, dict[str, float]]:
    """Mean share of savings by method and home, where there is one."""
    names = dict.fromkeys(name for home in results.finished.values() for name in home.methods)
    return {
        name: {
            title: share
            for title, home in results.finished.items()
            if name in home.methods and (share := home.methods[name].mean.share_of_savings) is not None
        }
        for name in names
    }


def over_homes(results: Results, method: str) -> Aggregated:
    """A method's share of savings over all homes; nothing where the folder does not say."""
    aggregate = results.aggregate
    if aggregate is None or method not in aggregate.methods:
        return Aggregated()
    return aggregate.methods[method].share_of_savings


def homes_figure(results: Results) -> Figure:
    """A row a method: a mark a home, and the mean over all with its interval where the folder has it."""
    shares = {name: by_home for name, by_home in shares_by_home(results).items() if by_home}
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
    told = []
    for name, by_home in shares_by_home(results).items():
        mean = over_homes(results, name).mean
        overall = "" if mean is None else f"{percent(mean)} over all, "
        if by_home:
            told.append(f"{name} {overall}{', '.join(f'{home} {percent(s)}' for home, s in by_home.items())}")
    has_mean = any(over_homes(results, name).mean is not None for name in shares_by_home(results))
    coloured = (
        "The coloured mark and the number are the mean over all homes, the bar is its 95 % interval for "
        "other seeds on the same homes. "
    )
    return Words(
        "Share of savings on every home",
        f"Points of the share of savings: {'; '.join(told)}.",
        f"One grey mark a home, the mean over its seeds. {coloured if has_mean else ''}Shares far below zero "
        "are written at the left edge.",
    )


SHARE_OF_SAVINGS = ReportFigure[Results, Results](
    name="share-of-savings",
    section=ReportSection("Home by home"),
    needs=lambda it: it if len(it.finished) > 1 and any(shares_by_home(it).values()) else None,
    draw=homes_figure,
    words=_words,
)
