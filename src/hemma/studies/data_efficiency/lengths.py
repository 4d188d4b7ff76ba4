"""How the method fares with more and fewer days of demonstrations (Figs. 3a and 3b of the paper)."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from hemma.methods import AIRL, HA_1, HA_2
from hemma.methods.method import AbstractLearner
from hemma.results.store import Store
from hemma.stages.demonstrate import Expert
from hemma.stages.train import TrainingJob

USUAL = (HA_1, HA_2)
"""They are points of the figure as well."""


@dataclass(frozen=True)
class OtherLength:
    """The method on demonstrations of another length."""

    days: int
    job: TrainingJob


def other_lengths(expert: Expert, store: Store, methods: Sequence[AbstractLearner]) -> list[OtherLength]:
    """The lengths that none of ``methods``, which are run anyway, has; no more days than there are."""
    case = expert.case
    efficiency, days = case.experiment.data_efficiency, case.training_days
    done = {method.seen_days(case.experiment, days) for method in methods if method in USUAL}
    return [
        OtherLength(length, _job(length, expert, store, efficiency.seeds))
        for length in efficiency.days
        if length not in done and length <= days
    ]


def _job(days: int, expert: Expert, store: Store, seeds: int) -> TrainingJob:
    return replace(AIRL, length=days).job(expert, store, f"{AIRL.name}-{days}-days", seeds)
