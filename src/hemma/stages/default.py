"""Stage: Hemma's default controller, the rolling planner with the forecast that the training days favour."""

import time
from dataclasses import dataclass

import jax
import numpy as np

from hemma.control.rolling import RollingPlanner
from hemma.evaluation import evaluate
from hemma.forecasting.combined import MeanForecast, RefittedForecast
from hemma.forecasting.outlook import Forecaster, Outlook, hourly_means, yesterday
from hemma.forecasting.ridge import fitted, needed_past
from hemma.optimisation.optimum import OptimumProblem, optimum_problem
from hemma.results.fingerprint import code, fingerprint
from hemma.results.store import Store
from hemma.settings.experiment import Experiment
from hemma.stages.demonstrate import Expert
from hemma.stages.folds import outlook_of, training_folds

STAGE = "default"


@dataclass(frozen=True)
class Candidate:
    """A forecast that the default controller may plan with."""

    name: str
    forecaster: Forecaster
    needed: int
    """The shortest past that it can be fitted to [slots]."""


@dataclass(frozen=True)
class Choice:
    """The forecast that planned best on training days that it had not seen."""

    candidate: Candidate
    regrets: dict[str, float]
    """Of each candidate over all judged days [currency]; empty where there was nothing to judge on."""
    seconds: float
    """How long the choice took."""


def candidates(experiment: Experiment, outlook: Outlook) -> tuple[Candidate, ...]:
    """In the order of preference; all but the last two are fitted again every so many days."""
    settings = experiment.default
    shape, places = settings.shape.needed_past(outlook), needed_past(outlook)

    def refitted(forecaster: Forecaster) -> RefittedForecast:
        return RefittedForecast(forecaster, settings.refitted)

    return (
        Candidate("mean of both", refitted(MeanForecast((settings.shape, fitted))), max(shape, places)),
        Candidate("shape of the day", refitted(settings.shape), shape),
        Candidate("five places", refitted(fitted), places),
        Candidate("yesterday", yesterday, outlook.day),
        Candidate("hourly means", hourly_means, outlook.day),
    )


def choose_forecast(expert: Expert, store: Store) -> Choice:
    """Plan the judged training days with every candidate; the regret decides.

    The last part of the training period is cut into folds; each is planned by forecasts fitted to the days
    before it. What counts is not how near a forecast comes but what it costs to plan with: the regret, the
    cost beyond perfect information at equal comfort. A candidate is passed over only for one with clearly
    less (``margin``), because a month says little about small differences. A training period too short for
    any fold gets the first candidate that can be fitted to it.
    """
    case = expert.case
    offered = [c for c in candidates(case.experiment, outlook_of(case)) if c.needed <= case.training.slots]
    layers = code("forecasting", "optimisation", "control", "evaluation")
    settings = (case.experiment.default, case.experiment.forecast_horizon)
    mark = fingerprint(STAGE, layers, expert.mark, settings)
    content = store.product(STAGE, mark, lambda: (_judged(expert, store, offered), []), STAGE)
    chosen = next(c for c in offered if c.name == content["chosen"])
    return Choice(chosen, content["regrets"], content["seconds"])


def _judged(expert: Expert, store: Store, offered: list[Candidate]) -> dict:
    """The content of the card: what was chosen, and the regrets [currency]."""
    begun, folds = time.monotonic(), training_folds(expert.case)
    store.progress.started(STAGE, max(len(folds) * len(offered), 1))
    regrets = {c.name: 0.0 for c in offered if folds and c.needed <= folds[0].past.slots}
    done = 0
    for fold in folds:
        problem = optimum_problem(expert.case.home, fold.period)
        for candidate in offered:
            if candidate.name in regrets:
                regrets[candidate.name] += _regret(expert, fold, candidate.forecaster, problem)
            done += 1
            store.progress.advanced(STAGE, done, candidate.name)
    chosen = preferred(regrets, expert.case.experiment.default.margin) if regrets else offered[0].name
    message = f"plans with the forecast called {chosen}"
    store.progress.finished(STAGE, message)
    seconds = time.monotonic() - begun
    return {"chosen": chosen, "regrets": regrets, "seconds": seconds, "message": message}


def preferred(regrets: dict[str, float], margin: float) -> str:
    """The first that no other undercuts by more than ``margin`` of its regret."""
    least = min(regrets.values())
    return next(name for name, regret in regrets.items() if regret - least <= margin * abs(regret))


def _regret(expert: Expert, fold: Outlook, forecaster: Forecaster, problem: OptimumProblem) -> float:
    """What the rolling planner loses in a fold, through the identified network, with this forecast."""
    planner = RollingPlanner(expert.planning_home, forecaster(fold))
    outcome = evaluate(expert.case.home, fold.period, planner, jax.random.key(0))
    return float(np.sum(outcome.cost)) - problem.solve(outcome.total_deviation).cost
