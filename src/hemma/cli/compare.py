"""``hemma compare``: several results folders side by side."""

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hemma.cli.console import grouped, in_cell, print_json, results_console, ruled, say, tell
from hemma.cli.files import Force, path_argument, path_option, require_new

if TYPE_CHECKING:
    from rich.console import Console

    from hemma.report.comparison.page import ComparisonRow
    from hemma.report.comparison.records import FolderComparison

Folders = Annotated[
    list[Path], path_argument("RESULTS...", "Results folders; the others are compared with the first.")
]
File = Annotated[Path | None, path_option("--out", "FILE", "Write it to a file too: .html, .csv or .json.")]
Json = Annotated[bool, typer.Option("--json", help="Print JSON instead of tables.")]


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
    from hemma.report.comparison import page

    console = results_console()
    for line in page.legend(comparison):
        console.print(line)
    _print_disagreements(console, comparison)
    _print_notes(console, comparison.notes)
    for name, home in comparison.homes.items():
        _print_rows(console, name, page.home_rows(comparison.folders, home))
        _print_notes(console, home.notes)
    if comparison.over_homes:
        _print_rows(console, page.OVER_HOMES, page.over_homes_rows(comparison))
    console.print(page.READING)


def _print_notes(console: "Console", notes: Iterable[str]) -> None:
    for note in notes:
        console.print(f"Note: {note}")


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


def _print_rows(console: "Console", title: str, rows: "list[ComparisonRow]") -> None:
    from hemma.report.comparison.page import headings_of

    texts = [(row.method, row.folder, *map(in_cell, row.cells.values())) for row in rows]
    console.print(grouped(ruled(title, headings_of(rows), left=2), texts))
