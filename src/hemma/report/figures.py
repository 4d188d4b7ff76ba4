"""Every figure of a home: the six panels of the paper's results figure together and apart, and the rest."""

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hemma.report.canvas import Picture, drawing_style, new_figure, save
from hemma.report.captions import Words, words_of
from hemma.report.panels_demonstrations import draw_cost_by_length, draw_deviation_by_length
from hemma.report.panels_methods import draw_costs, draw_deviations
from hemma.report.panels_model import free_run_figure, read_curves, training_figure
from hemma.report.panels_time import (
    SHOWN_DAYS,
    Week,
    draw_battery_level,
    draw_generation,
    draw_grid_power,
    draw_indoor_temperature,
    read_week,
)
from hemma.report.results import HomeResults, Results
from hemma.report.series import FreeRun, SeriesReader, TrainingCurve

PANEL_WIDTH, FULL_WIDTH = 5.4, 9.2
"""Widths [inch] of half and whole figures."""


@dataclass(frozen=True)
class HomeSeries:
    """All series of a home that are drawn."""

    week: Week
    curves: dict[str, list[TrainingCurve]]
    free_run: FreeRun | None


@dataclass(frozen=True)
class HomePictures:
    """The figures of a home as they stand in the report."""

    panels: tuple[Picture, ...]
    """The six panels (a) to (f)."""
    powers: Picture
    training: Picture | None
    free_run: Picture | None


@dataclass(frozen=True)
class Shelf:
    """Where a home's figures go."""

    folder: Path
    prefix: str

    def save(self, figure: Figure, said: Words) -> Picture:
        """Write the figure as PNG and SVG under the name that goes with its words."""
        svg = save(figure, self.folder, f"{self.prefix}{said.name}")
        return Picture(svg=svg, title=said.title, alternative=said.alternative, caption=said.caption)


def read_series(reader: SeriesReader, name: str, home: HomeResults) -> HomeSeries:
    """Read all series of a home; every file that ``results.json`` names must exist, drawn or not."""
    methods = [*home.methods.values(), *home.data_efficiency]
    for run in (run for method in methods for run in method.runs):
        for path in filter(None, (run.schedule, run.curve)):
            reader.located(path)
    free_run = home.identification.free_run if home.identification else None
    return HomeSeries(
        week=read_week(reader, name, home),
        curves=read_curves(reader, home),
        free_run=reader.free_run(free_run) if free_run else None,
    )


def draw_all(folder: Path, results: Results) -> dict[str, HomePictures]:
    """Write the figures of all homes to ``folder``/figures as PNG and SVG; the pictures by home.

    One home: ``results.*`` (the six panels in one) and each panel under its own name. Several homes: the
    same with the home's name in front, and ``results.*`` is the combined figure of the first.
    """
    reader = SeriesReader(folder)
    series = {name: read_series(reader, name, home) for name, home in results.finished.items()}
    prefixes = _prefixes(series)
    with drawing_style():
        first = next(iter(series))
        if prefixes[first]:
            save(combined_figure(results.homes[first], series[first].week), folder / "figures", "results")
        return {
            name: _draw_home(Shelf(folder / "figures", prefixes[name]), home, series[name])
            for name, home in results.finished.items()
        }


def combined_figure(home: HomeResults, week: Week) -> Figure:
    """The six panels in one figure, for a README or a paper."""
    methods_height = _methods_height(home)
    heights = (3.1, methods_height, 2.6, 2.6)
    figure = new_figure(FULL_WIDTH, sum(heights))
    parts = figure.subfigures(3, 1, squeeze=False, height_ratios=(*heights[:2], sum(heights[2:])))
    upper, middle, lower = parts[:, 0]
    panels = [*upper.subplots(1, 2), *middle.subplots(1, 2), *lower.subplots(2, 1)]
    for axes, draw in zip(panels, _six(home, week), strict=True):
        draw(axes)
    panels[3].tick_params(labelleft=False)
    panels[4].set_xlabel("")
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


def _draw_home(shelf: Shelf, home: HomeResults, series: HomeSeries) -> HomePictures:
    words = words_of(home, series.week)
    save(combined_figure(home, series.week), shelf.folder, f"{shelf.prefix}results")
    training = training_figure(home, series.curves) if series.curves else None
    slots = round(SHOWN_DAYS * 24 / home.slot_length_h)
    free_run = free_run_figure(series.free_run, slots) if series.free_run else None
    return HomePictures(
        panels=_draw_panels(shelf, home, series.week),
        powers=shelf.save(_powers_figure(home, series.week), words.powers),
        training=shelf.save(training, words.training) if training else None,
        free_run=shelf.save(free_run, words.free_run) if free_run else None,
    )


def _draw_panels(shelf: Shelf, home: HomeResults, week: Week) -> tuple[Picture, ...]:
    height = _methods_height(home)
    sizes = [(PANEL_WIDTH, 3.4)] * 2 + [(PANEL_WIDTH, height)] * 2 + [(FULL_WIDTH, 2.9)] * 2
    pictures = []
    for size, draw, said in zip(sizes, _six(home, week), words_of(home, week).panels, strict=True):
        figure = new_figure(*size)
        draw(figure.add_subplot())
        pictures.append(shelf.save(figure, said))
    return tuple(pictures)


def _powers_figure(home: HomeResults, week: Week) -> Figure:
    figure = new_figure(FULL_WIDTH, 5.0)
    above, below = figure.subplots(2, 1)
    draw_generation(above, home, week)
    draw_grid_power(below, home, week)
    above.set_xlabel("")
    return figure


def _methods_height(home: HomeResults) -> float:
    return 1.15 + 0.2 * max(5, len(home.methods))


def _prefixes(homes: Iterable[str]) -> dict[str, str]:
    """What stands before a home's file names: nothing for one home, else its name made safe and unique."""
    names = list(homes)
    if len(names) == 1:
        return {names[0]: ""}
    safe = [re.sub(r"[^\w.-]+", "_", name).lstrip(".") or "home" for name in names]
    return {
        name: f"{text}-" if safe.count(text) == 1 else f"{text}-{number}-"
        for number, (name, text) in enumerate(zip(names, safe, strict=True), start=1)
    }
