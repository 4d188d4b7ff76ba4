"""A comparison of results folders as rows of text, the same on the screen and in a page that stands alone."""

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import chain, groupby, repeat
from typing import Any

from hemma.report.comparison.records import (
    Chance,
    ComparedHome,
    Differences,
    FolderComparison,
    MeasuredMethod,
    OverHomes,
)
from hemma.report.numbers import DASH, hundredths
from hemma.report.page.markup import Row, RowGroup, bullets, document, heading, paragraph, table
from hemma.report.tables.cells import CHANCE, DEGREES, NOTHING, PERCENT, Cell, Notation, in_money

READING = (
    "A is the folder that the others are compared with: in parentheses stands the difference to it, in "
    "brackets the 95 % interval of the mean. Better than A: how probably a run of this folder has a lower "
    "regret (cost above perfect information with the same deviation) than a run of A; 0.5 is no difference."
)
OVER_HOMES = (
    "Mean over the homes that both folders share; the interval is from home to home: it leaves out what the "
    "homes share, such as weather, prices and building"
)
DISAGREEMENT_WIDTH = 60
"""Characters of a value that is shown; longer ones are cut."""


@dataclass(frozen=True)
class ComparisonRow:
    """One method, in one folder."""

    method: str
    folder: str
    """Its letter."""
    cells: dict[str, Cell]
    """By heading, from the third on."""


def letter(place: int) -> str:
    """``A`` for the first folder, which the others are compared with."""
    return chr(ord("A") + place) if place < 26 else str(place + 1)


def legend(comparison: FolderComparison) -> list[str]:
    """Which letter stands for which folder."""
    return [f"{letter(place)}  {name}" for place, name in enumerate(comparison.folders)]


def disagreement_rows(comparison: FolderComparison) -> list[tuple[str, ...]]:
    """What differs, and its value in each folder."""
    return [(row.key, *(_short(value) for value in row.values)) for row in comparison.disagreements]


def headings_of(rows: Sequence[ComparisonRow]) -> tuple[str, ...]:
    """What stands above the rows of a table."""
    return ("Method", "Folder", *rows[0].cells)


def home_rows(folders: Sequence[str], home: ComparedHome) -> list[ComparisonRow]:
    """A row for each method in each folder that has it."""
    return [
        ComparisonRow(method, letter(folders.index(folder)), _cells(found, home.currencies[folder]))
        for method, by_folder in home.methods.items()
        for folder, found in by_folder.items()
    ]


def over_homes_rows(comparison: FolderComparison) -> list[ComparisonRow]:
    """A row for each method in each folder but the first."""
    return [
        ComparisonRow(one.method, letter(comparison.folders.index(one.folder)), _over_homes_cells(one))
        for one in comparison.over_homes
    ]


def _short(value: Any) -> str:
    text = DASH if value is None else value if isinstance(value, str) else json.dumps(value)
    return text if len(text) <= DISAGREEMENT_WIDTH else f"{text[: DISAGREEMENT_WIDTH - 1]}…"


def _cells(found: MeasuredMethod, currency: str) -> dict[str, Cell]:
    return {
        "Runs": Cell(str(found.runs)),
        "Energy cost": _cell(found, in_money(currency), lambda it: it.energy_cost),
        "Share of savings": _cell(found, PERCENT, lambda it: it.share_of_savings),
        "Gap to optimum": _cell(found, PERCENT, lambda it: it.gap_to_optimum),
        "Mean deviation": _cell(found, DEGREES, lambda it: it.mean_temperature_deviation),
        "Better than A": _chance_cell(found.improvement),
    }


def _over_homes_cells(found: OverHomes) -> dict[str, Cell]:
    share = found.share_of_savings
    difference = Cell(_signed(share.difference, hundredths) or DASH, PERCENT.range(share.interval))
    return {
        "Homes": Cell(str(len(found.homes))),
        "Share of savings, difference to A": difference,
        "Better than A": _chance_cell(found.improvement),
    }


def _chance_cell(chance: Chance | None) -> Cell:
    return NOTHING if chance is None else CHANCE.cell(chance.probability, chance.interval)


def _cell(found: MeasuredMethod, notation: Notation, metric: Callable[[Any], Any]) -> Cell:
    """The mean, the difference to the first folder if there is one, and the interval."""
    difference = _signed(metric(found.difference or Differences()), notation.bare)
    value = notation.full(metric(found.mean))
    interval = notation.range(metric(found.interval))
    return Cell(f"{value} ({difference})" if difference else value, interval)


def _signed(value: float | None, written: Callable[[float | None], str]) -> str:
    """``+0.40``, or nothing where there is no difference to speak of."""
    if value is None:
        return ""
    text = written(value)
    return f"+{text}" if value > 0 else text


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
    made = _grouped("Means over the runs", home_rows(comparison.folders, home))
    return heading(2, name) + bullets(home.notes) + made


def _over_homes_section(comparison: FolderComparison) -> str:
    rows = over_homes_rows(comparison)
    return heading(2, "All homes") + _grouped(OVER_HOMES, rows) if rows else ""


def _grouped(caption: str, rows: Sequence[ComparisonRow]) -> str:
    """A table with one group of rows a method, its name in the first."""
    groups = []
    for method, group in groupby(rows, key=lambda one: one.method):
        names = chain([method], repeat(""))
        groups.append(RowGroup([Row(next(names), (one.folder, *one.cells.values())) for one in group]))
    return table(caption, headings_of(rows), groups)
