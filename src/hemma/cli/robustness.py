"""``hemma robustness``: what is left of each method when things go wrong."""

from pathlib import Path
from typing import Annotated, Any

import typer

from hemma.cli.console import going_on_later, print_json, results_console, ruled, say, show_progress, typed
from hemma.cli.experiment import (
    OUT,
    Home,
    Homes,
    Json,
    Out,
    Quick,
    Request,
    Seeds,
    Settings,
    TestFrom,
    Traces,
    job_of,
)
from hemma.cli.files import path_argument
from hemma.cli.homes import chosen_homes

Every = Annotated[bool, typer.Option("--every", help="Every method in the table that is printed.")]
Filled = Annotated[
    Path | None,
    path_argument(
        "[RESULTS]",
        "A results folder: measure what it holds, with its own settings and homes, and train nothing.",
        False,
    ),
]
PRINTED = ("HA-1", "PPO", "default", "MPC forecast", "thresholds", "Rule")
"""What a terminal has room for; the file has all."""


def robustness(  # noqa: PLR0913
    folder: Filled = None,
    traces: Traces = None,
    home: Home = None,
    homes: Homes = None,
    test_from: TestFrom = None,
    settings: Settings = None,
    out: Out = OUT,
    seeds: Seeds = None,
    quick: Quick = False,
    every: Every = False,
    json: Json = False,
) -> None:
    """Measure all methods again under faults: of sensors, building, battery, prices, household."""
    request = Request(traces, chosen_homes(home, homes), test_from, settings, out, seeds, quick)
    from hemma.results.reading import json_content

    with going_on_later():
        content = _trained(request) if folder is None else _as_it_is(folder, request)
    if json:
        print_json(json_content(content))
    else:
        _print_table(out if folder is None else folder, every)


def _trained(request: Request) -> Any:
    """What was asked for; trains what the folder does not hold yet."""
    from hemma.studies.robustness.run import run_faults

    job = job_of(request)
    with show_progress() as progress:
        return run_faults(job, progress)


def _as_it_is(folder: Path, request: Request) -> Any:
    """What the folder holds."""
    from hemma.errors import HemmaError
    from hemma.studies.robustness.run import run_stored_faults

    if request != Request(request.traces, (), None, None, OUT, None, False):
        raise HemmaError(
            f"expected a results folder or options, got {folder} and options; a folder brings its own homes, "
            "settings and seeds: leave out all but --traces, or name the folder with --out to train in it"
        )
    with show_progress() as progress:
        return run_stored_faults(folder, request.traces, typed(), progress)


def _print_table(folder: Path, every: bool) -> None:
    from hemma.report.numbers import fine, percent
    from hemma.studies.robustness.records import ROBUSTNESS_FILE, load_robustness
    from hemma.studies.robustness.report import TABLE_FILE, met, shown

    found = load_robustness(folder)
    methods = [name for name in shown(found) if every or name in PRINTED]
    table = ruled("Share of savings at the same deviation, mean deviation in °C", ("Fault", *methods))
    table.pad_edge, table.columns[0].min_width = False, len("controllers")
    for fault in found.faults:
        cells = [met(found, fault, name) for name in methods]
        table.add_row(fault, *(f"{percent(one.share)}\n{fine(one.deviation)}" for one in cells))
    results_console().print(table)
    say(f"Results: {folder / ROBUSTNESS_FILE}")
    say(f"Table: {folder / TABLE_FILE}")
    say(f"Figure: {folder / 'figures' / 'robustness.png'}")
