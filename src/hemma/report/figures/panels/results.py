"""The six panels (a) to (f) in one figure, for a README or a paper; it is no part of the page."""

from matplotlib.figure import Figure

from hemma.report.drawing.canvas import FULL_WIDTH, new_figure
from hemma.report.drawing.rows import rows_height
from hemma.report.figures.figure import HomeFigure, Words
from hemma.report.figures.panels.demonstrations import draw_cost_by_length, draw_deviation_by_length
from hemma.report.figures.panels.methods import draw_costs, draw_deviations
from hemma.report.figures.panels.week import draw_battery_level, draw_indoor_temperature
from hemma.report.subject import HomeSubject


def results_figure(subject: HomeSubject) -> Figure:
    """Demonstrations above, methods in the middle, the week below."""
    home, week = subject.home, subject.week
    heights = (3.4, rows_height(home.methods), 2.6, 2.6)
    figure = new_figure(FULL_WIDTH, sum(heights))
    parts = figure.subfigures(3, 1, squeeze=False, height_ratios=(*heights[:2], sum(heights[2:])))
    upper, middle, lower = parts[:, 0]
    a, b = upper.subplots(1, 2)
    c, d = middle.subplots(1, 2)
    e, f = lower.subplots(2, 1)
    draw_cost_by_length(a, home)
    draw_deviation_by_length(b, home)
    draw_costs(c, home)
    draw_deviations(d, home)
    draw_indoor_temperature(e, home, week)
    draw_battery_level(f, home, week)
    d.tick_params(labelleft=False)
    e.set_xlabel("")
    return figure


RESULTS = HomeFigure[HomeSubject](
    name="results",
    section=None,
    needs=lambda subject: subject,
    draw=results_figure,
    words=lambda subject: Words("Results", "The six panels (a) to (f).", ""),
)
