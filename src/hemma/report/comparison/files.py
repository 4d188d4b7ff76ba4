"""A comparison of results folders for programs (JSON, CSV) and for reading (HTML)."""

import csv
import io
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from hemma.checkpoint import write_atomically
from hemma.errors import HemmaError
from hemma.evaluation import Improvement, Interval, Metrics
from hemma.report.comparison.compare import COMPARED
from hemma.report.comparison.page import comparison_page
from hemma.report.comparison.records import ComparedHome, FolderComparison, MeasuredMethod, OverHomes


def comparison_document(comparison: FolderComparison) -> dict[str, Any]:
    """The comparison as JSON: ``folders``, ``disagreements``, ``notes``, ``homes``, ``over_homes``."""
    return {
        "folders": list(comparison.folders),
        "disagreements": [{"key": one.key, "values": list(one.values)} for one in comparison.disagreements],
        "notes": list(comparison.notes),
        "homes": {home.home: _home_document(comparison, home) for home in comparison.homes},
        "over_homes": [_over_homes_document(one) for one in comparison.over_homes],
    }


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
    for home in comparison.homes:
        for method in home.methods:
            for folder, found in zip(comparison.folders, method.found, strict=True):
                if found is not None:
                    writer.writerow([home.home, method.method, folder, found.runs, *_numbers(found)])
    return file.getvalue()


def _home_document(comparison: FolderComparison, home: ComparedHome) -> dict[str, Any]:
    return {
        "notes": list(home.notes),
        "methods": {
            method.method: {
                folder: _measured_document(found)
                for folder, found in zip(comparison.folders, method.found, strict=True)
                if found is not None
            }
            for method in home.methods
        },
    }


def _measured_document(found: MeasuredMethod) -> dict[str, Any]:
    difference = found.difference
    return {
        "runs": found.runs,
        "mean": found.mean.model_dump(mode="json"),
        "interval": found.interval.model_dump(mode="json"),
        "difference": difference and {name: getattr(difference, name) for name in COMPARED},
        "probability_of_improvement": _improvement_document(found.improvement),
    }


def _over_homes_document(one: OverHomes) -> dict[str, Any]:
    return {
        "method": one.method,
        "folder": one.folder,
        "homes": list(one.homes),
        "share_of_savings": {
            "difference": one.share_of_savings.mean,
            "interval": _bounds(one.share_of_savings.interval),
        },
        "probability_of_improvement": _improvement_document(one.improvement),
    }


def _improvement_document(improvement: Improvement | None) -> dict[str, Any] | None:
    if improvement is None:
        return None
    return {"probability": improvement.probability, "interval": _bounds(improvement.interval)}


def _bounds(interval: Interval | None) -> list[float] | None:
    return None if interval is None else [interval.low, interval.high]


def _numbers(found: MeasuredMethod) -> list[float | None]:
    difference = found.difference or Metrics()
    numbers: list[float | None] = []
    for name in COMPARED:
        low, high = getattr(found.interval, name) or (None, None)
        numbers += [getattr(found.mean, name), low, high, getattr(difference, name)]
    improvement = found.improvement or Improvement(None, None)
    return [*numbers, improvement.probability, *(_bounds(improvement.interval) or (None, None))]


FORMS: dict[str, Callable[[FolderComparison], str]] = {
    ".html": comparison_page,
    ".csv": comparison_csv,
    ".json": lambda found: json.dumps(comparison_document(found), indent=1, ensure_ascii=False) + "\n",
}
"""What a comparison is written as, by the ending of the file's name."""
