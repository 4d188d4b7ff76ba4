"""``hemma compare``: several results folders side by side."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hemma.cli.console import print_json, results_console, ruled, say, tell
from hemma.cli.files import Force, named, require_new

if TYPE_CHECKING:
    from rich.console import Console

    from hemma.report.comparison.page import ComparisonRow
    from hemma.report.comparison.records import FolderComparison

Folders = Annotated[
    list[Path],
    typer.Argument(
        parser=named,
        metavar="RESULTS...",
        help="Results folders; the others are compared with the first.",
    ),
]
File = Annotated[
    Path | None,
    typer.Option("--out", parser=named, metavar="FILE", help="Write it to a file too: .html, .csv or .json."),
]
Json = Annotated[bool, typer.Option("--json", help="Print JSON instead of tables.")]


def register(app: typer.Typer) -> None:
    """Add the command to ``app``."""
    app.command()(compare)


def compare(folders: Folders, out: File = None, force: Force = False, json: Json = False) -> None:
    """Set results folders side by side: costs, shares, comfort, and what differs in settings and data."""
    from hemma.report.comparison.compare import compare as compare_folders
    from hemma.report.comparison.files import FORMS, comparison_document, write_comparison

    if out is not None:
        require_new(out, force, tuple(FORMS))
    comparison = compare_folders(folders)
    if out is not None:
        write_comparison(out, comparison)
    if json:
        print_json(comparison_document(comparison))
    else:
        _print_comparison(comparison)
    if out is not None:
        (tell if json else say)(f"Comparison: {out}")


def _print_comparison(comparison: "FolderComparison") -> None:
    from hemma.report.comparison.page import READING, legend

    console = results_console()
    for line in legend(comparison):
        console.print(line)
    _print_disagreements(console, comparison)
    for note in comparison.notes:
        console.print(f"Note: {note}")
    _print_methods(console, comparison)
    _print_over_homes(console, comparison)
    console.print(READING)


def _print_disagreements(console: "Console", comparison: "FolderComparison") -> None:
    from hemma.report.comparison.page import disagreement_rows, letter

    rows = disagreement_rows(comparison)
    if not rows:
        console.print("Version, source code and settings are the same in all folders.")
        return
    letters = [letter(place) for place in range(len(comparison.folders))]
    table = ruled("What differs between the folders", ("Different", *letters), left=1 + len(letters))
    for row in rows:
        table.add_row(*row)
    console.print(table)


def _print_methods(console: "Console", comparison: "FolderComparison") -> None:
    from hemma.report.comparison.page import home_rows

    for name, home in comparison.homes.items():
        _print_rows(console, name, home_rows(comparison.folders, home))
        for note in home.notes:
            console.print(f"Note: {note}")


def _print_over_homes(console: "Console", comparison: "FolderComparison") -> None:
    from hemma.report.comparison.page import OVER_HOMES, over_homes_rows

    if comparison.over_homes:
        _print_rows(console, OVER_HOMES, over_homes_rows(comparison))


def _print_rows(console: "Console", title: str, rows: "list[ComparisonRow]") -> None:
    from hemma.report.comparison.page import headings_of

    table = ruled(title, headings_of(rows), left=2)
    last = ""
    for row in rows:
        if last and row.method != last:
            table.add_section()
        texts = [f"{cell.value}\n{cell.detail}".strip() for cell in row.cells.values()]
        table.add_row("" if row.method == last else row.method, row.folder, *texts)
        last = row.method
    console.print(table)
