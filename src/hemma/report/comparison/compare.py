"""Several results folders side by side: what each found, and what may be concluded from the difference."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from hemma.errors import HemmaError
from hemma.evaluation import (
    NEGLIGIBLE,
    Improvement,
    Metrics,
    Pair,
    Sample,
    probability_of_improvement,
    summarise,
)
from hemma.report.comparison.disagreements import disagreements, why_not_comparable
from hemma.report.comparison.records import (
    ComparedHome,
    ComparedMethod,
    FolderComparison,
    MeasuredMethod,
    OverHomes,
)
from hemma.report.methods import in_order
from hemma.results.records import MethodRuns
from hemma.results.results import RESULTS_FILE, HomeResults, Results, load_results

RATIOS = ("share_of_savings", "gap_to_optimum")
"""What can be compared even where two folders measured on other data."""
COMPARED = ("energy_cost", *RATIOS, "mean_temperature_deviation")


def compare(folders: Sequence[Path]) -> FolderComparison:
    """Compare results folders with the first of them.

    Raises ``HemmaError`` for fewer than two folders, one that is named twice, is missing or has no results,
    and for folders that share no home with the first.
    """
    paths = [path.parent if path.name == RESULTS_FILE else path for path in folders]
    _require_folders(paths)
    results = {str(path): load_results(path) for path in paths}
    shared = _shared_homes(results)
    return FolderComparison(
        folders=tuple(results),
        disagreements=disagreements(list(results.values())),
        homes=tuple(_compared_home(results, home) for home in shared),
        over_homes=tuple(_over_homes(results)),
        notes=tuple(_lacking(results)),
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

    def difference(self, method: str) -> Metrics:
        """Of the means; costs only where they can be compared."""
        own, first = self.own.methods[method].mean, self.first.methods[method].mean
        names = COMPARED if self.is_comparable else RATIOS
        return Metrics(**{name: _less(getattr(own, name), getattr(first, name)) for name in names})

    def improvement(self, method: str) -> Improvement | None:
        return _improvement([self], method) if self.is_comparable else None


def _compared_home(results: dict[str, Results], home: str) -> ComparedHome:
    (name, one), *_ = results.items()
    first = one.finished[home]
    entries = {folder: other.finished.get(home) for folder, other in results.items()}
    present = [entry for entry in entries.values() if entry is not None]
    reasons = {folder: entry and why_not_comparable(first, entry) for folder, entry in entries.items()}
    methods = in_order(dict.fromkeys(method for entry in present for method in entry.methods))
    return ComparedHome(
        home=home,
        currencies=tuple(entry and entry.currency for entry in entries.values()),
        methods=tuple(
            ComparedMethod(method, tuple(_measured(entry, first, method) for entry in entries.values()))
            for method in methods
        ),
        notes=tuple(
            f"{home}: {name} and {folder} {reason}: only ratios can be compared"
            for folder, reason in reasons.items()
            if reason
        ),
    )


def _measured(home: HomeResults | None, first: HomeResults, name: str) -> MeasuredMethod | None:
    if home is None or name not in home.methods:
        return None
    method, same = home.methods[name], None
    if home is not first and name in first.methods:
        same = _Same(home, first)
    return MeasuredMethod(
        len(method.runs),
        method.mean,
        method.interval,
        same and same.difference(name),
        same and same.improvement(name),
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
    shares = [same.difference(method).share_of_savings for same in both.values()]
    are_comparable = all(same.is_comparable for same in both.values())
    found = _improvement(list(both.values()), method) if are_comparable else None
    return OverHomes(method, folder, tuple(both), summarise(shares), found)


def _improvement(homes: Sequence[_Same], method: str) -> Improvement:
    pairs = [Pair(_sample(same.own.methods[method]), _sample(same.first.methods[method])) for same in homes]
    return probability_of_improvement(pairs, NEGLIGIBLE)


def _sample(method: MethodRuns) -> Sample:
    return Sample(tuple(run.regret for run in method.runs), method.is_learned)


def _less(own: float | None, first: float | None) -> float | None:
    return None if own is None or first is None else own - first
