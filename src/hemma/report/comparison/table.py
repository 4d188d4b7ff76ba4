"""A comparison of results folders as text: the same rows on the screen and in the page."""

import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from hemma.evaluation import Improvement
from hemma.report.comparison.records import ComparedHome, Comparison, Measured, OverHomes
from hemma.report.numbers import DASH, decimals, degrees, fine, hundredths, money, percent
from hemma.report.tables.results import Cell

METHOD_HEADINGS = (
    "Method",
    "Folder",
    "Runs",
    "Energy cost",
    "Share of savings",
    "Gap to optimum",
    "Mean deviation",
    "Better than A",
)
OVER_HOMES_HEADINGS = ("Method", "Folder", "Homes", "Share of savings, difference to A", "Better than A")
READING = (
    "A is the folder that the others are compared with: in parentheses stands the difference to it, in "
    "brackets the 95 % interval of the mean. Better than A: how probably a run of this folder has a lower "
    "regret (cost above perfect information at equal comfort) than a run of A; 0.5 is no difference."
)
DISAGREEMENT_WIDTH = 60
"""Characters of a value that is shown; longer ones are cut."""


@dataclass(frozen=True)
class ComparisonRow:
    """One method, in one folder."""

    method: str
    folder: str
    """Its letter."""
    cells: tuple[Cell, ...]
    """What stands below the headings from the third on."""


def letter(place: int) -> str:
    """``A`` for the first folder, which the others are compared with."""
    return chr(ord("A") + place) if place < 26 else str(place + 1)


def legend(comparison: Comparison) -> list[str]:
    """Which letter stands for which folder."""
    return [f"{letter(place)}  {name}" for place, name in enumerate(comparison.folders)]


def disagreement_rows(comparison: Comparison) -> list[tuple[str, ...]]:
    """What differs, and its value in each folder."""
    return [(row.key, *(_short(value) for value in row.values)) for row in comparison.disagreements]


def home_rows(home: ComparedHome) -> Iterator[ComparisonRow]:
    """A row for each method in each folder that has it."""
    for compared in home.methods:
        for place, found in enumerate(compared.found):
            if found is not None:
                yield ComparisonRow(
                    compared.method, letter(place), _cells(found, home.currencies[place] or "")
                )


def over_homes_rows(comparison: Comparison) -> Iterator[ComparisonRow]:
    """A row for each method in each folder but the first."""
    for found in comparison.over_homes:
        yield ComparisonRow(
            found.method, letter(comparison.folders.index(found.folder)), _over_homes_cells(found)
        )


def _short(value: Any) -> str:
    text = DASH if value is None else value if isinstance(value, str) else json.dumps(value)
    return text if len(text) <= DISAGREEMENT_WIDTH else f"{text[: DISAGREEMENT_WIDTH - 1]}…"


def _cells(found: Measured, currency: str) -> tuple[Cell, ...]:
    mean, interval, less = found.mean, found.interval, found.difference
    return (
        Cell(str(found.runs)),
        _cell(
            money(mean.energy_cost, currency),
            less and _signed(less.energy_cost, lambda value: decimals(value, 2)),
            _range(interval.energy_cost, lambda value: decimals(value, 2)),
        ),
        _cell(
            percent(mean.share_of_savings),
            less and _signed(less.share_of_savings, hundredths),
            _range(interval.share_of_savings, hundredths),
        ),
        _cell(
            percent(mean.gap_to_optimum),
            less and _signed(less.gap_to_optimum, hundredths),
            _range(interval.gap_to_optimum, hundredths),
        ),
        _cell(
            degrees(mean.mean_temperature_deviation),
            less and _signed(less.mean_temperature_deviation, fine),
            _range(interval.mean_temperature_deviation, fine),
        ),
        _improvement_cell(less and less.improvement),
    )


def _over_homes_cells(found: OverHomes) -> tuple[Cell, ...]:
    summary = found.share_of_savings
    bounds = None if summary.interval is None else (summary.interval.low, summary.interval.high)
    difference = Cell(_signed(summary.mean, hundredths) or DASH, _range(bounds, hundredths))
    return Cell(str(len(found.homes))), difference, _improvement_cell(found.improvement)


def _improvement_cell(improvement: Improvement | None) -> Cell:
    if improvement is None or improvement.probability is None:
        return Cell(DASH)
    interval = improvement.interval
    bounds = None if interval is None else (interval.low, interval.high)
    return Cell(decimals(improvement.probability, 2), _range(bounds, lambda value: decimals(value, 2)))


def _cell(value: str, difference: str | None, interval: str) -> Cell:
    return Cell(f"{value} ({difference})" if difference else value, interval)


def _signed(value: float | None, written: Callable[[float | None], str]) -> str:
    """``+0.40``, or nothing where there is no difference to speak of."""
    if value is None:
        return ""
    text = written(value)
    return f"+{text}" if value > 0 else text


def _range(bounds: tuple[float, float] | None, written: Callable[[float | None], str]) -> str:
    return "" if bounds is None else f"[{written(bounds[0])}, {written(bounds[1])}]"
