"""PPO and DDPG on the explicit reward; its beta_T is chosen for each by a sweep on the training days."""

from abc import abstractmethod
from dataclasses import dataclass

import jax
import numpy as np

from hemma.errors import HemmaError
from hemma.evaluation import evaluate_stacked
from hemma.methods.looks import DOTTED, MIXED, ORANGE, Look
from hemma.methods.method import AbstractLearner, Group
from hemma.optimisation.optimum import optimum_problem
from hemma.results.fingerprint import code, fingerprint
from hemma.results.store import Store
from hemma.rl.ddpg import DDPG
from hemma.rl.explicit import ExplicitLearning, choose_comfort_price, comfort_prices
from hemma.rl.task import explicit_task, stack
from hemma.rl.training import Algorithm
from hemma.settings.experiment import Experiment
from hemma.stages.case import Case
from hemma.stages.demonstrate import Expert
from hemma.stages.observer import HomeObserver, informed, observer_of
from hemma.stages.train import Trained, TrainingJob, train_job

STAGE = "comfort price"


@dataclass(frozen=True)
class Sweep:
    """A method trained with several beta_T on the first part of the training period, judged on the rest."""

    job: TrainingJob
    trained: Trained
    prices: tuple[float, ...]
    """beta_T of each run [currency/degC for one slot]."""
    chosen: float
    """The one that fares best on the days that the runs did not see."""


@dataclass(frozen=True, kw_only=True)
class AbstractBillLearner(AbstractLearner):
    """A method that is told the bill and what discomfort costs."""

    group: Group = Group.REWARDED
    is_candidate: bool = False

    @abstractmethod
    def algorithm(self, experiment: Experiment) -> Algorithm:
        """How it learns from the reward."""

    def training_job(self, expert: Expert, store: Store) -> TrainingJob:
        """The whole training period, with the beta_T that the sweep chose."""
        case, price = expert.case, self.sweep(expert, store).chosen
        days, seeds = case.first_days(case.training_days), range(case.experiment.seeds)
        observer = observer_of(self.observation_model, expert, store)
        seen = observer.learning(case.training_days)
        task = stack(
            [explicit_task(expert.planning_home, case.home, days, price, seed, seen) for seed in seeds]
        )
        basis = fingerprint("explicit", case.mark, expert.identification.mark, price, observer.mark)
        return TrainingJob(self.name, self.algorithm(case.experiment), task, basis, observer)

    def seen_days(self, experiment: Experiment, training_days: int) -> int:
        """All."""
        return training_days

    def sweep(self, expert: Expert, store: Store) -> Sweep:
        """Train it with each beta_T; choose by regret and deviation on the held-out training days.

        What suits one learner need not suit another: a critic that rounds off the edge of comfort cools the
        more beyond it the more beta_T is.
        """
        case = expert.case
        settings, learned = case.experiment.comfort_price, _learned_days(case)
        days = case.first_days(learned)
        values = comfort_prices(case.home, days, settings.multiples)
        pairs = [(float(value), seed) for value in values for seed in range(settings.seeds)]
        observer = observer_of(self.observation_model, expert, store)
        seen = observer.learning(learned, learned)
        task = stack(
            [explicit_task(expert.planning_home, case.home, days, price, seed, seen) for price, seed in pairs]
        )
        basis = fingerprint(STAGE, case.mark, expert.identification.mark, settings, observer.mark)
        job = TrainingJob(f"{self.name}-sweep", self.algorithm(case.experiment), task, basis, observer)
        trained = train_job(job, store)
        prices = tuple(price for price, _ in pairs)
        return Sweep(job, trained, prices, _chosen(observer, store, job, trained, np.asarray(prices)))


@dataclass(frozen=True, kw_only=True)
class ProximalBillLearner(AbstractBillLearner):
    """PPO."""

    def algorithm(self, experiment: Experiment) -> ExplicitLearning:
        """With settings of its own."""
        return ExplicitLearning(experiment.explicit, experiment.space)


@dataclass(frozen=True, kw_only=True)
class DeterministicBillLearner(AbstractBillLearner):
    """DDPG."""

    def algorithm(self, experiment: Experiment) -> DDPG:
        """With settings of its own."""
        return DDPG(experiment.ddpg)


PPO = ProximalBillLearner(
    name="PPO",
    meaning="reinforcement learning on the hand-written reward −(X1 + X2) − β·X3, on policy",
    look=Look(ORANGE, MIXED, "D"),
)
DDPG_METHOD = DeterministicBillLearner(
    name="DDPG",
    meaning="reinforcement learning on the same hand-written reward, off policy",
    look=Look(ORANGE, DOTTED, "v"),
)


def _learned_days(case: Case) -> int:
    """How many of the training days the runs of the sweep learn from; the others judge them."""
    if case.training_days < 2:
        raise HemmaError(
            f"{case.name}: expected a training period of at least 2 days to choose beta_T of PPO and DDPG, "
            f"got {case.training_days}; give longer traces, or leave both out of the setting `learned`"
        )
    wanted = round(case.training_days * (1 - case.experiment.comfort_price.held_out))
    return min(max(wanted, 1), case.training_days - 1)


def _chosen(
    observer: HomeObserver, store: Store, job: TrainingJob, trained: Trained, prices: np.ndarray
) -> float:
    """beta_T by the mean regret and deviation of its runs on the training days that they did not see."""
    layers = code("rl", "forecasting", "optimisation", "control", "evaluation")
    mark = fingerprint(STAGE, layers, trained.mark)
    product = f"{job.label}-choice"

    def make() -> tuple[dict, list[str]]:
        settings = observer.case.experiment.comfort_price
        regrets, deviations = _measured(observer, trained)
        values = np.asarray(list(dict.fromkeys(prices.tolist())))
        shape = (len(values), settings.seeds)
        mean_regrets, mean_deviations = (x.reshape(shape).mean(axis=1) for x in (regrets, deviations))
        chosen = choose_comfort_price(values, mean_regrets, mean_deviations, settings.tolerance)
        table = {
            "comfort_price": values.tolist(),
            "regret": mean_regrets.tolist(),
            "mean_temperature_deviation": mean_deviations.tolist(),
        }
        return {"chosen": chosen, "sweep": table}, []

    return store.product(product, mark, make)["chosen"]


def _measured(observer: HomeObserver, trained: Trained) -> tuple[np.ndarray, np.ndarray]:
    """Regret at equal comfort [currency] and mean deviation [degC] of each run on the days held out."""
    case = observer.case
    first = case.first_days(_learned_days(case)).slots
    days = case.training.window(first, case.training.slots)
    problem = optimum_problem(case.home, days)
    keys = jax.random.split(jax.random.key(0), trained.runs)
    acting = informed(trained.controllers, observer.held_out(first))
    outcomes = evaluate_stacked(case.home, days, acting, keys)
    regrets = [
        float(np.sum(outcome.cost)) - problem.solve(outcome.total_deviation).cost for outcome in outcomes
    ]
    deviations = [float(np.mean(outcome.temperature_deviation)) for outcome in outcomes]
    return np.asarray(regrets), np.asarray(deviations)
