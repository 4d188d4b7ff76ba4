"""What people see: progress and messages on standard error, results on standard output."""

import json
import shlex
import sys
import time
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager, redirect_stdout
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from hemma.cli.compilation import keep_compiled_code

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

    from hemma.report.tables.cells import Cell
    from hemma.results.progress import Progress

INTERRUPTED = 130
"""Exit status after Ctrl-C, as shells have it."""
SILENCE = 10.0
"""Seconds between two lines of a stage where there is no terminal."""
WIDTH = 120
"""Characters of a line that does not go to a terminal."""
COLUMNS = ("Seeds", "Energy cost", "Mean deviation", "Gap to optimum", "Share of savings", "Training time")


def say(line: object) -> None:
    """A line of results."""
    sys.stdout.write(f"{line}\n")


def tell(message: str) -> None:
    """A message to whoever watches."""
    sys.stderr.write(f"{message}\n")


def results_console() -> "Console":
    """For tables on standard output; whatever stands in a name, it is no markup."""
    from rich.console import Console

    width = None if sys.stdout.isatty() else WIDTH
    return Console(width=width, markup=False, emoji=False, highlight=False)


def ruled(title: str, headings: Sequence[str], left: int = 1) -> "Table":
    """A table without rows; columns after the first ``left`` hold numbers."""
    from rich.table import Table

    table = Table(*headings[:left], title=title)
    for heading in headings[left:]:
        table.add_column(heading, justify="right")
    return table


def grouped(table: "Table", rows: Iterable[Sequence[str]]) -> "Table":
    """``table`` with ``rows``; those that follow each other with the same first cell are one group."""
    last = ""
    for first, *others in rows:
        if last and first != last:
            table.add_section()
        table.add_row("" if first == last else first, *others)
        last = first
    return table


def in_cell(cell: "Cell") -> str:
    """Value and detail of a report's cell, one below the other."""
    return f"{cell.value}\n{cell.detail}".strip()


@contextmanager
def going_on_later() -> Iterator[None]:
    """Ctrl-C inside ends the program with a word on how to go on."""
    try:
        yield
    except KeyboardInterrupt as interrupt:
        tell("\nhemma: kept what was finished; run the same command to go on")
        raise typer.Exit(INTERRUPTED) from interrupt


def typed() -> str:
    """The command as it was typed."""
    return shlex.join(["hemma", *sys.argv[1:]])


@contextmanager
def show_progress() -> "Iterator[Progress]":
    """Bars on a terminal, plain lines anywhere else; what a library prints meanwhile is no result.

    Work begins here, so compiled code is kept from here on.
    """
    keep_compiled_code()
    if not sys.stderr.isatty():
        with redirect_stdout(sys.stderr):
            yield PlainLines()
        return
    from hemma.cli.bars import show_bars

    with redirect_stdout(sys.stderr), show_bars() as bars:
        yield bars


class PlainLines:
    """One line at the start of a stage, one every ten seconds, one at its end: for pipes and log files."""

    def __init__(self):
        self._total = 1
        self._spoke = 0.0

    def started(self, stage: str, total: int) -> None:
        """The stage begins."""
        self._total, self._spoke = total, time.monotonic()
        tell(f"{stage} ...")

    def advanced(self, stage: str, done: int, message: str) -> None:
        """A line when the last one is ten seconds ago."""
        if time.monotonic() - self._spoke >= SILENCE:
            self._spoke = time.monotonic()
            tell(f"{stage}: {done} of {self._total}. {message}".rstrip(". "))

    def finished(self, stage: str, message: str) -> None:
        """The stage is over."""
        tell(f"{stage}: {message}")

    def reused(self, stage: str, message: str) -> None:
        """The stage was not run."""
        tell(f"{stage}: kept from an earlier run, {message}")

    def noticed(self, message: str) -> None:
        """Something to know."""
        tell(f"note: {message}")


def print_json(content: Any) -> None:
    """Results for programs; escaped where the encoding could not show them."""
    is_complete = sys.stdout.encoding.lower().startswith("utf")
    say(json.dumps(content, indent=1, allow_nan=False, ensure_ascii=not is_complete))


def show_results(folder: Path, content: Any) -> None:
    """Results for people, as far as they go, and where the rest lies."""
    homes = content["homes"]
    if any(home["methods"] for home in homes.values()):
        print_table(folder)
    else:
        for name, home in homes.items():
            errors = (home["identification"] or {"rmse_c": {}})["rmse_c"].items()
            known = [f"{horizon}: {error:.2g} °C" for horizon, error in errors if error is not None]
            say(f"{name}: free-run error " + (", ".join(known) or "unknown"))
    print_recommendations(content)
    report = folder / "report.html"
    say(f"Results: {folder / 'results.json'}")
    if report.is_file():
        say(f"Report: {report}")


def print_recommendations(content: Any) -> None:
    """Which controller each home should have, where that was judged."""
    from hemma.report.tables.recommendation import HEADINGS, recommendation_rows, recommendation_sentence
    from hemma.results.results import HomeResults

    console = results_console()
    for name, entry in content["homes"].items():
        if not entry.get("recommendation"):
            continue
        home = HomeResults.model_validate(entry)
        table = ruled(f"{name}: judged on training days alone", HEADINGS)
        for cells in recommendation_rows(home):
            table.add_row(*cells)
        console.print(table)
        say(recommendation_sentence(name, home))


def print_table(folder: Path) -> None:
    """The main columns of the results, home by home, then over all homes; the report has all of them."""
    from hemma.cli.aggregate import print_aggregate
    from hemma.report import results_table
    from hemma.results.results import load_results

    console = results_console()
    results = load_results(folder)
    rows = results_table(results)
    for home in dict.fromkeys(row.home for row in rows):
        table = ruled(f"{home}: mean of the runs, and its 95 % interval", ("Method", *COLUMNS))
        for row in rows:
            if row.home == home:
                cells = [row.measures[heading] for heading in COLUMNS]
                table.add_row(row.method, *map(in_cell, cells))
        console.print(table)
    print_aggregate(console, results)
