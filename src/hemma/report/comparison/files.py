"""A comparison of results folders for programs (JSON, CSV) and for reading (HTML)."""

import csv
import io
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from hemma.checkpoint import write_atomically
from hemma.errors import HemmaError
from hemma.report.comparison.compare import COMPARED
from hemma.report.comparison.page import comparison_page
from hemma.report.comparison.records import Chance, Differences, FolderComparison, MeasuredMethod


def comparison_document(comparison: FolderComparison) -> dict[str, Any]:
    """The comparison as JSON: ``folders``, ``disagreements``, ``notes``, ``homes``, ``over_homes``."""
    return comparison.model_dump(mode="json", by_alias=True)


def write_comparison(path: Path, comparison: FolderComparison) -> None:
    """Write the comparison in the form that the file's name asks for: .html, .csv or .json."""
    if path.suffix not in FORMS:
        raise HemmaError(f"{path}: expected a file name that ends in {', '.join(FORMS)}. Rename it")
    write_atomically(path, FORMS[path.suffix](comparison).encode())


def comparison_csv(comparison: FolderComparison) -> str:
    """One row for each home, method and folder; empty where there is no such number."""
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    header = [f"{name}{end}" for name in COMPARED for end in ("", "_low", "_high", "_difference")]
    improvement = ["probability_of_improvement", "probability_low", "probability_high"]
    writer.writerow(["home", "method", "folder", "runs", *header, *improvement])
    for name, home in comparison.homes.items():
        for method, by_folder in home.methods.items():
            for folder, found in by_folder.items():
                writer.writerow([name, method, folder, found.runs, *_numbers(found)])
    return file.getvalue()


def _numbers(found: MeasuredMethod) -> list[float | None]:
    difference = found.difference or Differences()
    numbers: list[float | None] = []
    for name in COMPARED:
        low, high = getattr(found.interval, name) or (None, None)
        numbers += [getattr(found.mean, name), low, high, getattr(difference, name)]
    chance = found.improvement or Chance(probability=None, interval=None)
    return [*numbers, chance.probability, *(chance.interval or (None, None))]


FORMS: dict[str, Callable[[FolderComparison], str]] = {
    ".html": comparison_page,
    ".csv": comparison_csv,
    ".json": lambda found: json.dumps(comparison_document(found), indent=1, ensure_ascii=False) + "\n",
}
"""What a comparison is written as, by the ending of the file's name."""
