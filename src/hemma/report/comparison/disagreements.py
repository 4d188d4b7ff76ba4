"""Where results folders differ in what they were made of: version, settings, data."""

from collections.abc import Iterator, Sequence
from typing import Any

from hemma.report.comparison.records import Disagreement
from hemma.results.results import HomeResults, Results


def disagreements(results: Sequence[Results]) -> tuple[Disagreement, ...]:
    """Version, source code and settings that differ between the folders, settings by their dotted names."""
    columns = [
        {"hemma": one.hemma, "code": one.code[:12] or None, **dict(_flattened("", one.settings))}
        for one in results
    ]
    keys = dict.fromkeys(key for column in columns for key in column)
    rows = [Disagreement(key=key, values=tuple(column.get(key) for column in columns)) for key in keys]
    return tuple(row for row in rows if any(value != row.values[0] for value in row.values[1:]))


def why_not_comparable(first: HomeResults, other: HomeResults) -> str | None:
    """Why costs of the same home in two folders say nothing about each other; None where they do."""
    if not first.traces_sha256 or not other.traces_sha256:
        return "do not both say on which traces they were measured"
    if first.traces_sha256 != other.traces_sha256:
        shown = f"{first.traces_sha256[:12]} and {other.traces_sha256[:12]}"
        return f"were measured on different traces (SHA-256 {shown})"
    if first.test != other.test:
        return "were measured over different test periods"
    if first.currency != other.currency:
        return "were measured in different currencies"
    return None


def _flattened(prefix: str, settings: dict[str, Any]) -> Iterator[tuple[str, Any]]:
    """Nested settings by dotted names; a list is one value."""
    for key, value in settings.items():
        name = f"{prefix}.{key}" if prefix else key
        if isinstance(value, dict):
            yield from _flattened(name, value)
        else:
            yield name, value
