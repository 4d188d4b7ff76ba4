"""What all methods that learn from demonstrations share: who demonstrates, how long, and what a run sees."""

from abc import abstractmethod
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import TypeVar

from hemma.methods.method import AbstractLearner
from hemma.results.fingerprint import fingerprint
from hemma.results.store import Store
from hemma.rl.policies.scaling import NOTHING, Context
from hemma.rl.task import Task, make_task, stack
from hemma.rl.training import Algorithm
from hemma.settings.experiment import Experiment
from hemma.stages.causal import causal_demonstration
from hemma.stages.demonstrate import Demonstration, Expert, demonstration
from hemma.stages.observer import HomeObserver, observer_of
from hemma.stages.train import TrainingJob

Imitator = TypeVar("Imitator", bound="AbstractImitator")


class Length(StrEnum):
    """Length of the demonstrations, as the settings have it."""

    SHORT = "demonstration_days"
    LONG = "long_demonstration_days"
    """The whole training period where it is shorter."""


@dataclass(frozen=True, kw_only=True)
class AbstractImitator(AbstractLearner):
    """A method that learns from demonstrations on the first days of the training period."""

    length: Length | int = Length.SHORT
    """Of the demonstrations; a number is one of days."""

    @abstractmethod
    def algorithm(self, experiment: Experiment) -> Algorithm:
        """How it learns from what is shown."""

    def training_job(self, expert: Expert, store: Store) -> TrainingJob:
        """One run a seed; it sees the demonstrated days and no others."""
        experiment = expert.case.experiment
        return self.job(expert, store, self.name, experiment.seeds)

    def job(self, expert: Expert, store: Store, label: str, seeds: int) -> TrainingJob:
        """The same under another label, with so many runs."""
        case = expert.case
        days = self.seen_days(case.experiment, case.training_days)
        observer = observer_of(self.observation_model, expert, store, forecasts=self.is_taught_causally)
        shown = self._shown(expert, store, observer, days)
        seen = observer.learning(days)
        return TrainingJob(
            label=label,
            algorithm=self.algorithm(case.experiment),
            task=stack([demonstrated_task(expert, shown, seed, seen) for seed in range(seeds)]),
            basis=fingerprint("job", case.home, shown.mark, observer.mark),
            observer=observer,
        )

    def seen_days(self, experiment: Experiment, training_days: int) -> int:
        """The length of the demonstrations [days]."""
        if isinstance(self.length, int):
            return self.length
        if self.length is Length.LONG:
            return min(experiment.long_demonstration_days, training_days)
        return experiment.demonstration_days

    def taught_causally(self: Imitator) -> Imitator:
        """The same method, taught by the default controller, which knows no more than its policy."""
        return replace(
            self,
            name=f"{self.name} causal",
            meaning=f"{self.meaning if self.plain else f'as {self.name}'}, taught by the default controller, "
            "which knows no more, instead of the expert in hindsight",
            plain=self.plain or self.name,
            is_taught_causally=True,
            look=None,
            is_candidate=False,
        )

    def _shown(self, expert: Expert, store: Store, observer: HomeObserver, days: int) -> Demonstration:
        if self.is_taught_causally:
            return causal_demonstration(store, expert, observer, days)
        return demonstration(store, expert, days)


def demonstrated_task(expert: Expert, shown: Demonstration, seed: int, context: Context = NOTHING) -> Task:
    """The task of one run that learns from what ``expert`` showed, on the days on which it did."""
    case, days = expert.case, expert.case.first_days(shown.days)
    space = case.experiment.space
    return make_task(expert.planning_home, case.home, days, shown.demonstrated, seed, context, space)
