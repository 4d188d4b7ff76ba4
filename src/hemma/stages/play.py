"""Let trained controllers run the home through the test period."""

import jax

from hemma.evaluation import evaluate_stacked
from hemma.rl.policies.scaling import NOTHING
from hemma.stages.case import Case
from hemma.stages.evaluate import Played
from hemma.stages.sight import informed
from hemma.stages.train import Trained, TrainingJob


def play(case: Case, job: TrainingJob, trained: Trained) -> list[Played]:
    """One outcome a run of the job."""
    keys = jax.random.split(jax.random.key(0), job.runs)
    context = NOTHING if job.sight is None else job.sight.in_test()
    outcomes = evaluate_stacked(case.home, case.test, informed(trained.controllers, context), keys)
    return [
        Played(outcome, int(seed), trained.seconds, curve)
        for outcome, seed, curve in zip(outcomes, job.task.seed, trained.curves, strict=True)
    ]
