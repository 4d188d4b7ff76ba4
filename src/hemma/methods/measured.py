"""Let methods run the home through the test period and measure what they did."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import jax

from hemma.evaluation import evaluate, evaluate_stacked
from hemma.home import AbstractController
from hemma.methods.hindsight import DNLP
from hemma.methods.method import AbstractControl, Known
from hemma.methods.planners import AbstractPlanner
from hemma.optimisation.nonlinear_programme import casadi_is_installed
from hemma.results.fingerprint import code, fingerprint
from hemma.results.records import Run
from hemma.rl.policies.scaling import NOTHING
from hemma.stages.case import Case
from hemma.stages.demonstrate import Expert
from hemma.stages.evaluate import Evaluator, Played
from hemma.stages.folds import outlook_of
from hemma.stages.observer import informed
from hemma.stages.train import Trained, TrainingJob

STAGE = "baselines"


def known_in_test(evaluator: Evaluator, expert: Expert) -> Known:
    """What methods may go by in the test period."""
    return Known(expert, evaluator.store, outlook_of(evaluator.case), evaluator.problem)


def runnable(methods: tuple[AbstractControl, ...], known: Known) -> list[AbstractControl]:
    """Those that the past is long enough for; DNLP only where its solver is installed."""
    enough = [method for method in methods if method.needed_past(known) <= known.outlook.past.slots]
    if DNLP in enough and not casadi_is_installed():
        known.store.progress.noticed("DNLP is left out: it needs CasADi, pip install 'hemma[nlp]'")
        enough.remove(DNLP)
    return enough


def measured(method: AbstractControl, evaluator: Evaluator, known: Known) -> tuple[Run, ...]:
    """The run of a method in the test period, or that of an earlier call."""
    act = _Act(
        method.name,
        _mark(method, known),
        partial(method.controller, known),
        isinstance(method, AbstractPlanner),
    )
    return _evaluated(evaluator, act, method.seconds_to_fit(known))


def measured_with_true_model(planner: AbstractPlanner, evaluator: Evaluator, known: Known) -> tuple[Run, ...]:
    """A planner through the thermal model of the simulated home: nobody could, it splits regret."""
    label = f"{planner.name} with the true model"
    mark = fingerprint("true model", _mark(planner, known))
    act = _Act(label, mark, partial(planner.through, evaluator.case.home, known), True)
    return _evaluated(evaluator, act, planner.seconds_to_fit(known))


@dataclass(frozen=True)
class _Act:
    """Something to be measured."""

    label: str
    mark: str
    controller: Callable[[], AbstractController]
    is_told: bool
    """Whether it takes so long that its progress is told."""


def _evaluated(evaluator: Evaluator, act: _Act, seconds_to_fit: float | None) -> tuple[Run, ...]:
    case, progress = evaluator.case, evaluator.store.progress

    def acted() -> Sequence[Played]:
        if act.is_told:
            progress.started(act.label, 1)
        outcome = evaluate(case.home, case.test, act.controller(), jax.random.key(0))
        if act.is_told:
            progress.finished(act.label, f"{case.test.slots} plans")
        return [Played(outcome, seconds_to_train=seconds_to_fit)]

    return evaluator.evaluated(act.label, act.mark, acted)


def play(case: Case, job: TrainingJob, trained: Trained) -> list[Played]:
    """One outcome a run of the job."""
    keys = jax.random.split(jax.random.key(0), job.runs)
    context = NOTHING if job.observer is None else job.observer.in_test()
    outcomes = evaluate_stacked(case.home, case.test, informed(trained.controllers, context), keys)
    return [
        Played(outcome, int(seed), trained.seconds, curve)
        for outcome, seed, curve in zip(outcomes, job.task.seed, trained.curves, strict=True)
    ]


def _mark(method: AbstractControl, known: Known) -> str:
    horizon = known.expert.case.experiment.forecast_horizon
    return fingerprint(STAGE, code("methods"), known.expert.mark, method, horizon, method.facts(known))
