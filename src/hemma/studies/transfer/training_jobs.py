"""What is learned for the transfer test: in the unchanged home, and again in each changed one."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import jax

from hemma.home import Home
from hemma.irl.airl import AdversarialImitation
from hemma.irl.learned_reward import LearnedReward
from hemma.irl.reoptimise import (
    FrozenReward,
    Inheritance,
    InheritedReoptimisation,
    Reoptimisation,
    frozen_task,
    ground,
)
from hemma.irl.reward import ImitationScore, ShapedReward
from hemma.results.fingerprint import fingerprint
from hemma.results.store import Store
from hemma.rl.carry_over import carried_over
from hemma.rl.explicit import ExplicitLearning, ExplicitSettings, comfort_prices
from hemma.rl.improvement import Proximal
from hemma.rl.policies.policy import PolicyController, StochasticPolicy
from hemma.rl.task import Task, explicit_task, make_task, stack
from hemma.settings.experiment import Experiment
from hemma.stages.demonstrate import Demonstration, Expert, demonstration
from hemma.stages.train import Trained, TrainingJob
from hemma.studies.transfer.changes import ChangedCase

COMFORT_MULTIPLE = 4.0
"""beta_T of PPO on the bill in the unit of ``comfort_prices``; set before any run, no sweep chose it."""


@dataclass(frozen=True)
class Settled:
    """A place, once its building is identified."""

    changed: ChangedCase
    expert: Expert
    planning_home: Home
    """What counts a policy's fractions from comfort; the expert's unless the change went unnoticed."""
    store: Store
    """Of this place."""

    @property
    def label(self) -> str:
        """Begins the names of its files."""
        return self.changed.change.slug

    @property
    def experiment(self) -> Experiment:
        """The settings, with the changed home."""
        return self.changed.case.experiment

    @property
    def seeds(self) -> range:
        """Of its runs."""
        return range(self.experiment.seeds)

    @property
    def mark(self) -> str:
        """Fingerprint of the home, its days and what counts its fractions."""
        return fingerprint("settled", self.expert.mark, self.planning_home)

    def task(self, comfort_price: float, seed: int) -> Task:
        """The task of learning from the explicit reward on the days of the demonstrations."""
        case = self.changed.case
        days = case.first_days(self.experiment.demonstration_days)
        return explicit_task(self.planning_home, case.home, days, comfort_price, seed)


@dataclass(frozen=True)
class Origin:
    """What was learned in the unchanged home."""

    settled: Settled
    trained: Trained
    """Policies of AIRL."""
    gail: Trained
    rewards: LearnedReward

    def head(self, seed: int) -> ShapedReward:
        """r of a run."""
        return self.rewards.run(seed).head

    def policy(self, seed: int) -> StochasticPolicy:
        """The policy of a run."""
        return jax.tree.map(lambda x: x[seed], self.trained.controllers.policy)


def imitation_job(settled: Settled, algorithm: AdversarialImitation, name: str) -> TrainingJob:
    """Adversarial imitation of the expert of that place."""
    shown = demonstration(settled.store, settled.expert, settled.experiment.demonstration_days)
    task = stack([_demonstrated(settled, shown, seed) for seed in settled.seeds])
    return TrainingJob(
        f"{settled.label}-{name}", algorithm, task, fingerprint("shown", settled.mark, shown.mark)
    )


def airl_job(settled: Settled) -> TrainingJob:
    """AIRL from the demonstrations of that place: one agent, so that a run has one reward to carry over."""
    experiment = settled.experiment
    return imitation_job(
        settled, AdversarialImitation(experiment.airl, Proximal(experiment.ppo, experiment.space)), "AIRL"
    )


def gail_job(settled: Settled) -> TrainingJob:
    """GAIL from the same."""
    experiment = settled.experiment
    gail = AdversarialImitation(experiment.airl, Proximal(experiment.ppo, experiment.space), ImitationScore)
    return imitation_job(settled, gail, "GAIL")


def reward_jobs(settled: Sequence[Settled], origin: Origin) -> list[TrainingJob]:
    """PPO on the whole r in every place."""
    return [_frozen_job(one, origin, _Pay("r", lambda seed: origin.head(seed))) for one in settled]


def ground_jobs(settled: Sequence[Settled], origin: Origin) -> list[TrainingJob]:
    """PPO on g alone in every place."""
    return [_frozen_job(one, origin, _Pay("g", lambda seed: ground(origin.head(seed)))) for one in settled]


def adaptation_jobs(settled: Sequence[Settled], origin: Origin) -> list[TrainingJob]:
    """PPO on the whole r in every place, from the policy that was learned with it, as cautious as AIRL's."""
    pay = _Pay("adapted", lambda seed: Inheritance(origin.head(seed), origin.policy(seed)))
    experiment = origin.settled.experiment
    settings = ExplicitSettings(experiment.airl.iterations, experiment.airl.exploration, experiment.ppo)
    learning = ExplicitLearning(settings, experiment.space)
    algorithm = InheritedReoptimisation(Reoptimisation(learning, experiment.airl.entropy))
    training_jobs = [_frozen_job(one, origin, pay) for one in settled]
    return [replace(one, algorithm=algorithm) for one in training_jobs]


@dataclass(frozen=True)
class _Pay:
    """What is paid by, for each seed."""

    name: str
    teacher: Callable[[int], FrozenReward]


def _frozen_job(settled: Settled, origin: Origin, pay: _Pay) -> TrainingJob:
    """PPO as bold as on the bill, on what each run's learned reward pays; its scaler is carried over."""
    battery = origin.settled.changed.case.home.battery

    def task(seed: int) -> Task:
        scaler = carried_over(origin.rewards.run(seed).scaler, battery, settled.changed.case.home.battery)
        return frozen_task(settled.task(0.0, seed), pay.teacher(seed), scaler)

    basis = fingerprint("frozen", settled.mark, origin.trained.mark, pay.name)
    stacked = stack([task(seed) for seed in settled.seeds])
    experiment = settled.experiment
    learning = ExplicitLearning(experiment.explicit, experiment.space)
    algorithm = Reoptimisation(learning, experiment.airl.entropy)
    return TrainingJob(f"{settled.label}-{pay.name}", algorithm, stacked, basis)


def bill_job(settled: Settled) -> TrainingJob:
    """PPO on the explicit reward of that place, which knows its bill: what no imitator is told."""
    case, days = settled.changed.case, settled.experiment.demonstration_days
    [price] = comfort_prices(case.home, case.first_days(days), [COMFORT_MULTIPLE])
    task = stack([settled.task(float(price), seed) for seed in settled.seeds])
    basis = fingerprint("bill", settled.mark, float(price))
    return TrainingJob(
        f"{settled.label}-bill",
        ExplicitLearning(settled.experiment.explicit, settled.experiment.space),
        task,
        basis,
    )


def carried_policies(trained: Trained, training_job: TrainingJob) -> PolicyController:
    """Policies as they were learned elsewhere, in the home and behind the scaler of a frozen training_job."""
    environment = training_job.task.environment
    return PolicyController(trained.controllers.policy, environment.scaler, environment.planning_home)


def _demonstrated(settled: Settled, shown: Demonstration, seed: int) -> Task:
    case = settled.changed.case
    days = case.first_days(shown.days)
    space = settled.experiment.space
    return make_task(settled.planning_home, case.home, days, shown.demonstrated, seed, space=space)
