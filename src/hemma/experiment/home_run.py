"""All stages of one home, in their order; the results file grows with each."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum, auto
from functools import partial
from typing import Any

from hemma.results.ledger import Ledger
from hemma.results.records import DemonstrationRuns, Run
from hemma.results.results import HomeResults
from hemma.results.store import Store
from hemma.results.summary import method_runs
from hemma.stages.case import Case, empty_results
from hemma.stages.default import choose_forecast
from hemma.stages.demonstrate import Expert
from hemma.stages.explicit import Sweep, explicit_lesson, explicit_methods, sweep_comfort_price
from hemma.stages.identify import identify
from hemma.stages.judge import Judge
from hemma.stages.lessons import ANY_LENGTH, imitations, lessons
from hemma.stages.play import play
from hemma.stages.references import References, plain_optimum
from hemma.stages.train import Lesson, Trained, train_lesson, train_lessons
from hemma.studies.pareto.bands import Bands, bands_lesson
from hemma.studies.pareto.pareto import Pareto
from hemma.studies.recommendation.recommend import Tryout
from hemma.studies.regret.split import split_regrets

LENGTHS = ("HA-1", "HA-2", ANY_LENGTH)
"""One method at several lengths of the demonstrations."""


class Stage(IntEnum):
    """How far to go; each stage needs those before it."""

    IDENTIFY = auto()
    DEMONSTRATE = auto()
    TRAIN = auto()
    EVALUATE = auto()
    REPORT = auto()


@dataclass(frozen=True)
class Learned:
    """A learned method on its way into the results."""

    method: str
    lesson: Lesson
    days: int | None = None
    """Length of the demonstrations."""


@dataclass(frozen=True)
class HomeRun:
    """All stages of one home."""

    case: Case
    store: Store
    ledger: Ledger

    def up_to(self, last: Stage) -> None:
        """Run the stages, as far as ``last``."""
        results = empty_results(self.case)
        identification = identify(self.case, self.store)
        results = self._put(results, identification=identification.found)
        if last is Stage.IDENTIFY:
            return
        expert = Expert(self.case, identification)
        imitating, bands = self._imitating(expert), bands_lesson(expert, self.store)
        if last is Stage.DEMONSTRATE:
            return
        if last is Stage.TRAIN:
            trained = self._train(imitating, bands)
            for _, learned in self._paid(expert):
                train_lesson(learned.lesson, self.store)
            self._recommended(results, expert, trained)
            return
        self._measure(results, expert, imitating, bands)

    def _imitating(self, expert: Expert) -> list[Learned]:
        """The methods that learn from demonstrations."""
        wanted = imitations(self.case.experiment, self.case.training_days)
        made = lessons(self.case, expert, self.store, wanted)
        return [Learned(one.method, lesson, one.days) for one, lesson in zip(wanted, made, strict=True)]

    def _train(self, imitating: Sequence[Learned], bands: Bands | None) -> dict[str, Trained]:
        """The controllers of each lesson by its label; lessons of one kind are trained in one call."""
        waiting = [learned.lesson for learned in imitating] + ([] if bands is None else [bands.lesson])
        trained: dict[str, Trained] = {}
        for kind in dict.fromkeys(lesson.kind for lesson in waiting):
            same = [lesson for lesson in waiting if lesson.kind == kind]
            made = train_lessons(same, self.store)
            trained |= {lesson.label: one for lesson, one in zip(same, made, strict=True)}
        return trained

    def _paid(self, expert: Expert) -> list[tuple[Sweep, Learned]]:
        """The methods that learn from the explicit reward, each with the sweep that set its beta_T."""
        paid = []
        for method in explicit_methods(self.case.experiment):
            sweep = sweep_comfort_price(expert, self.store, method)
            lesson = explicit_lesson(expert, self.store, method, sweep.chosen)
            paid.append((sweep, Learned(method, lesson)))
        return paid

    def _measure(
        self, results: HomeResults, expert: Expert, imitating: Sequence[Learned], bands: Bands | None
    ) -> None:
        """Baselines first, since they are quick; then what is learned, measured when it is trained."""
        judge = Judge(self.case, self.store)
        judge.write_exogenous()
        references = References(judge, expert).methods()
        methods = {name: method_runs(runs) for name, runs in references.items()}
        results = self._put(results, methods=methods, optimum=plain_optimum(judge))
        trained = self._train(imitating, bands)
        results = self._recommended(results, expert, trained)
        for learned in imitating:
            results = self._learned(results, judge, learned, trained[learned.lesson.label])
        paid = self._paid(expert)
        for _, learned in paid:
            results = self._learned(results, judge, learned, train_lesson(learned.lesson, self.store))
        results = self._put(results, regret=split_regrets(judge, expert, results.methods))
        pareto = Pareto(judge)
        deviations = [run.total_temperature_deviation or 0.0 for runs in references.values() for run in runs]
        points = pareto.frontier(max(deviations))
        for sweep, _ in paid:
            points += pareto.comfort_prices(sweep)
        if bands is not None:
            points += pareto.comfort_bands(bands, trained[bands.lesson.label], results.methods["HA-1"].runs)
        self._put(results, pareto=points)

    def _recommended(self, results: HomeResults, expert: Expert, trained: dict[str, Trained]) -> HomeResults:
        choice = choose_forecast(expert, self.store)
        found = Tryout(expert, self.store, choice, trained.get("HA-1")).recommendation()
        return self._put(results, recommendation=found)

    def _learned(self, results: HomeResults, judge: Judge, learned: Learned, trained: Trained) -> HomeResults:
        lesson = learned.lesson
        runs = judge.judged(lesson.label, trained.mark, partial(play, self.case, lesson, trained))
        return self._put(results, **_found(results, learned, runs))

    def _put(self, results: HomeResults, **found: Any) -> HomeResults:
        """Write the results with what was ``found``, by the names of their fields."""
        results = results.model_copy(update=found)
        self.ledger.put(self.case.name, results)
        return results


def _found(results: HomeResults, learned: Learned, runs: tuple[Run, ...]) -> dict[str, Any]:
    """What one more method adds; HA-1 and HA-2 are points of the data efficiency as well."""
    found: dict[str, Any] = {}
    method = method_runs(runs)
    if learned.method != ANY_LENGTH:
        found["methods"] = {**results.methods, learned.method: method}
        if learned.days is not None:
            found["demonstration_days"] = {**results.demonstration_days, learned.method: learned.days}
    if learned.method in LENGTHS and learned.days is not None:
        length = DemonstrationRuns(**dict(method), days=learned.days, method=ANY_LENGTH)
        lengths = (*results.data_efficiency, length)
        found["data_efficiency"] = tuple(sorted(lengths, key=lambda length: length.days))
    return found
