"""The rolling planners of the results table: what each believes of the hours to come."""

from collections.abc import Sequence
from dataclasses import dataclass

import jax

from hemma.control.rolling import rolling_mpc
from hemma.evaluation import evaluate
from hemma.forecasting.outlook import Forecaster, hourly_means, perfect, yesterday
from hemma.forecasting.published import PublishedPrices
from hemma.forecasting.ridge import fitted, needed_past
from hemma.home import Home, Schedule
from hemma.results.fingerprint import fingerprint
from hemma.results.records import Run
from hemma.results.store import Store
from hemma.stages.default import choose_forecast
from hemma.stages.demonstrate import Expert
from hemma.stages.folds import outlook_of
from hemma.stages.judge import Judge, Played

STAGE = "MPC"


@dataclass(frozen=True)
class Planner:
    """A rolling planner."""

    method: str
    forecaster: Forecaster
    is_causal: bool = True
    """Whether it knows no more than what has happened or been published."""
    facts: tuple = ()
    """What the forecast depends on besides the traces and the horizon."""
    seconds_to_fit: float | None = None
    """How long its forecast took to choose, where there was a choice."""


def planners(expert: Expert, store: Store) -> tuple[Planner, ...]:
    """Those that the training period is long enough for; the first causal one has the best forecast."""
    choice, outlook = choose_forecast(expert, store), outlook_of(expert.case)
    settings = expert.case.experiment.default
    chosen, facts, seconds = choice.candidate.forecaster, (choice.candidate.name, settings), choice.seconds
    published = PublishedPrices(chosen, settings.published_at)
    enough = outlook.past.slots >= needed_past(outlook)
    return (
        Planner("MPC perfect", perfect, is_causal=False),
        Planner("default", chosen, facts=facts, seconds_to_fit=seconds),
        *([Planner("MPC forecast", fitted)] if enough else []),
        Planner("MPC hourly means", hourly_means),
        Planner("MPC yesterday", yesterday),
        Planner("default published", published, facts=facts, seconds_to_fit=seconds),
    )


def played_by(planner: Planner, judge: Judge, expert: Expert) -> tuple[Run, ...]:
    """Its run on the test period, planning through the identified network."""
    mark = fingerprint(STAGE, expert.mark, judge.case.experiment.forecast_horizon, planner.facts)
    return _judged(planner, judge, mark, expert.planning_home, planner.method)


def played_with_true_model(planner: Planner, judge: Judge) -> tuple[Run, ...]:
    """The same, planning through the thermal model of the simulated home: nobody could, it splits regret."""
    case = judge.case
    mark = fingerprint(STAGE, case.mark, case.experiment.forecast_horizon, planner.facts)
    return _judged(planner, judge, mark, case.home, f"{planner.method} with the true model")


def _judged(planner: Planner, judge: Judge, mark: str, planning_home: Home, label: str) -> tuple[Run, ...]:
    case, progress = judge.case, judge.store.progress

    def play() -> Sequence[Played]:
        progress.started(label, 1)
        path = rolling_mpc(planning_home, case.home, case.test, planner.forecaster(outlook_of(case)))
        progress.finished(label, f"{case.test.slots} plans")
        outcome = evaluate(case.home, case.test, Schedule(path.steps.action), jax.random.key(0))
        return [Played(outcome, seconds_to_train=planner.seconds_to_fit)]

    return judge.judged(label, mark, play)
