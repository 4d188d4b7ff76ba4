"""Stage: which controller this home should have, from its training days alone."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache

import jax
import numpy as np
from jaxtyping import Float

from hemma.control.comfort import ComfortHold
from hemma.control.rule import Rule
from hemma.control.thresholds import fit_thresholds
from hemma.evaluation import Outcome, evaluate, evaluate_stacked
from hemma.forecasting.outlook import DAY, Forecaster, Outlook
from hemma.forecasting.ridge import fitted, needed_past
from hemma.home import Controller
from hemma.optimisation.optimum import OptimumProblem, optimum_problem
from hemma.results.fingerprint import code, fingerprint
from hemma.results.records import JudgedMethod, Recommendation
from hemma.results.store import Store
from hemma.stages.default import Choice
from hemma.stages.demonstrate import Expert
from hemma.stages.folds import outlook_of, planned, training_folds
from hemma.stages.train import Trained

STAGE = "recommend"

Play = Callable[[Outlook], Sequence[Outcome]]
"""What a method does in a fold, one outcome a run, fitted to nothing but the days before it."""


@dataclass(frozen=True)
class Contender:
    """A method that may be recommended."""

    method: str
    play: Play
    needed: int = 0
    """Slots of past that it cannot do without."""


@dataclass(frozen=True)
class Tryout:
    """Judges the contenders of one home."""

    expert: Expert
    store: Store
    choice: Choice
    imitator: Trained | None = None
    """HA-1's controllers; they have seen the first days of the training period, and no others."""

    def recommendation(self) -> Recommendation | None:
        """The simplest contender that is about as good as the best; None if there are no days to judge on."""
        mark = self._mark()
        content = self.store.kept(STAGE, mark)
        if content is None:
            found = self._found()
            judged = None if found is None else found.model_dump(mode="json")
            self.store.keep(STAGE, mark, [], {"found": judged})
            return found
        found = content["found"]
        if found is None:
            return None
        self.store.progress.reused(STAGE, found["method"])
        return Recommendation.model_validate(found)

    def _mark(self) -> str:
        imitator = None if self.imitator is None else self.imitator.mark
        settings = self.expert.case.experiment
        layers = code("forecasting", "optimisation", "control", "evaluation")
        chosen = self.choice.candidate.name
        return fingerprint(
            STAGE, layers, self.expert.mark, imitator, settings.default, settings.forecast_horizon, chosen
        )

    def _found(self) -> Recommendation | None:
        folds = training_folds(self.expert.case)
        contenders = [c for c in self._contenders() if folds and c.needed <= folds[0].past.slots]
        if not contenders:
            return None
        self.store.progress.started(STAGE, len(folds) * len(contenders))
        days = {c.method: [] for c in contenders}
        deviations = {c.method: [] for c in contenders}
        for number, fold in enumerate(folds):
            optimum = _optimum(optimum_problem(self.expert.case.home, fold.period))
            for place, contender in enumerate(contenders):
                outcomes = contender.play(fold)
                days[contender.method].append(daily_costs(outcomes, optimum, fold.day))
                deviations[contender.method] += [np.mean(o.temperature_deviation) for o in outcomes]
                done = number * len(contenders) + place + 1
                self.store.progress.advanced(STAGE, done, contender.method)
        costs = {method: np.concatenate(parts) for method, parts in days.items()}
        found = recommend(costs, {method: float(np.mean(d)) for method, d in deviations.items()})
        self.store.progress.finished(STAGE, found.method)
        return found

    def _contenders(self) -> tuple[Contender, ...]:
        """From the simplest to the one that takes most."""
        case, believed = self.expert.case, self.expert.planning_home
        chosen = self.choice.candidate
        outlook = outlook_of(case)
        known = (
            Contender("Rule", self._controller(lambda _: Rule(case.home.hvac, case.home.comfort))),
            Contender("no battery", self._controller(lambda _: ComfortHold(believed))),
            Contender(
                "thresholds", self._controller(lambda fold: fit_thresholds(believed, fold.past)), outlook.day
            ),
            Contender("MPC forecast", self._planner(fitted), needed_past(outlook)),
            Contender("default", self._planner(chosen.forecaster), chosen.needed),
        )
        if self.imitator is None:
            return known
        seen = round(case.experiment.demonstration_days * DAY / float(case.home.slot_length))
        return (*known, Contender("HA-1", self._imitates, seen))

    def _controller(self, make: Callable[[Outlook], Controller]) -> Play:
        home = self.expert.case.home
        return lambda fold: [evaluate(home, fold.period, make(fold), jax.random.key(0))]

    def _planner(self, forecaster: Forecaster) -> Play:
        return lambda fold: [planned(self.expert, fold, forecaster)]

    def _imitates(self, fold: Outlook) -> Sequence[Outcome]:
        assert self.imitator is not None
        controllers = self.imitator.controllers
        keys = jax.random.split(jax.random.key(0), controllers.scaler.centre.shape[0])
        return evaluate_stacked(self.expert.case.home, fold.period, controllers, keys)


def _optimum(problem: OptimumProblem) -> Callable[[float | None], float]:
    return cache(lambda deviation: problem.solve(deviation).cost)


def daily_costs(
    outcomes: Sequence[Outcome], optimum: Callable[[float | None], float], day: int
) -> Float[np.ndarray, "days"]:
    """X1 + X2 of every day of ``day`` slots [currency], mean over the runs, at equal comfort.

    ``optimum(D)`` is what perfect information costs [currency] with a total deviation of D [degC], None for
    the least possible. What a run saved by leaving the band, optimum(None) - optimum(D), is taken back,
    spread over the days.
    """
    costs = []
    for outcome in outcomes:
        saved = optimum(None) - optimum(outcome.total_deviation)
        days = outcome.cost.reshape(-1, day).sum(axis=1)
        costs.append(days + saved / len(days))
    return np.mean(costs, axis=0)


def recommend(costs: dict[str, Float[np.ndarray, "days"]], deviations: dict[str, float]) -> Recommendation:
    """The first method whose mean exceeds the least by no more than the standard error of the difference.

    ``costs`` [currency/day] are of the same days, in the order of simplicity. One standard error is the rule
    of Breiman et al. 1984 for choosing among models: of those that cannot be told from the best the simplest
    is likely to disappoint least.
    """
    best = min(costs, key=lambda method: float(np.mean(costs[method])))
    judged = []
    for method, days in costs.items():
        excess = days - costs[best]
        error = float(np.std(excess, ddof=1) / np.sqrt(len(excess))) if len(excess) > 1 else 0.0
        judged.append(
            JudgedMethod(
                method=method,
                daily_cost=float(np.mean(days)),
                excess=float(np.mean(excess)),
                standard_error=error,
                mean_temperature_deviation=deviations[method],
            )
        )
    chosen = next(one.method for one in judged if one.excess <= one.standard_error)
    return Recommendation(method=chosen, days=len(costs[best]), judged=tuple(judged))
