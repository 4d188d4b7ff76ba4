"""A home of a results folder with all series that are drawn."""

from dataclasses import dataclass

from hemma.report.methods import in_order
from hemma.report.series import FreeRun, SeriesReader, TrainingCurve
from hemma.report.week import Week, read_week
from hemma.results.results import HomeResults

Curves = dict[str, list[TrainingCurve]]
"""The training curves of a home by method; methods without any are left out."""


@dataclass(frozen=True)
class HomeSubject:
    """What the figures of a home are drawn from."""

    home: HomeResults
    week: Week
    curves: Curves
    free_run: FreeRun | None


def read_subject(reader: SeriesReader, name: str, home: HomeResults, week: int = 1) -> HomeSubject:
    """Read all series of a home; every file that ``results.json`` names must exist, drawn or not."""
    methods = [*home.methods.values(), *home.data_efficiency]
    for run in (run for method in methods for run in method.runs):
        for path in filter(None, (run.schedule, run.curve)):
            reader.located(path)
    runs = {method: home.methods[method].runs for method in in_order(home.methods)}
    paths = {method: [run.curve for run in ran if run.curve] for method, ran in runs.items()}
    free_run = home.identification.free_run if home.identification else None
    return HomeSubject(
        home=home,
        week=read_week(reader, name, home, week),
        curves={method: [reader.curve(path) for path in found] for method, found in paths.items() if found},
        free_run=reader.free_run(free_run) if free_run else None,
    )
