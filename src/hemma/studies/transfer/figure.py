"""What each method keeps of the savings in each changed home, and at what comfort."""

from itertools import cycle

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import PercentFormatter

from hemma.methods.looks import BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILLION, Look
from hemma.report.drawing.canvas import FAINT, GRID, INK, new_figure
from hemma.report.drawing.rows import above_zero
from hemma.report.numbers import percent
from hemma.results.records import MethodRuns
from hemma.studies.transfer.records import Transfer

LOWEST = -0.25
"""A share below this is written at the edge: it would flatten all others."""
STEP = 0.12
"""Distance of two methods of one home, in rows."""
_COLOURS = (BLUE, SKY, PURPLE, GREEN, GREY, ORANGE, VERMILLION)
_LOOKS = tuple(Look(colour, marker=marker) for colour, marker in zip(_COLOURS, "os^vDXP", strict=True))


def transfer_figure(transfer: Transfer) -> Figure:
    """A row a home, a mark a method: the mean and its 95 % interval."""
    figure = new_figure(9.2, 1.2 + 0.72 * len(transfer.places))
    left, right = figure.subplots(1, 2, sharey=True, width_ratios=(2.2, 1.0))
    looks = dict(zip(transfer.methods, cycle(_LOOKS), strict=False))
    for row, place in enumerate(transfer.places.values()):
        for number, (name, look) in enumerate(looks.items()):
            if name in place.methods:
                shift = STEP * (number - (len(looks) - 1) / 2)
                _draw_share(left, row + shift, place.methods[name], look)
                _draw_deviation(right, row + shift, place.methods[name], look)
        left.axhline(row + 0.5, color=GRID, lw=0.8)
        right.axhline(row + 0.5, color=GRID, lw=0.8)
    for axes in (left, right):
        axes.tick_params(axis="y", length=0)
        axes.grid(axis="y", visible=False)
    left.set_yticks(range(len(transfer.places)), list(transfer.places))
    left.set_ylim(len(transfer.places) - 0.5, -0.5)
    left.axvline(1.0, color=INK, lw=1.0, linestyle=":")
    left.axvline(0.0, color=FAINT, lw=0.9)
    left.set_xlim(LOWEST, 1.04)
    left.xaxis.set_major_formatter(PercentFormatter(1.0, symbol="\u00a0%"))
    left.set_xlabel("Share of savings at the same deviation")
    right.set_xlim(left=0.0)
    right.set_xlabel("Mean deviation from comfort (°C)")
    for name, look in looks.items():
        left.plot([], [], look.marker, color=look.colour, markersize=5.5, label=name)
    figure.legend(loc="outside upper left", ncols=4)
    return figure


def _draw_share(axes: Axes, place: float, method: MethodRuns, look: Look) -> None:
    share = method.mean.share_of_savings
    if share is not None and share < LOWEST:
        axes.text(LOWEST, place, f"◂ {percent(share)}", va="center", fontsize=6.5, color=look.colour)
    elif share is not None:
        _mark(axes, place, share, method.interval.share_of_savings, look)


def _draw_deviation(axes: Axes, place: float, method: MethodRuns, look: Look) -> None:
    deviation = method.mean.mean_temperature_deviation
    if deviation is not None:
        _mark(axes, place, deviation, above_zero(method.interval.mean_temperature_deviation), look)


def _mark(axes: Axes, place: float, mean: float, interval: tuple[float, float] | None, look: Look) -> None:
    if interval is not None:
        axes.hlines(place, *interval, color=look.colour, linewidth=1.4, alpha=0.8, zorder=2)
    axes.plot(mean, place, look.marker, color=look.colour, markersize=5.0, mec="white", mew=0.5, zorder=3)
