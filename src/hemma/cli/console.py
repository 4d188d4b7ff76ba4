"""What people see: progress and messages on standard error, results on standard output."""

import json
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

if TYPE_CHECKING:
    from hemma.results.progress import Progress

INTERRUPTED = 130
"""Exit status after Ctrl-C, as shells have it."""
SILENCE = 10.0
"""Seconds between two lines of a stage where there is no terminal."""
WIDTH = 120
"""Characters of a line that does not go to a terminal."""
COLUMNS = ("Seeds", "Energy cost", "Mean deviation", "Gap to optimum", "Share of savings", "Training time")


@contextmanager
def going_on_later() -> Iterator[None]:
    """Ctrl-C inside ends the program with a word on how to go on."""
    try:
        yield
    except KeyboardInterrupt as interrupt:
        typer.echo("\nhemma: kept what was finished; run the same command to go on", err=True)
        raise typer.Exit(INTERRUPTED) from interrupt


@contextmanager
def show_progress() -> "Iterator[Progress]":
    """Bars on a terminal, plain lines anywhere else."""
    if not sys.stderr.isatty():
        yield PlainLines()
        return
    from hemma.cli.bars import show_bars

    with show_bars() as bars:
        yield bars


class PlainLines:
    """One line at the start of a stage, one every ten seconds, one at its end: for pipes and log files."""

    def __init__(self):
        self._total = 1
        self._spoke = 0.0

    def started(self, stage: str, total: int) -> None:
        """The stage begins."""
        self._total, self._spoke = total, time.monotonic()
        typer.echo(f"{stage} ...", err=True)

    def advanced(self, stage: str, done: int, message: str) -> None:
        """A line when the last one is ten seconds ago."""
        if time.monotonic() - self._spoke >= SILENCE:
            self._spoke = time.monotonic()
            typer.echo(f"{stage}: {done} of {self._total}. {message}".rstrip(". "), err=True)

    def finished(self, stage: str, message: str) -> None:
        """The stage is over."""
        typer.echo(f"{stage}: {message}", err=True)

    def reused(self, stage: str, message: str) -> None:
        """The stage was not run."""
        typer.echo(f"{stage}: kept from an earlier run, {message}", err=True)

    def noticed(self, message: str) -> None:
        """Something to know."""
        typer.echo(f"note: {message}", err=True)


def print_json(content: Any) -> None:
    """Results for programs."""
    typer.echo(json.dumps(content, indent=1, allow_nan=False, ensure_ascii=False))


def show_results(folder: Path, content: Any) -> None:
    """Results for people, as far as they go, and where the rest lies."""
    homes = content["homes"]
    if any(home["methods"] for home in homes.values()):
        print_table(folder)
    else:
        for name, home in homes.items():
            errors = home["identification"]["rmse_c"].items()
            typer.echo(f"{name}: free-run error " + ", ".join(f"{h}: {e:.2g} °C" for h, e in errors))
    print_recommendations(content)
    report = folder / "report.html"
    typer.echo(f"Results: {folder / 'results.json'}")
    if report.is_file():
        typer.echo(f"Report: {report}")


def print_recommendations(content: Any) -> None:
    """Which controller each home should have, where that was judged."""
    from rich.console import Console
    from rich.table import Table

    from hemma.report.tables.recommendation import HEADINGS, recommendation_rows, recommendation_sentence
    from hemma.results.results import HomeResults

    console = Console(width=None if sys.stdout.isatty() else WIDTH)
    for name, entry in content["homes"].items():
        if not entry.get("recommendation"):
            continue
        home = HomeResults.model_validate(entry)
        first, *others = HEADINGS
        table = Table(first, title=f"{name}: judged on training days alone")
        for heading in others:
            table.add_column(heading, justify="right")
        for cells in recommendation_rows(home):
            table.add_row(*cells)
        console.print(table)
        typer.echo(recommendation_sentence(name, home))


def print_table(folder: Path) -> None:
    """The main columns of the results, home by home, then over all homes; the report has all of them."""
    from rich.console import Console
    from rich.table import Table

    from hemma.cli.aggregate import print_aggregate
    from hemma.report import results_table
    from hemma.results.results import load_results

    console = Console(width=None if sys.stdout.isatty() else WIDTH)
    results = load_results(folder)
    rows = results_table(results)
    for home in dict.fromkeys(row.home for row in rows):
        table = Table("Method", title=f"{home}: mean of the runs, and its 95 % interval")
        for heading in COLUMNS:
            table.add_column(heading, justify="right")
        for row in rows:
            if row.home == home:
                cells = [row.under(heading) for heading in COLUMNS]
                table.add_row(row.method, *(f"{cell.value}\n{cell.detail}".strip() for cell in cells))
        console.print(table)
    print_aggregate(console, results)
