"""Panel (a): energy cost against demonstration length."""

from matplotlib.axes import Axes

from hemma.report.drawing.canvas import PANEL_WIDTH, single
from hemma.report.drawing.lengths import Quantity, draw_by_length, told_by_length
from hemma.report.figures.figure import PANELS, HomeFigure, Words
from hemma.report.numbers import money
from hemma.results.results import HomeResults


def draw_cost_by_length(axes: Axes, home: HomeResults) -> None:
    """Total energy cost against demonstration length."""
    axes.set_title("(a) Energy cost and demonstrations")
    quantity = Quantity(
        f"Energy cost of the test period ({home.currency})",
        lambda metrics: metrics.energy_cost,
        lambda intervals: intervals.energy_cost,
    )
    draw_by_length(axes, home, quantity)


def _words(home: HomeResults) -> Words:
    costs = told_by_length(home, lambda mean: money(mean.energy_cost, home.currency))
    return Words(
        "(a) Energy cost against demonstration length",
        f"Energy cost by days of demonstrations: {costs}.",
        "What more days of demonstrations bring. Line: mean; whisker: 95 % interval; dot: one seed. "
        "Lines from edge to edge are methods that were not trained on several lengths; one so far off "
        "that it would flatten the rest is only named.",
    )


COST_BY_DEMONSTRATIONS = HomeFigure[HomeResults](
    name="cost-by-demonstrations",
    section=PANELS,
    needs=lambda subject: subject.home,
    draw=lambda home: single(PANEL_WIDTH, 3.6, lambda axes: draw_cost_by_length(axes, home)),
    words=_words,
    is_wide=False,
)
