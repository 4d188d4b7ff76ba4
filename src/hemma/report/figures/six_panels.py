"""The six panels of the paper's results figure, together and apart, and the week's powers."""

from collections.abc import Callable, Iterator

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hemma.report.drawing.canvas import new_figure
from hemma.report.drawing.rows import rows_height
from hemma.report.figures.panels_demonstrations import draw_cost_by_length, draw_deviation_by_length
from hemma.report.figures.panels_methods import draw_costs, draw_deviations
from hemma.report.figures.panels_time import (
    draw_battery_level,
    draw_generation,
    draw_grid_power,
    draw_indoor_temperature,
)
from hemma.report.week import Week
from hemma.results.results import HomeResults

PANEL_WIDTH, FULL_WIDTH = 5.4, 9.2
"""Widths [inch] of half and whole figures."""


def combined_figure(home: HomeResults, week: Week) -> Figure:
    """The six panels in one figure, for a README or a paper."""
    heights = (3.4, rows_height(home.methods), 2.6, 2.6)
    figure = new_figure(FULL_WIDTH, sum(heights))
    parts = figure.subfigures(3, 1, squeeze=False, height_ratios=(*heights[:2], sum(heights[2:])))
    upper, middle, lower = parts[:, 0]
    panels = [*upper.subplots(1, 2), *middle.subplots(1, 2), *lower.subplots(2, 1)]
    for axes, draw in zip(panels, _six(home, week), strict=True):
        draw(axes)
    panels[3].tick_params(labelleft=False)
    panels[4].set_xlabel("")
    return figure


def separate_panels(home: HomeResults, week: Week) -> Iterator[Figure]:
    """Each panel as a figure of its own, in their order."""
    height = rows_height(home.methods)
    sizes = [(PANEL_WIDTH, 3.6)] * 2 + [(PANEL_WIDTH, height)] * 2 + [(FULL_WIDTH, 2.9)] * 2
    for size, draw in zip(sizes, _six(home, week), strict=True):
        figure = new_figure(*size)
        draw(figure.add_subplot())
        yield figure


def powers_figure(home: HomeResults, week: Week) -> Figure:
    """PV generation and load above, grid power below."""
    figure = new_figure(FULL_WIDTH, 5.0)
    above, below = figure.subplots(2, 1)
    draw_generation(above, home, week)
    draw_grid_power(below, home, week)
    above.set_xlabel("")
    return figure


def _six(home: HomeResults, week: Week) -> tuple[Callable[[Axes], None], ...]:
    return (
        lambda axes: draw_cost_by_length(axes, home),
        lambda axes: draw_deviation_by_length(axes, home),
        lambda axes: draw_costs(axes, home),
        lambda axes: draw_deviations(axes, home),
        lambda axes: draw_indoor_temperature(axes, home, week),
        lambda axes: draw_battery_level(axes, home, week),
    )
