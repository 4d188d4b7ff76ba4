"""From the runs in each changed home to ``transfer.json``; docs/reward.md explains it."""

from collections.abc import Sequence
from dataclasses import dataclass

import hemma
from hemma.evaluation import summarise
from hemma.results.ledger import CODE
from hemma.results.records import MethodRuns, Period
from hemma.results.summary import bounds
from hemma.settings.experiment import Experiment
from hemma.settings.keys import outside
from hemma.studies.transfer.changes import Place
from hemma.studies.transfer.records import ChangedHome, SeedPairs, Transfer


@dataclass(frozen=True)
class MeasuredPlace:
    """All methods in one place; the others are compared with the first, a policy from elsewhere."""

    place: Place
    methods: dict[str, MethodRuns]


def transfer_record(command: str, experiment: Experiment, measured: Sequence[MeasuredPlace]) -> Transfer:
    """The whole file."""
    first = measured[0].place.case
    return Transfer(
        hemma=hemma.__version__,
        code=CODE,
        command=command,
        settings=outside(experiment),
        home=first.name,
        source=first.traces.source,
        currency=experiment.currency,
        days=experiment.demonstration_days,
        measured=Period(start=first.parts.test.time_stamps()[0], slots=first.test.slots),
        places={one.place.change.name: _changed_home(one) for one in measured},
    )


def _changed_home(one: MeasuredPlace) -> ChangedHome:
    baseline, *others = one.methods
    return ChangedHome(
        meaning=one.place.change.meaning,
        learned_from=one.place.case.parts.training.time_stamps()[0],
        methods=one.methods,
        paired=tuple(_paired(one.methods, other, baseline) for other in others),
    )


def _paired(methods: dict[str, MethodRuns], method: str, over: str) -> SeedPairs:
    """By seed: a run's reward and its policy come from one training."""
    pairs = zip(_shares(methods[method]), _shares(methods[over]), strict=True)
    differences = [None if own is None or other is None else own - other for own, other in pairs]
    found = summarise(differences)
    return SeedPairs(
        method=method,
        over=over,
        differences=tuple(differences),
        mean=found.mean,
        interval=bounds(found.interval),
    )


def _shares(method: MethodRuns) -> list[float | None]:
    return [run.share_of_savings for run in method.runs]
