"""The rolling planners of the results table: what each believes of the hours to come."""

from collections.abc import Sequence
from dataclasses import dataclass

import jax

from hemma.baselines.fitted_forecast import fitted, needed_past
from hemma.baselines.forecast import Forecaster, Outlook, hourly_means, perfect, yesterday
from hemma.baselines.rolling import rolling_mpc
from hemma.evaluation import evaluate
from hemma.experiment.case import Case
from hemma.experiment.demonstrate import Expert
from hemma.experiment.fingerprint import fingerprint
from hemma.experiment.judge import Judge, Played
from hemma.experiment.results import Run
from hemma.home import Home, Schedule

STAGE = "MPC"


@dataclass(frozen=True)
class Planner:
    """A rolling planner."""

    method: str
    forecaster: Forecaster
    is_causal: bool
    """Whether it knows the past alone."""


ALL = (
    Planner("MPC perfect", perfect, is_causal=False),
    Planner("MPC forecast", fitted, is_causal=True),
    Planner("MPC hourly means", hourly_means, is_causal=True),
    Planner("MPC yesterday", yesterday, is_causal=True),
)


def planners(case: Case) -> tuple[Planner, ...]:
    """Those that the training period is long enough for; the first causal one has the best forecast."""
    outlook = _outlook(case)
    enough = outlook.past.slots >= needed_past(outlook)
    return tuple(planner for planner in ALL if enough or planner.forecaster is not fitted)


def played_by(planner: Planner, judge: Judge, expert: Expert) -> tuple[Run, ...]:
    """Its run on the test period, planning through the identified network."""
    mark = fingerprint(STAGE, expert.mark, judge.case.experiment.forecast_horizon)
    return _judged(planner, judge, mark, expert.planning_home, planner.method)


def played_with_true_model(planner: Planner, judge: Judge) -> tuple[Run, ...]:
    """The same, planning through the thermal model of the simulated home: nobody could, it splits regret."""
    case = judge.case
    mark = fingerprint(STAGE, case.mark, case.experiment.forecast_horizon)
    return _judged(planner, judge, mark, case.home, f"{planner.method} with the true model")


def _judged(planner: Planner, judge: Judge, mark: str, planning_home: Home, label: str) -> tuple[Run, ...]:
    case, progress = judge.case, judge.store.progress

    def play() -> Sequence[Played]:
        progress.started(label, 1)
        path = rolling_mpc(planning_home, case.home, case.test, planner.forecaster(_outlook(case)))
        progress.finished(label, f"{case.test.slots} plans")
        outcome = evaluate(case.home, case.test, Schedule(path.steps.action), jax.random.key(0))
        return [Played(outcome)]

    return judge.judged(label, mark, play)


def _outlook(case: Case) -> Outlook:
    slot_length, horizon = float(case.home.slot_length), case.experiment.forecast_horizon
    return Outlook(case.training, case.test, slot_length, horizon)
