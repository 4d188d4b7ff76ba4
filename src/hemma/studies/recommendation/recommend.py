"""Stage: which controller this home should have, from its training days alone."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, partial

import jax
import numpy as np
from jaxtyping import Float

from hemma.evaluation import NEGLIGIBLE, Outcome, evaluate, evaluate_stacked
from hemma.forecasting.outlook import DAY, Outlook
from hemma.methods import controls, learners
from hemma.methods.method import AbstractControl, AbstractLearner, AbstractMethod, Known
from hemma.optimisation.optimum import OptimumProblem, optimum_problem
from hemma.results.fingerprint import code, fingerprint
from hemma.results.records import JudgedMethod, Recommendation
from hemma.results.store import Store
from hemma.rl.policies.scaling import NOTHING
from hemma.stages.demonstrate import Expert
from hemma.stages.folds import outlook_of, training_folds
from hemma.stages.observer import informed
from hemma.stages.train import Trained

STAGE = "recommend"


@dataclass(frozen=True)
class Contender:
    """A method that may be recommended."""

    method: AbstractMethod
    play: Callable[[Outlook], Sequence[Outcome]]
    """What it does in a fold, one outcome a run, fitted to nothing but the days before it."""
    needed: int
    """Slots of past that it cannot do without."""


@dataclass(frozen=True)
class Tryout:
    """Judges the contenders of one home."""

    expert: Expert
    store: Store
    trained: Mapping[str, Trained]
    """Learned methods by name."""

    def recommendation(self) -> Recommendation | None:
        """The simplest contender that is about as good as the best; None if there are no days to judge on."""
        found = self.store.product(STAGE, self._mark(), self._made, STAGE)["found"]
        return None if found is None else Recommendation.model_validate(found)

    def _made(self) -> tuple[dict, list[str]]:
        found = self._found()
        judged = None if found is None else found.model_dump(mode="json")
        return {"found": judged, "message": "nothing to judge on" if found is None else found.method}, []

    def _mark(self) -> str:
        experiment = self.expert.case.experiment
        layers = code("forecasting", "optimisation", "control", "evaluation", "methods")
        settings = (experiment.default, experiment.forecast_horizon, experiment.demonstration_days)
        contenders = [(one.method, self._mark_of(one)) for one in self._contenders()]
        return fingerprint(STAGE, layers, self.expert.mark, settings, contenders)

    def _mark_of(self, contender: Contender) -> str | None:
        trained = self.trained.get(contender.method.name)
        return None if trained is None else trained.mark

    def _found(self) -> Recommendation | None:
        folds = training_folds(self.expert.case)
        contenders = [c for c in self._contenders() if folds and c.needed <= folds[0].past.slots]
        if not contenders:
            return None
        self.store.progress.started(STAGE, len(folds) * len(contenders))
        days = {c.method.name: [] for c in contenders}
        deviations = {c.method.name: [] for c in contenders}
        for number, fold in enumerate(folds):
            optimum = _optimum(optimum_problem(self.expert.case.home, fold.period))
            for place, contender in enumerate(contenders):
                name, outcomes = contender.method.name, contender.play(fold)
                days[name].append(daily_costs(outcomes, optimum, fold.day))
                deviations[name] += [np.mean(o.temperature_deviation) for o in outcomes]
                self.store.progress.advanced(STAGE, number * len(contenders) + place + 1, name)
        costs = {method: np.concatenate(parts) for method, parts in days.items()}
        found = recommend(costs, {method: float(np.mean(d)) for method, d in deviations.items()})
        self.store.progress.finished(STAGE, found.method)
        return found

    def _contenders(self) -> list[Contender]:
        """From the simplest to the one that takes most."""
        known = Known(self.expert, self.store, outlook_of(self.expert.case))
        found = [
            Contender(method, partial(self._controls, method), method.needed_past(known))
            for method in controls()
            if method.is_candidate and method.is_causal
        ]
        for name, trained in self.trained.items():
            method = learners()[name]
            if method.is_candidate:
                found.append(Contender(method, partial(self._acts, trained), self._seen(method)))
        return sorted(found, key=lambda contender: contender.method.effort)

    def _seen(self, method: AbstractLearner) -> int:
        """Slots of the training period that it has learned from."""
        case = self.expert.case
        days = method.seen_days(case.experiment, case.training_days)
        return round(days * DAY / float(case.home.slot_length))

    def _controls(self, method: AbstractControl, fold: Outlook) -> list[Outcome]:
        controller = method.controller(Known(self.expert, self.store, fold))
        return [evaluate(self.expert.case.home, fold.period, controller, jax.random.key(0))]

    def _acts(self, trained: Trained, fold: Outlook) -> Sequence[Outcome]:
        keys = jax.random.split(jax.random.key(0), trained.runs)
        observer = trained.observer
        seen = NOTHING if observer is None else observer.held_out(fold.past.slots, fold.period.slots)
        acting = informed(trained.controllers, seen)
        return evaluate_stacked(self.expert.case.home, fold.period, acting, keys)


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
    is likely to disappoint least. Among methods of the same cost the one that keeps comfort best is taken.
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
    simplest = next(one for one in judged if one.excess <= one.standard_error)
    alike = [one for one in judged if abs(_known(one.daily_cost) - _known(simplest.daily_cost)) <= NEGLIGIBLE]
    chosen = min(alike, key=lambda one: _known(one.mean_temperature_deviation)).method
    return Recommendation(method=chosen, days=len(costs[best]), judged=tuple(judged))


def _known(value: float | None) -> float:
    return np.inf if value is None else value
