"""Every figure of a results folder: drawn, written to the disk, and handed on with its words."""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from matplotlib.figure import Figure

from hemma.report.drawing.canvas import Picture, drawing_style, save
from hemma.report.figures.captions import Words, words_of_panels, words_of_powers, words_of_traces
from hemma.report.figures.captions_comparisons import (
    words_of_diagnostics,
    words_of_free_run,
    words_of_homes,
    words_of_improvement,
    words_of_learning,
    words_of_pareto,
    words_of_regret,
)
from hemma.report.figures.panels_curves import Curves, learning_figure, read_curves
from hemma.report.figures.panels_diagnostics import diagnostics_figure, diagnostics_of
from hemma.report.figures.panels_homes import homes_figure, shares_by_home
from hemma.report.figures.panels_improvement import comparison_of, improvement_figure
from hemma.report.figures.panels_model import free_run_figure
from hemma.report.figures.panels_pareto import pareto_figure, standings, sweeps_of
from hemma.report.figures.panels_regret import regret_figure
from hemma.report.figures.panels_traces import traces_figure
from hemma.report.figures.six_panels import combined_figure, powers_figure, separate_panels
from hemma.report.series import FreeRun, SeriesReader
from hemma.report.week import WEEK_DAYS, Week, read_week
from hemma.results.results import HomeResults, Results

NOT_LEARNED = ("MPC forecast", "thresholds")
"""What the learned methods are compared with, run by run, beside each other."""


@dataclass(frozen=True)
class HomeSeries:
    """All series of a home that are drawn."""

    week: Week
    curves: Curves
    free_run: FreeRun | None


@dataclass(frozen=True)
class HomePictures:
    """The figures of a home as they stand in the report; None where the folder has nothing to draw."""

    panels: tuple[Picture, ...]
    """The six panels (a) to (f)."""
    powers: Picture
    traces: Picture | None
    pareto: Picture | None
    regret: Picture | None
    improvement: Picture | None
    learning: Picture | None
    diagnostics: Picture | None
    free_run: Picture | None


@dataclass(frozen=True)
class Pictures:
    """All figures of the report."""

    homes: dict[str, HomePictures]
    shares: Picture | None
    """Share of savings over homes; None for one home."""
    improvement: Picture | None
    """Probabilities of improvement over homes."""


@dataclass(frozen=True)
class Shelf:
    """Where a home's figures go."""

    folder: Path
    prefix: str

    def save(self, figure: Figure, said: Words) -> Picture:
        """Write the figure as PNG and SVG under the name that goes with its words."""
        svg = save(figure, self.folder, f"{self.prefix}{said.name}")
        return Picture(svg=svg, title=said.title, alternative=said.alternative, caption=said.caption)


def read_series(reader: SeriesReader, name: str, home: HomeResults, week: int = 1) -> HomeSeries:
    """Read all series of a home; every file that ``results.json`` names must exist, drawn or not."""
    methods = [*home.methods.values(), *home.data_efficiency]
    for run in (run for method in methods for run in method.runs):
        for path in filter(None, (run.schedule, run.curve)):
            reader.located(path)
    free_run = home.identification.free_run if home.identification else None
    return HomeSeries(
        week=read_week(reader, name, home, week),
        curves=read_curves(reader, home),
        free_run=reader.free_run(free_run) if free_run else None,
    )


def draw_all(folder: Path, results: Results, week: int = 1) -> Pictures:
    """Write the figures of all homes to ``folder``/figures as PNG and SVG; the pictures by home.

    One home: ``results.*`` (the six panels in one) and each figure under its own name. Several homes: the
    same with the home's name in front, ``results.*`` is the combined figure of the first, and the figures
    over homes have no home's name. ``week`` counts the weeks of the test period from 1.
    """
    reader = SeriesReader(folder)
    series = {name: read_series(reader, name, home, week) for name, home in results.finished.items()}
    prefixes = _prefixes(series)
    figures = folder / "figures"
    with drawing_style():
        first = next(iter(series))
        if prefixes[first]:
            save(combined_figure(results.homes[first], series[first].week), figures, "results")
        over_homes = Shelf(figures, "homes-")
        return Pictures(
            homes={
                name: _draw_home(Shelf(figures, prefixes[name]), home, series[name])
                for name, home in results.finished.items()
            },
            shares=_shares(over_homes, results),
            improvement=_improvement_over_homes(over_homes, results),
        )


def _draw_home(shelf: Shelf, home: HomeResults, series: HomeSeries) -> HomePictures:
    week, curves = series.week, series.curves
    save(combined_figure(home, week), shelf.folder, f"{shelf.prefix}results")
    panels = zip(separate_panels(home, week), words_of_panels(home, week), strict=True)
    return HomePictures(
        panels=tuple(shelf.save(figure, said) for figure, said in panels),
        powers=shelf.save(powers_figure(home, week), words_of_powers(week)),
        traces=shelf.save(traces_figure(home, week), words_of_traces(home, week)) if week.schedules else None,
        pareto=_pareto(shelf, home),
        regret=shelf.save(regret_figure(home), words_of_regret(home)) if home.regret else None,
        improvement=_improvement(shelf, home),
        learning=_learning(shelf, home, curves),
        diagnostics=_diagnostics(shelf, curves),
        free_run=_free_run(shelf, home, series.free_run),
    )


def _pareto(shelf: Shelf, home: HomeResults) -> Picture | None:
    has_both = sweeps_of(home) and standings(home)
    return shelf.save(pareto_figure(home), words_of_pareto(home)) if has_both else None


def _improvement(shelf: Shelf, home: HomeResults) -> Picture | None:
    comparison = comparison_of(home.probability_of_improvement, _compared(home))
    if not comparison.methods:
        return None
    return shelf.save(improvement_figure(comparison), words_of_improvement(comparison, "of this home"))


def _compared(home: HomeResults) -> set[str]:
    """The learned methods and two others: what knows nothing by chance either beats another or does not."""
    learned = {name for name, method in home.methods.items() if method.is_learned}
    return learned | set(NOT_LEARNED) if learned else set()


def _learning(shelf: Shelf, home: HomeResults, curves: Curves) -> Picture | None:
    figure = learning_figure(home, curves)
    return shelf.save(figure, words_of_learning(home, curves)) if figure else None


def _diagnostics(shelf: Shelf, curves: Curves) -> Picture | None:
    figure = diagnostics_figure(curves)
    names = [f"{diagnostic.title.lower()}" for diagnostic in diagnostics_of(curves)]
    return shelf.save(figure, words_of_diagnostics(names)) if figure else None


def _free_run(shelf: Shelf, home: HomeResults, run: FreeRun | None) -> Picture | None:
    slots = round(WEEK_DAYS * 24 / home.slot_length_h)
    return shelf.save(free_run_figure(run, slots), words_of_free_run()) if run else None


def _shares(shelf: Shelf, results: Results) -> Picture | None:
    has_shares = len(results.finished) > 1 and any(shares_by_home(results).values())
    return shelf.save(homes_figure(results), words_of_homes(results)) if has_shares else None


def _improvement_over_homes(shelf: Shelf, results: Results) -> Picture | None:
    if results.aggregate is None:
        return None
    compared = set().union(*(_compared(home) for home in results.finished.values()))
    comparison = comparison_of(results.aggregate.probability_of_improvement, compared)
    if not comparison.methods:
        return None
    return shelf.save(improvement_figure(comparison), words_of_improvement(comparison, "on the same home"))


def _prefixes(homes: Iterable[str]) -> dict[str, str]:
    """What stands before a home's file names: nothing for one home, else its name made safe and unique."""
    names = list(homes)
    if len(names) == 1:
        return {names[0]: ""}
    safe = [re.sub(r"[^\w.-]+", "_", name).lstrip(".") or "home" for name in names]
    return {
        name: f"{text}-" if safe.count(text) == 1 and text != "homes" else f"{text}-{number}-"
        for number, (name, text) in enumerate(zip(names, safe, strict=True), start=1)
    }
