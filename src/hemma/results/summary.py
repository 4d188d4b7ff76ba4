"""What the runs of a method say together."""

from collections.abc import Sequence
from typing import TypeVar

from hemma.evaluation import Interval, Measures, Summary, interval_kind, summarise
from hemma.record import Number, Range
from hemma.results.records import MethodRuns, Run

COMPARED = "regret"
"""Of this metric the smaller value improves: what perfect information would have saved at equal comfort."""

Values = TypeVar("Values", bound=Measures)


def method_runs(runs: Sequence[Run]) -> MethodRuns:
    """The runs with their means, 95 % intervals, interquartile means, and the seed that fared worst."""
    summaries = summarised(runs)
    return MethodRuns(
        runs=tuple(runs),
        mean=means(Measures[Number], summaries),
        interval=intervals(Measures[Range], summaries),
        interval_kind=interval_kind([len(runs)]),
        interquartile_mean=Measures[Number](
            **{name: summary.interquartile_mean for name, summary in summaries.items()}
        ),
        worst_seed=_worst_seed(runs),
    )


def summarised(runs: Sequence[Measures], kind: type[Measures] = Measures) -> dict[str, Summary]:
    """The summary of every metric of ``kind``, by name."""
    return {name: summarise([getattr(run, name) for run in runs]) for name in kind.model_fields}


def means(kind: type[Values], summaries: dict[str, Summary]) -> Values:
    """The means as a record."""
    return kind(**{name: summary.mean for name, summary in summaries.items()})


def intervals(kind: type[Values], summaries: dict[str, Summary]) -> Values:
    """The 95 % intervals as a record."""
    return kind(**{name: bounds(summary.interval) for name, summary in summaries.items()})


def bounds(interval: Interval | None) -> tuple[float, float] | None:
    """Low and high, or None where there is no interval."""
    return None if interval is None else (interval.low, interval.high)


def _worst_seed(runs: Sequence[Run]) -> int | None:
    """The seed of the run with the largest regret; None without seeds, or where a run's regret is missing."""
    regrets = [run.regret for run in runs]
    known = [regret for regret in regrets if regret is not None]
    if len(known) < len(regrets):
        return None
    return runs[regrets.index(max(known))].seed
