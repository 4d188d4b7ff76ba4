"""The main job, stage by stage: traces in, one results folder out."""

import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import IntEnum, auto
from functools import partial
from pathlib import Path
from typing import Any

import jax

from hemma.data import Traces
from hemma.errors import HemmaError
from hemma.evaluation import evaluate_stacked
from hemma.experiment.case import Case, empty_results, make_case
from hemma.experiment.demonstrate import Expert
from hemma.experiment.identify import identify
from hemma.experiment.judge import Judge, Played
from hemma.experiment.keys import outside
from hemma.experiment.ledger import Ledger, open_ledger
from hemma.experiment.lessons import ANY_LENGTH, Imitation, imitations, lessons
from hemma.experiment.progress import Progress, Silence
from hemma.experiment.references import plain_optimum, references
from hemma.experiment.results import Head, HomeResults, MethodResults, Run
from hemma.experiment.settings import Experiment
from hemma.experiment.store import Store
from hemma.experiment.train import Lesson, Trained, train_lesson

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
class Job:
    """What to run, on what, and where the results go."""

    experiment: Experiment
    homes: tuple[Traces, ...]
    folder: Path
    test_from: str | None = None
    """Start of the test period; the last 31 days by default."""
    command: str = "hemma reproduce"
    """What was typed, for the results file."""


def run(job: Job, last: Stage = Stage.REPORT, progress: Progress | None = None) -> Any:
    """Run the stages up to ``last`` for every home; the content of ``results.json``.

    Every stage keeps its product in the folder, with a fingerprint of all that it depends on. The same call
    after an interruption goes on where it was, and repeated it changes nothing; a stage whose settings,
    traces or version differ is done again.
    """
    progress = Silence() if progress is None else progress
    _require_different_names(job.homes)
    cases = [make_case(job.experiment, traces, job.test_from) for traces in job.homes]
    _require_writable(job.folder)
    ledger = open_ledger(job.folder, Head(job.command, outside(job.experiment)), progress)
    for case in cases:
        _HomeRun(case, Store(job.folder, case.name, progress), ledger).up_to(last)
    ledger.close()
    if last is Stage.REPORT:
        _report(job.folder, progress)
    return ledger.content


@dataclass(frozen=True)
class _HomeRun:
    """All stages of one home."""

    case: Case
    store: Store
    ledger: Ledger

    def up_to(self, last: Stage) -> None:
        """Run the stages; the results file grows with each."""
        results = empty_results(self.case)
        identification = identify(self.case, self.store)
        results = self._put(replace(results, identification=identification.found))
        if last is Stage.IDENTIFY:
            return
        expert = Expert(self.case, identification)
        wanted = imitations(self.case.experiment, self.case.training_days)
        learned = list(zip(wanted, lessons(self.case, expert, self.store, wanted), strict=True))
        if last is Stage.DEMONSTRATE:
            return
        if last is Stage.TRAIN:
            for _, lesson in learned:
                train_lesson(lesson, self.store)
            return
        self._measure(results, expert, learned)

    def _measure(
        self, results: HomeResults, expert: Expert, learned: Sequence[tuple[Imitation, Lesson]]
    ) -> None:
        """Baselines first, since they are quick; then each lesson, measured as soon as it is trained."""
        judge = Judge(self.case, self.store)
        judge.write_exogenous()
        methods = references(self.case, judge, expert)
        optimum = plain_optimum(self.case, judge)
        results = self._put(replace(results, methods=methods, optimum=optimum))
        for one, lesson in learned:
            trained = train_lesson(lesson, self.store)
            runs = judge.judged(lesson.label, trained.mark, partial(self._play, lesson, trained))
            results = self._put(_with(results, one, runs))

    def _play(self, lesson: Lesson, trained: Trained) -> list[Played]:
        keys = jax.random.split(jax.random.key(0), lesson.runs)
        outcomes = evaluate_stacked(self.case.home, self.case.test, trained.controllers, keys)
        return [
            Played(outcome, int(seed), trained.seconds, curve)
            for outcome, seed, curve in zip(outcomes, lesson.task.seed, trained.curves, strict=True)
        ]

    def _put(self, results: HomeResults) -> HomeResults:
        self.ledger.put(results)
        return results


def _with(results: HomeResults, one: Imitation, runs: tuple[Run, ...]) -> HomeResults:
    """The results with those of one more method; HA-1 and HA-2 are points of the data efficiency as well."""
    if one.method != ANY_LENGTH:
        results = replace(results, methods=(*results.methods, MethodResults(one.method, runs, one.days)))
    if one.method not in LENGTHS:
        return results
    lengths = (*results.data_efficiency, MethodResults(ANY_LENGTH, runs, one.days))
    return replace(results, data_efficiency=tuple(sorted(lengths, key=lambda length: length.days or 0)))


def _require_different_names(homes: Sequence[Traces]) -> None:
    names = [home.name for home in homes]
    for name in names:
        if names.count(name) > 1:
            raise HemmaError(f"expected homes with different names, got {name} twice; name each of them once")


def _require_writable(folder: Path) -> None:
    """Find out before hours of work that there is nowhere to put them."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise HemmaError(
            f"{folder}: expected a results folder, cannot make it: {error.strerror}. Choose another: --out"
        ) from error
    if not os.access(folder, os.W_OK | os.X_OK):
        raise HemmaError(f"{folder}: expected a results folder that may be written. Choose another: --out")


def _report(folder: Path, progress: Progress) -> None:
    from hemma.report.report import write_report

    progress.started("report", 1)
    progress.finished("report", str(write_report(folder)))
