"""Several results folders side by side: what each found, and what may be concluded from the difference."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hemma.errors import HemmaError
from hemma.evaluation import NEGLIGIBLE, Pair, Sample, probability_of_improvement, summarise
from hemma.report.comparison.records import (
    Chance,
    ComparedHome,
    Differences,
    Disagreement,
    FolderComparison,
    MeasuredMethod,
    OverHomes,
    ShareDifference,
)
from hemma.report.methods import in_order
from hemma.results.records import MethodRuns
from hemma.results.results import RESULTS_FILE, HomeResults, Results, load_results
from hemma.results.summary import bounds

RATIOS = ("share_of_savings", "gap_to_optimum")
"""What can be compared even where two folders measured on other data."""
COMPARED = tuple(Differences.model_fields)


def compare(folders: Sequence[Path]) -> FolderComparison:
    """Compare results folders with the first of them.

    Raises ``HemmaError`` for fewer than two folders, one that is named twice, is missing or has no results,
    and for folders that share no home with the first.
    """
    paths = [path.parent if path.name == RESULTS_FILE else path for path in folders]
    _require_folders(paths)
    results = {str(path): load_results(path) for path in paths}
    return FolderComparison(
        folders=tuple(results),
        disagreements=disagreements(list(results.values())),
        notes=tuple(_lacking(results)),
        homes={home: _compared_home(results, home) for home in _shared_homes(results)},
        over_homes=tuple(_over_homes(results)),
    )


def _require_folders(paths: Sequence[Path]) -> None:
    if len(paths) < 2:
        raise HemmaError(
            f"expected at least two results folders to compare, got {len(paths)}. "
            "Name the one to compare with first, then the others"
        )
    places = [path.resolve() for path in paths]
    for path, place in zip(paths, places, strict=True):
        if places.count(place) > 1:
            raise HemmaError(f"expected different results folders, got {path} twice. Name each of them once")
        if not path.is_dir():
            raise HemmaError(
                f"{path}: expected a results folder that `hemma reproduce` wrote, there is no such folder. "
                "Correct the name"
            )


def _shared_homes(results: dict[str, Results]) -> list[str]:
    first, *others = results.values()
    shared = [home for home in first.finished if any(home in other.finished for other in others)]
    if not shared:
        has = "; ".join(f"{name} has {', '.join(one.finished)}" for name, one in results.items())
        raise HemmaError(
            f"expected results folders with a home in common with the first, got none: {has}. "
            "Run `hemma reproduce` on the same home for each of them"
        )
    return shared


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


def _lacking(results: dict[str, Results]) -> Iterator[str]:
    for home in dict.fromkeys(home for one in results.values() for home in one.finished):
        without = [name for name, one in results.items() if home not in one.finished]
        if without:
            yield f"{home} has no results in {', '.join(without)}"


@dataclass(frozen=True)
class _Same:
    """The same home in one folder and in the first."""

    own: HomeResults
    first: HomeResults

    @property
    def methods(self) -> list[str]:
        """Those that both have."""
        return in_order(name for name in self.own.methods if name in self.first.methods)

    @property
    def is_comparable(self) -> bool:
        return why_not_comparable(self.first, self.own) is None

    def difference(self, method: str) -> Differences:
        """Of the means; costs only where they can be compared."""
        own, first = self.own.methods[method].mean, self.first.methods[method].mean
        names = COMPARED if self.is_comparable else RATIOS
        return Differences(**{name: _less(getattr(own, name), getattr(first, name)) for name in names})


def _compared_home(results: dict[str, Results], home: str) -> ComparedHome:
    entries = {folder: one.finished[home] for folder, one in results.items() if home in one.finished}
    (name, first), *_ = entries.items()
    reasons = {folder: why_not_comparable(first, entry) for folder, entry in entries.items()}
    methods = in_order(dict.fromkeys(method for entry in entries.values() for method in entry.methods))
    return ComparedHome(
        currencies={folder: entry.currency for folder, entry in entries.items()},
        notes=tuple(
            f"{home}: {name} and {folder} {reason}: only ratios can be compared"
            for folder, reason in reasons.items()
            if reason
        ),
        methods={
            method: {
                folder: _measured(entry, first, method)
                for folder, entry in entries.items()
                if method in entry.methods
            }
            for method in methods
        },
    )


def _measured(home: HomeResults, first: HomeResults, name: str) -> MeasuredMethod:
    method = home.methods[name]
    same = _Same(home, first) if home is not first and name in first.methods else None
    return MeasuredMethod(
        runs=len(method.runs),
        mean=method.mean,
        interval=method.interval,
        difference=same and same.difference(name),
        improvement=same and _chance([same], name),
    )


def _over_homes(results: dict[str, Results]) -> Iterator[OverHomes]:
    """Every folder but the first, every method that it shares with the first on two homes or more."""
    (_, first), *others = results.items()
    for folder, other in others:
        shared = {
            home: _Same(other.finished[home], entry)
            for home, entry in first.finished.items()
            if home in other.finished
        }
        for method in in_order(dict.fromkeys(name for same in shared.values() for name in same.methods)):
            both = {home: same for home, same in shared.items() if method in same.methods}
            if len(both) > 1:
                yield _method_over_homes(method, folder, both)


def _method_over_homes(method: str, folder: str, both: dict[str, _Same]) -> OverHomes:
    found = summarise([same.difference(method).share_of_savings for same in both.values()])
    return OverHomes(
        method=method,
        folder=folder,
        homes=tuple(both),
        share_of_savings=ShareDifference(difference=found.mean, interval=bounds(found.interval)),
        improvement=_chance(list(both.values()), method),
    )


def _chance(homes: Sequence[_Same], method: str) -> Chance | None:
    """None unless all homes were measured on the same data in both folders."""
    if not all(same.is_comparable for same in homes):
        return None
    pairs = [Pair(_sample(same.own.methods[method]), _sample(same.first.methods[method])) for same in homes]
    found = probability_of_improvement(pairs, NEGLIGIBLE)
    return Chance(probability=found.probability, interval=bounds(found.interval))


def _sample(method: MethodRuns) -> Sample:
    return Sample(tuple(run.regret for run in method.runs), method.is_learned)


def _less(own: float | None, first: float | None) -> float | None:
    return None if own is None or first is None else own - first
