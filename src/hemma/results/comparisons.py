"""What the runs of ``results.json`` say about each other: method against method, and over several homes.

Everything here follows from the runs that stand in the file, so it is computed when the file is written and
never kept.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

from hemma.evaluation import (
    NEGLIGIBLE,
    Interval,
    Pair,
    Sample,
    interval_kind,
    probability_of_improvement,
    summarise,
    summarise_homes,
)

COMPARED = "regret"
"""Of this metric the smaller value improves: what perfect information would have saved at equal comfort."""
PAIRED = "share_of_savings"
"""Of this metric the differences between methods are taken home by home."""


@dataclass(frozen=True)
class Aggregated:
    """A metric that makes sense over several homes."""

    metric: str
    worst: Callable[[Sequence[float]], float]
    """The worst of several values."""


AGGREGATED = (
    Aggregated("share_of_savings", min),
    Aggregated("gap_to_optimum", max),
    Aggregated("mean_temperature_deviation", max),
    Aggregated("regret", max),
)


def improvements(homes: Sequence[Any]) -> list[dict[str, Any]]:
    """Every pair of methods that all ``homes`` (entries of the file) have, in their order, each pair once."""
    return [_improvement(homes, method, over) for method, over in combinations(_shared(homes), 2)]


def aggregate(homes: dict[str, Any]) -> dict[str, Any] | None:
    """The entry of all homes with measured methods; None unless at least two share one.

    Every home counts the same. ``interval`` is about the same homes with other seeds, ``interval_over_homes``
    about other homes drawn like these.
    """
    measured = {name: home for name, home in homes.items() if home["methods"]}
    entries = list(measured.values())
    methods = _shared(entries)
    if len(measured) < 2 or not methods:
        return None
    return {
        "homes": list(measured),
        "methods": {method: _over_homes(entries, method) for method in methods},
        "probability_of_improvement": improvements(entries),
        "paired": [_paired(measured, method, over) for method, over in combinations(methods, 2)],
    }


def _shared(homes: Sequence[Any]) -> list[str]:
    first, *others = [home["methods"] for home in homes] or [{}]
    return [method for method in first if all(method in other for other in others)]


def _values(home: Any, method: str, metric: str) -> list[float | None]:
    return [run[metric] for run in home["methods"][method]["runs"]]


def _improvement(homes: Sequence[Any], method: str, over: str) -> dict[str, Any]:
    pairs = [Pair(_sample(home, method), _sample(home, over)) for home in homes]
    found = probability_of_improvement(pairs, NEGLIGIBLE)
    return {
        "method": method,
        "over": over,
        "probability": found.probability,
        "interval": _bounds(found.interval),
    }


def _sample(home: Any, method: str) -> Sample:
    is_random = any(run["seed"] is not None for run in home["methods"][method]["runs"])
    return Sample(tuple(_values(home, method, COMPARED)), is_random)


def _over_homes(homes: Sequence[Any], method: str) -> dict[str, Any]:
    kind = interval_kind([len(home["methods"][method]["runs"]) for home in homes])
    metrics = {one.metric: _aggregated(homes, method, one) for one in AGGREGATED}
    return {**metrics, "interval_kind": kind}


def _aggregated(homes: Sequence[Any], method: str, one: Aggregated) -> dict[str, Any]:
    values = [_values(home, method, one.metric) for home in homes]
    summary = summarise_homes(values)
    known = [value for runs in values for value in runs if value is not None]
    return {
        "mean": summary.mean,
        "interval": _bounds(summary.interval),
        "interval_over_homes": _bounds(summarise(_home_means(homes, method, one.metric)).interval),
        "interquartile_mean": summary.interquartile_mean,
        "worst": None if summary.mean is None else one.worst(known),
    }


def _home_means(homes: Sequence[Any], method: str, metric: str) -> list[float | None]:
    return [summarise(_values(home, method, metric)).mean for home in homes]


def _paired(homes: dict[str, Any], method: str, over: str) -> dict[str, Any]:
    """How much more of the savings one method keeps than another, home by home."""
    entries = list(homes.values())
    both = zip(_home_means(entries, method, PAIRED), _home_means(entries, over, PAIRED), strict=True)
    differences = [None if own is None or other is None else own - other for own, other in both]
    summary = summarise(differences)
    return {
        "method": method,
        "over": over,
        "metric": PAIRED,
        "differences": dict(zip(homes, differences, strict=True)),
        "mean": summary.mean,
        "interval": _bounds(summary.interval),
    }


def _bounds(interval: Interval | None) -> list[float] | None:
    return None if interval is None else [interval.low, interval.high]
