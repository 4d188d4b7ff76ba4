"""Panel (b): temperature deviation against demonstration length."""

from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, NullLocator

from hemma.report.drawing.canvas import PANEL_WIDTH, single
from hemma.report.drawing.lengths import Quantity, draw_by_length, told_by_length
from hemma.report.drawing.rows import FROM_ZERO, above_zero
from hemma.report.figures.figure import PANELS, HomeFigure, Words
from hemma.report.numbers import degrees, plain
from hemma.results.results import HomeResults

_TOTAL = Quantity(
    "Total temperature deviation (°C)",
    lambda metrics: metrics.total_temperature_deviation,
    lambda intervals: above_zero(intervals.total_temperature_deviation),
)


def draw_deviation_by_length(axes: Axes, home: HomeResults) -> None:
    """Total temperature deviation against demonstration length, linear below 1 degC."""
    axes.set_title("(b) Comfort and demonstrations")
    axes.set_yscale("symlog", linthresh=1.0)
    draw_by_length(axes, home, _TOTAL)
    if axes.axison:
        axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: plain(value)))
        axes.yaxis.set_minor_locator(NullLocator())
        axes.set_ylim(bottom=0.0)


def _words(home: HomeResults) -> Words:
    deviations = told_by_length(home, lambda mean: degrees(mean.total_temperature_deviation))
    return Words(
        "(b) Temperature deviation against demonstration length",
        f"Total temperature deviation by days of demonstrations: {deviations}.",
        "Sum over all slots of the distance from the comfort band. The axis is linear below 1 °C, "
        f"logarithmic above. {FROM_ZERO}",
    )


DEVIATION_BY_DEMONSTRATIONS = HomeFigure[HomeResults](
    name="deviation-by-demonstrations",
    section=PANELS,
    needs=lambda subject: subject.home,
    draw=lambda home: single(PANEL_WIDTH, 3.6, lambda axes: draw_deviation_by_length(axes, home)),
    words=_words,
    is_wide=False,
)
