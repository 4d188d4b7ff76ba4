"""``hemma robustness``: what is left of each method when things go wrong."""

from pathlib import Path
from typing import Annotated

import typer

from hemma.cli.compilation import keep_compiled_code
from hemma.cli.console import going_on_later, print_json, show_progress
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
from hemma.cli.homes import chosen_homes

Every = Annotated[bool, typer.Option("--every", help="Every method in the table that is printed.")]
PRINTED = ("HA-1", "PPO", "default", "MPC forecast", "thresholds", "Rule")
"""What a terminal has room for; the file has all."""


def register(app: typer.Typer) -> None:
    """Add the command to ``app``."""
    app.command()(robustness)


def robustness(  # noqa: PLR0913
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
    with going_on_later():
        from hemma.experiment.fault_run import run_faults

        request = Request(traces, chosen_homes(home, homes), test_from, settings, out, seeds, quick)
        job = job_of(request)
        keep_compiled_code()
        with show_progress() as progress:
            content = run_faults(job, progress)
    if json:
        print_json(content)
    else:
        _print_table(out, every)


def _print_table(folder: Path, every: bool) -> None:
    from rich.console import Console
    from rich.table import Table

    from hemma.report.numbers import fine, percent
    from hemma.report.robustness import TABLE_FILE, met, shown
    from hemma.report.robustness_results import ROBUSTNESS_FILE, load_robustness

    found = load_robustness(folder)
    methods = [name for name in shown(found) if every or name in PRINTED]
    table = Table("Fault", title="Share of savings at equal comfort, mean deviation in °C")
    for name in methods:
        table.add_column(name, justify="right")
    for fault in found.faults:
        cells = [met(found, fault, name) for name in methods]
        table.add_row(fault, *(f"{percent(one.share)}\n{fine(one.deviation)}" for one in cells))
    Console().print(table)
    typer.echo(f"Results: {folder / ROBUSTNESS_FILE}")
    typer.echo(f"Table: {folder / TABLE_FILE}")
    typer.echo(f"Figure: {folder / 'figures' / 'robustness.png'}")
