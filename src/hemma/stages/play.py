"""Let trained controllers run the home through the test period."""

import jax

from hemma.evaluation import evaluate_stacked
from hemma.rl.policies.scaling import NOTHING
from hemma.stages.case import Case
from hemma.stages.judge import Played
from hemma.stages.sight import informed
from hemma.stages.train import Lesson, Trained


def play(case: Case, lesson: Lesson, trained: Trained) -> list[Played]:
    """One outcome a run of the lesson."""
    keys = jax.random.split(jax.random.key(0), lesson.runs)
    context = NOTHING if lesson.sight is None else lesson.sight.in_test()
    outcomes = evaluate_stacked(case.home, case.test, informed(trained.controllers, context), keys)
    return [
        Played(outcome, int(seed), trained.seconds, curve)
        for outcome, seed, curve in zip(outcomes, lesson.task.seed, trained.curves, strict=True)
    ]
