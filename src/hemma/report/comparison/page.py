"""A comparison of results folders as a page that needs nothing outside itself."""

from collections.abc import Iterable
from itertools import groupby

from hemma.report.comparison.records import FolderComparison
from hemma.report.comparison.table import (
    METHOD_HEADINGS,
    OVER_HOMES,
    OVER_HOMES_HEADINGS,
    READING,
    ComparisonRow,
    disagreement_rows,
    home_rows,
    legend,
    letter,
    over_homes_rows,
)
from hemma.report.page.markup import Row, RowGroup, bullets, document, heading, paragraph, table


def comparison_page(comparison: FolderComparison) -> str:
    """The HTML of the comparison."""
    title = f"{len(comparison.folders)} results folders side by side"
    parts = [
        bullets(legend(comparison)),
        paragraph(READING),
        _disagreements_section(comparison),
        *(_home_section(comparison, name) for name in comparison.homes),
        _over_homes_section(comparison),
    ]
    return document(title, heading(1, title), "".join(parts))


def _disagreements_section(comparison: FolderComparison) -> str:
    rows = [Row(key, texts) for key, *texts in disagreement_rows(comparison)]
    letters = [letter(place) for place in range(len(comparison.folders))]
    made = table("What differs between the folders", ("", *letters), [RowGroup(rows)], "text")
    same = paragraph("Version, source code and settings are the same in all folders.")
    return (made if rows else same) + bullets(comparison.notes)


def _home_section(comparison: FolderComparison, name: str) -> str:
    home = comparison.homes[name]
    rows = _groups(home_rows(comparison.folders, home))
    return heading(2, name) + bullets(home.notes) + table("Means over the runs", METHOD_HEADINGS, rows)


def _over_homes_section(comparison: FolderComparison) -> str:
    if not comparison.over_homes:
        return ""
    rows = _groups(over_homes_rows(comparison))
    return heading(2, "All homes") + table(OVER_HOMES, OVER_HOMES_HEADINGS, rows)


def _groups(rows: Iterable[ComparisonRow]) -> list[RowGroup]:
    """One group of rows a method, its name in the first."""
    return [
        RowGroup([Row("" if place else method, (one.folder, *one.cells)) for place, one in enumerate(group)])
        for method, group in groupby(rows, key=lambda one: one.method)
    ]
