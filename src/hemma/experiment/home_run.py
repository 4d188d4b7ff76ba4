"""All stages of one home, in their order; the results file grows with each."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum, auto
from functools import partial
from typing import Any

from hemma.methods import AIRL, HA_1, controls, learned
from hemma.methods.bill import AbstractBillLearner
from hemma.methods.imitation import AbstractImitator
from hemma.methods.measured import known_in_test, measured, play, runnable
from hemma.methods.method import AbstractLearner
from hemma.results.ledger import Ledger
from hemma.results.records import DemonstrationRuns, MethodRuns
from hemma.results.results import HomeResults
from hemma.results.store import Store
from hemma.results.summary import method_runs
from hemma.stages.case import Case, empty_results
from hemma.stages.demonstrate import Expert
from hemma.stages.evaluate import Evaluator, plain_optimum
from hemma.stages.identify import identify
from hemma.stages.train import Trained, TrainingJob, train_all
from hemma.studies.data_efficiency.lengths import USUAL, OtherLength, other_lengths
from hemma.studies.pareto.bands import Bands, bands_job
from hemma.studies.pareto.pareto import Pareto
from hemma.studies.recommendation.recommend import Tryout
from hemma.studies.regret.split import split_regrets


class Stage(IntEnum):
    """How far to go; each stage needs those before it."""

    IDENTIFY = auto()
    DEMONSTRATE = auto()
    TRAIN = auto()
    EVALUATE = auto()
    REPORT = auto()


@dataclass(frozen=True)
class Shown:
    """What is learned from demonstrations, for methods and studies, before any of it is trained."""

    jobs: dict[str, TrainingJob]
    """Of the methods, by name."""
    lengths: Sequence[OtherLength]
    bands: Bands | None

    @property
    def all(self) -> list[TrainingJob]:
        """Every training job."""
        bands = [] if self.bands is None else [self.bands.job]
        return [*self.jobs.values(), *(other.job for other in self.lengths), *bands]


@dataclass(frozen=True)
class HomeRun:
    """All stages of one home."""

    case: Case
    store: Store
    ledger: Ledger

    def up_to(self, last: Stage) -> None:
        """Run the stages, as far as ``last``."""
        identification = identify(self.case, self.store)
        results = self._put(empty_results(self.case), identification=identification.found)
        if last is Stage.IDENTIFY:
            return
        expert = Expert(self.case, identification)
        shown = self._shown(expert)
        if last is Stage.DEMONSTRATE:
            return
        if last is Stage.TRAIN:
            trained = train_all(shown.all, self.store)
            trained |= train_all(list(self._others(expert).values()), self.store)
            self._recommended(results, expert, trained)
            return
        self._measure(results, expert, shown)

    def _methods(self) -> tuple[AbstractLearner, ...]:
        return learned(self.case.experiment)

    def _shown(self, expert: Expert) -> Shown:
        imitating = [method for method in self._methods() if isinstance(method, AbstractImitator)]
        jobs = {method.name: method.training_job(expert, self.store) for method in imitating}
        return Shown(
            jobs,
            other_lengths(expert, self.store, imitating),
            bands_job(expert, self.store, imitating),
        )

    def _others(self, expert: Expert) -> dict[str, TrainingJob]:
        """The jobs of methods that nobody demonstrates to, by name; some are trained on the way."""
        others = [method for method in self._methods() if not isinstance(method, AbstractImitator)]
        return {method.name: method.training_job(expert, self.store) for method in others}

    def _measure(self, results: HomeResults, expert: Expert, shown: Shown) -> None:
        """What needs no training first, since it is quick; then what is learned, measured when trained."""
        evaluator = Evaluator(self.case, self.store)
        evaluator.write_exogenous()
        known = known_in_test(evaluator, expert)
        methods = {
            method.name: method_runs(measured(method, evaluator, known))
            for method in runnable(controls(), known)
        }
        results = self._put(results, methods=methods, optimum=plain_optimum(evaluator))
        trained = train_all(shown.all, self.store)
        results = self._recommended(results, expert, trained)
        for name, job in shown.jobs.items():
            results = self._learned(results, name, self._evaluated(evaluator, job, trained))
        for other in shown.lengths:
            results = self._length(results, other.days, self._evaluated(evaluator, other.job, trained))
        others = self._others(expert)
        for name, job in others.items():
            found = self._evaluated(evaluator, job, train_all([job], self.store))
            results = self._learned(results, name, found)
        results = self._put(results, regret=split_regrets(evaluator, known, results.methods))
        self._pareto(results, evaluator, expert, shown.bands, trained)

    def _evaluated(self, evaluator: Evaluator, job: TrainingJob, trained: dict[str, Trained]) -> MethodRuns:
        one = trained[job.label]
        return method_runs(evaluator.evaluated(job.label, one.mark, partial(play, self.case, job, one)))

    def _learned(self, results: HomeResults, name: str, found: MethodRuns) -> HomeResults:
        """The results with those of one more method; HA-1 and HA-2 are points of the data efficiency too."""
        results = self._put(results, methods={**results.methods, name: found})
        method = {method.name: method for method in self._methods()}[name]
        if not isinstance(method, AbstractImitator):
            return results
        days = method.seen_days(self.case.experiment, self.case.training_days)
        results = self._put(results, demonstration_days={**results.demonstration_days, name: days})
        return self._length(results, days, found) if method in USUAL else results

    def _length(self, results: HomeResults, days: int, found: MethodRuns) -> HomeResults:
        length = DemonstrationRuns(**dict(found), days=days, method=AIRL.name)
        lengths = sorted((*results.data_efficiency, length), key=lambda length: length.days)
        return self._put(results, data_efficiency=tuple(lengths))

    def _pareto(
        self,
        results: HomeResults,
        evaluator: Evaluator,
        expert: Expert,
        bands: Bands | None,
        trained: dict[str, Trained],
    ) -> None:
        """Cost against comfort: the proven frontier up to the furthest control, and the sweeps."""
        pareto = Pareto(evaluator)
        fixed = [results.methods[method.name] for method in controls() if method.name in results.methods]
        deviations = [run.total_temperature_deviation or 0.0 for one in fixed for run in one.runs]
        points = pareto.frontier(max(deviations))
        for method in self._methods():
            if isinstance(method, AbstractBillLearner):
                points += pareto.comfort_prices(method.name, method.sweep(expert, self.store))
        if bands is not None:
            usual = results.methods[HA_1.name].runs
            points += pareto.comfort_bands(bands, trained[bands.job.label], usual)
        self._put(results, pareto=points)

    def _recommended(self, results: HomeResults, expert: Expert, trained: dict[str, Trained]) -> HomeResults:
        methods = {method.name: trained[method.name] for method in self._methods() if method.name in trained}
        return self._put(results, recommendation=Tryout(expert, self.store, methods).recommendation())

    def _put(self, results: HomeResults, **found: Any) -> HomeResults:
        """Write the results with what was ``found``, by the names of their fields."""
        results = results.model_copy(update=found)
        self.ledger.put(self.case.name, results)
        return results
