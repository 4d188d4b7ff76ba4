"""Stage: the methods that learn from the explicit reward, its beta_T chosen on the training days."""

from dataclasses import dataclass

import jax
import numpy as np

from hemma.errors import HemmaError
from hemma.evaluation import evaluate_stacked
from hemma.methods.pupils import PAID, PUPILS
from hemma.optimisation.optimum import optimum_problem
from hemma.results.fingerprint import code, fingerprint
from hemma.results.store import Store
from hemma.rl.ddpg import DDPG
from hemma.rl.explicit import ExplicitLearning, choose_comfort_price, comfort_prices
from hemma.rl.task import explicit_task, stack
from hemma.settings.experiment import Experiment
from hemma.stages.case import Case
from hemma.stages.demonstrate import Expert
from hemma.stages.sight import Sight, informed, sight_of
from hemma.stages.train import Lesson, Trained, train_lesson

STAGE = "comfort price"


@dataclass(frozen=True)
class Sweep:
    """A method trained with several beta_T on the first part of the training period, judged on the rest."""

    method: str
    """Its name, as in ``PUPILS``."""
    lesson: Lesson
    trained: Trained
    prices: tuple[float, ...]
    """beta_T of each run [currency/degC for one slot]."""
    chosen: float
    """The one that fares best on the days that the runs did not see."""


def explicit_methods(experiment: Experiment) -> tuple[str, ...]:
    """Those of this stage that are asked for."""
    asked = [PUPILS[name] for name in experiment.learned]
    return tuple(pupil.name for method in PAID for pupil in asked if pupil.method == method)


def sweep_comfort_price(expert: Expert, store: Store, method: str) -> Sweep:
    """Train ``method`` with each beta_T; choose by regret and deviation on the held-out training days.

    What suits one learner need not suit another: a critic that rounds off the edge of comfort cools the more
    beyond it the more beta_T is.
    """
    case = expert.case
    settings, seen = case.experiment.comfort_price, case.first_days(_seen_days(case))
    values = comfort_prices(case.home, seen, settings.multiples)
    prices = [float(value) for value in values for _ in range(settings.seeds)]
    seeds = [seed for _ in values for seed in range(settings.seeds)]
    pairs = zip(prices, seeds, strict=True)
    planning_home, home, sight = expert.planning_home, case.home, sight_of(PUPILS[method], expert, store)
    context = sight.learning(_seen_days(case), _seen_days(case))
    task = stack([explicit_task(planning_home, home, seen, price, seed, context) for price, seed in pairs])
    basis = fingerprint(STAGE, case.mark, expert.identification.mark, settings, sight.mark)
    lesson = Lesson(f"{method}-sweep", _algorithm(case.experiment, method), task, basis, sight)
    trained = train_lesson(lesson, store)
    chosen = _chosen(sight, store, lesson, trained, np.asarray(prices))
    return Sweep(method, lesson, trained, tuple(prices), chosen)


def explicit_lesson(expert: Expert, store: Store, method: str, comfort_price: float) -> Lesson:
    """``method`` on the whole training period."""
    case, planning_home = expert.case, expert.planning_home
    days, seeds = case.first_days(case.training_days), range(case.experiment.seeds)
    sight = sight_of(PUPILS[method], expert, store)
    context = sight.learning(case.training_days)
    task = stack(
        [explicit_task(planning_home, case.home, days, comfort_price, seed, context) for seed in seeds]
    )
    basis = fingerprint("explicit", case.mark, expert.identification.mark, comfort_price, sight.mark)
    return Lesson(method, _algorithm(case.experiment, method), task, basis, sight)


def _seen_days(case: Case) -> int:
    """How many of the training days the runs of the sweep learn from; the others judge them."""
    if case.training_days < 2:
        raise HemmaError(
            f"{case.name}: expected a training period of at least 2 days to choose beta_T of PPO and DDPG, "
            f"got {case.training_days}; give longer traces, or leave both out of the setting `learned`"
        )
    wanted = round(case.training_days * (1 - case.experiment.comfort_price.held_out))
    return min(max(wanted, 1), case.training_days - 1)


def _algorithm(experiment: Experiment, method: str) -> ExplicitLearning | DDPG:
    if PUPILS[method].method == "PPO":
        return ExplicitLearning(experiment.explicit)
    return DDPG(experiment.ddpg)


def _chosen(sight: Sight, store: Store, lesson: Lesson, trained: Trained, prices: np.ndarray) -> float:
    """beta_T by the mean regret and deviation of its runs on the training days that they did not see."""
    mark = fingerprint(
        STAGE, code("rl", "forecasting", "optimisation", "control", "evaluation"), trained.mark
    )
    product = f"{lesson.label}-choice"
    content = store.kept(product, mark)
    if content is not None:
        return content["chosen"]
    settings = sight.case.experiment.comfort_price
    regrets, deviations = _judged(sight, trained)
    values = np.asarray(list(dict.fromkeys(prices.tolist())))
    shape = (len(values), settings.seeds)
    mean_regrets, mean_deviations = (x.reshape(shape).mean(axis=1) for x in (regrets, deviations))
    chosen = choose_comfort_price(values, mean_regrets, mean_deviations, settings.tolerance)
    table = {
        "comfort_price": values.tolist(),
        "regret": mean_regrets.tolist(),
        "mean_temperature_deviation": mean_deviations.tolist(),
    }
    store.keep(product, mark, [], {"chosen": chosen, "sweep": table})
    return chosen


def _judged(sight: Sight, trained: Trained) -> tuple[np.ndarray, np.ndarray]:
    """Regret at equal comfort [currency] and mean deviation [degC] of each run on the days held out."""
    case = sight.case
    first = case.first_days(_seen_days(case)).slots
    days = case.training.window(first, case.training.slots)
    problem = optimum_problem(case.home, days)
    runs = trained.controllers.scaler.centre.shape[0]
    keys = jax.random.split(jax.random.key(0), runs)
    acting = informed(trained.controllers, sight.held_out(first))
    outcomes = evaluate_stacked(case.home, days, acting, keys)
    regrets = [
        float(np.sum(outcome.cost)) - problem.solve(outcome.total_deviation).cost for outcome in outcomes
    ]
    deviations = [float(np.mean(outcome.temperature_deviation)) for outcome in outcomes]
    return np.asarray(regrets), np.asarray(deviations)
