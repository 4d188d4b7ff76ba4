"""What the runs of ``results.json`` say about each other: method against method, and over several homes.

Everything here follows from the runs that stand in the file, so it is computed when the file is written and
never kept.
"""

from collections.abc import Callable, Mapping, Sequence
from itertools import combinations

from hemma.evaluation import (
    NEGLIGIBLE,
    Pair,
    Sample,
    interval_kind,
    probability_of_improvement,
    summarise,
    summarise_homes,
)
from hemma.results.findings import Aggregate, Aggregated, AggregateMethod, ImprovementRecord, PairedDifference
from hemma.results.results import HomeResults
from hemma.results.summary import COMPARED, bounds

PAIRED = "share_of_savings"
"""Of this metric the differences between methods are taken home by home."""
WORST: dict[str, Callable[[Sequence[float]], float]] = {
    "share_of_savings": min,
    "gap_to_optimum": max,
    "mean_temperature_deviation": max,
    "regret": max,
}
"""The metrics that make sense over several homes, and the worst of several values of each."""


def improvements(homes: Sequence[HomeResults]) -> tuple[ImprovementRecord, ...]:
    """Every pair of methods that all ``homes`` have, in their order, each pair once."""
    return tuple(_improvement(homes, method, over) for method, over in combinations(_shared(homes), 2))


def aggregate(homes: Mapping[str, HomeResults]) -> Aggregate | None:
    """What holds over all homes with measured methods; None unless at least two share one.

    Every home counts the same. ``interval`` is about the same homes with other seeds, ``interval_over_homes``
    about other homes drawn like these.
    """
    measured = {name: home for name, home in homes.items() if home.methods}
    entries = list(measured.values())
    methods = _shared(entries)
    if len(measured) < 2 or not methods:
        return None
    return Aggregate(
        homes=tuple(measured),
        methods={method: _over_homes(entries, method) for method in methods},
        probability_of_improvement=improvements(entries),
        paired=tuple(_paired(measured, method, over) for method, over in combinations(methods, 2)),
    )


def _shared(homes: Sequence[HomeResults]) -> list[str]:
    if not homes:
        return []
    first, *others = homes
    return [method for method in first.methods if all(method in other.methods for other in others)]


def _values(home: HomeResults, method: str, metric: str) -> list[float | None]:
    return [getattr(run, metric) for run in home.methods[method].runs]


def _improvement(homes: Sequence[HomeResults], method: str, over: str) -> ImprovementRecord:
    pairs = [Pair(_sample(home, method), _sample(home, over)) for home in homes]
    found = probability_of_improvement(pairs, NEGLIGIBLE)
    return ImprovementRecord(
        method=method, over=over, probability=found.probability, interval=bounds(found.interval)
    )


def _sample(home: HomeResults, method: str) -> Sample:
    is_random = any(run.seed is not None for run in home.methods[method].runs)
    return Sample(tuple(_values(home, method, COMPARED)), is_random)


def _over_homes(homes: Sequence[HomeResults], method: str) -> AggregateMethod:
    kind = interval_kind([len(home.methods[method].runs) for home in homes])
    metrics = {metric: _aggregated(homes, method, metric) for metric in WORST}
    return AggregateMethod(interval_kind=kind, **metrics)


def _aggregated(homes: Sequence[HomeResults], method: str, metric: str) -> Aggregated:
    values = [_values(home, method, metric) for home in homes]
    summary = summarise_homes(values)
    known = [value for runs in values for value in runs if value is not None]
    return Aggregated(
        mean=summary.mean,
        interval=bounds(summary.interval),
        interval_over_homes=bounds(summarise(_home_means(homes, method, metric)).interval),
        interquartile_mean=summary.interquartile_mean,
        worst=None if summary.mean is None else WORST[metric](known),
    )


def _home_means(homes: Sequence[HomeResults], method: str, metric: str) -> list[float | None]:
    return [summarise(_values(home, method, metric)).mean for home in homes]


def _paired(homes: Mapping[str, HomeResults], method: str, over: str) -> PairedDifference:
    """How much more of the savings one method keeps than another, home by home."""
    entries = list(homes.values())
    both = zip(_home_means(entries, method, PAIRED), _home_means(entries, over, PAIRED), strict=True)
    differences = [None if own is None or other is None else own - other for own, other in both]
    summary = summarise(differences)
    return PairedDifference(
        method=method,
        over=over,
        metric=PAIRED,
        differences=dict(zip(homes, differences, strict=True)),
        mean=summary.mean,
        interval=bounds(summary.interval),
    )
