"""The table over all homes of a results folder."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console

    from hemma.results.results import Results


def print_aggregate(console: "Console", results: "Results") -> None:
    """A row a method: the mean over homes and seeds; nothing for a single home."""
    from rich.table import Table

    from hemma.report.tables.aggregate import AGGREGATE_HEADINGS, aggregate_table

    rows = aggregate_table(results)
    if not rows or results.aggregate is None:
        return
    title = (
        f"All {len(results.aggregate.homes)} homes: mean, 95 % interval for other seeds and for other homes"
    )
    table = Table(AGGREGATE_HEADINGS[0], title=title)
    for heading in AGGREGATE_HEADINGS[1:]:
        table.add_column(heading, justify="right")
    for row in rows:
        table.add_row(row.method, *(f"{cell.value}\n{cell.detail}".strip() for cell in row.cells))
    console.print(table)
