"""The table over all homes of a results folder."""

from typing import TYPE_CHECKING

from hemma.cli.console import in_cell, ruled

if TYPE_CHECKING:
    from rich.console import Console

    from hemma.results.results import Results


def print_aggregate(console: "Console", results: "Results") -> None:
    """A row a method: the mean over homes and seeds; nothing for a single home."""
    from hemma.report.methods import in_order
    from hemma.report.tables.aggregate import INTERVALS, aggregate_rows

    rows = aggregate_rows(results)
    if not rows or results.aggregate is None:
        return
    headings = ("Method", *next(iter(rows.values())))
    table = ruled(f"All {len(results.aggregate.homes)} homes: means over homes and seeds", headings)
    table.caption = INTERVALS
    for method in in_order(rows):
        table.add_row(method, *map(in_cell, rows[method].values()))
    console.print(table)
