"""A comparison of results folders as a page that needs nothing outside itself."""

from collections.abc import Iterable
from html import escape
from itertools import groupby

from hemma.report.comparison.records import ComparedHome, Comparison
from hemma.report.comparison.table import (
    METHOD_HEADINGS,
    OVER_HOMES_HEADINGS,
    READING,
    ComparisonRow,
    disagreement_rows,
    home_rows,
    legend,
    letter,
    over_homes_rows,
)
from hemma.report.page.markup import body, bullets, cell, heading, paragraph, row, table
from hemma.report.page.stylesheet import STYLESHEET


def comparison_page(comparison: Comparison) -> str:
    """The HTML of the comparison."""
    title = f"{len(comparison.folders)} results folders side by side"
    parts = [
        bullets(legend(comparison)),
        paragraph(READING),
        _disagreements_section(comparison),
        *(_home_section(home) for home in comparison.homes),
        _over_homes_section(comparison),
    ]
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{escape(title)}</title><style>{STYLESHEET}</style></head><body>"
        f"<header>{heading(1, title)}</header><main>{''.join(parts)}</main></body></html>\n"
    )


def _disagreements_section(comparison: Comparison) -> str:
    rows = [row(key, [cell(text, style="text") for text in texts])
            for key, *texts in disagreement_rows(comparison)]  # fmt: skip
    letters = [letter(place) for place in range(len(comparison.folders))]
    made = table("What differs between the folders", ("", *letters), [body(rows)]) if rows else ""
    same = "" if rows else paragraph("Version, source code and settings are the same in all folders.")
    return made + same + (bullets(comparison.notes) if comparison.notes else "")


def _home_section(home: ComparedHome) -> str:
    notes = bullets(home.notes) if home.notes else ""
    return (
        heading(2, home.home)
        + notes
        + table("Means over the runs", METHOD_HEADINGS, _bodies(home_rows(home)))
    )


def _over_homes_section(comparison: Comparison) -> str:
    if not comparison.over_homes:
        return ""
    made = table(
        "Mean over the homes that both folders share; the interval is about other homes",
        OVER_HOMES_HEADINGS,
        _bodies(over_homes_rows(comparison)),
    )
    return heading(2, "All homes") + made


def _bodies(rows: Iterable[ComparisonRow]) -> list[str]:
    """One group of rows a method, its name in the first."""
    return [
        body(
            row(
                method if place == 0 else "",
                [cell(one.folder), *(cell(c.value, c.detail) for c in one.cells)],
            )
            for place, one in enumerate(group)
        )
        for method, group in groupby(rows, key=lambda one: one.method)
    ]
