"""What each method keeps of the savings in each changed home, and at what comfort."""

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
_LOOKS = (
    Look(BLUE, "-", "o"),
    Look(SKY, "-", "s"),
    Look(PURPLE, "-", "^"),
    Look(GREEN, "-", "v"),
    Look(GREY, "-", "D"),
    Look(ORANGE, "-", "X"),
    Look(VERMILLION, "-", "P"),
)


def transfer_figure(transfer: Transfer) -> Figure:
    """A row a home, a mark a method: the mean and its 95 % interval."""
    figure = new_figure(9.2, 1.2 + 0.72 * len(transfer.places))
    left, right = figure.subplots(1, 2, sharey=True, width_ratios=(2.2, 1.0))
    for row, place in enumerate(transfer.places.values()):
        for number, name in enumerate(transfer.methods):
            if name in place.methods:
                _draw(
                    left,
                    right,
                    row + STEP * (number - (len(transfer.methods) - 1) / 2),
                    place.methods[name],
                    _look(number),
                )
        for axes in (left, right):
            axes.axhline(row + 0.5, color=GRID, lw=0.8)
    left.set_yticks(range(len(transfer.places)), list(transfer.places))
    left.set_ylim(len(transfer.places) - 0.5, -0.5)
    for axes in (left, right):
        axes.tick_params(axis="y", length=0)
        axes.grid(axis="y", visible=False)
    left.axvline(1.0, color=INK, lw=1.0, linestyle=":")
    left.axvline(0.0, color=FAINT, lw=0.9)
    left.set_xlim(LOWEST, 1.04)
    left.xaxis.set_major_formatter(PercentFormatter(1.0, symbol="\u00a0%"))
    left.set_xlabel("Share of savings at the same deviation")
    right.set_xlim(left=0.0)
    right.set_xlabel("Mean deviation from comfort (°C)")
    for number, name in enumerate(transfer.methods):
        look = _look(number)
        left.plot([], [], look.marker, color=look.colour, markersize=5.5, label=name)
    figure.legend(loc="outside upper left", ncols=4)
    return figure


def _look(number: int) -> Look:
    return _LOOKS[number % len(_LOOKS)]


def _draw(left: Axes, right: Axes, place: float, method: MethodRuns, look: Look) -> None:
    share, deviation = method.mean.share_of_savings, method.mean.mean_temperature_deviation
    if share is not None and share < LOWEST:
        left.text(LOWEST, place, f"◂ {percent(share)}", va="center", fontsize=6.5, color=look.colour)
    elif share is not None:
        _mark(left, place, share, method.interval.share_of_savings, look)
    if deviation is not None:
        _mark(right, place, deviation, above_zero(method.interval.mean_temperature_deviation), look)


def _mark(axes: Axes, place: float, mean: float, interval: tuple[float, float] | None, look: Look) -> None:
    if interval is not None:
        axes.hlines(place, *interval, color=look.colour, linewidth=1.4, alpha=0.8, zorder=2)
    axes.plot(mean, place, look.marker, color=look.colour, markersize=5.0, mec="white", mew=0.5, zorder=3)
