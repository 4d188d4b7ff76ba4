"""Let trained controllers run the home through the test period."""

import jax

from hemma.evaluation import evaluate_stacked
from hemma.experiment.case import Case
from hemma.experiment.judge import Played
from hemma.experiment.sight import informed
from hemma.experiment.train import Lesson, Trained
from hemma.rl.scaling import NOTHING


def play(case: Case, lesson: Lesson, trained: Trained) -> list[Played]:
    """One outcome a run of the lesson."""
    keys = jax.random.split(jax.random.key(0), lesson.runs)
    context = NOTHING if lesson.sight is None else lesson.sight.in_test()
    outcomes = evaluate_stacked(case.home, case.test, informed(trained.controllers, context), keys)
    return [
        Played(outcome, int(seed), trained.seconds, curve)
        for outcome, seed, curve in zip(outcomes, lesson.task.seed, trained.curves, strict=True)
    ]
