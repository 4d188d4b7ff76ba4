"""What there is to learn from the expert on one home: which methods, from how many days, how many runs."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import accumulate

import jax

from hemma.experiment.case import Case
from hemma.experiment.demonstrate import Demonstration, Expert, demonstration
from hemma.experiment.fingerprint import fingerprint
from hemma.experiment.settings import Experiment
from hemma.experiment.store import Store
from hemma.experiment.train import Lesson
from hemma.irl.airl import AdversarialImitation
from hemma.irl.cloning import BehaviourCloning
from hemma.irl.maxent import linear_maxent, neural_maxent
from hemma.irl.reward import AbstractHead, ImitationScore, ShapedReward
from hemma.rl import task
from hemma.rl.committee import Committee
from hemma.rl.improvement import Proximal
from hemma.rl.task import Task, make_task
from hemma.rl.training import Algorithm

ANY_LENGTH = "AIRL"
"""The method of HA-1 and HA-2 with demonstrations of another length."""


@dataclass(frozen=True)
class Imitation:
    """A method that learns from demonstrations."""

    method: str
    algorithm: Algorithm
    days: int
    """Length of the demonstrations."""
    seeds: int
    label: str
    """Of its files, and of the stage."""


def airl(experiment: Experiment, head: type[AbstractHead] = ShapedReward) -> Committee:
    """The method of HA-1 and HA-2, or with another head GAIL."""
    settings = experiment.airl
    by_ppo = Proximal(replace(experiment.ppo, rollouts=settings.rollouts))
    return Committee(AdversarialImitation(settings, by_ppo, head), settings.members)


def imitations(experiment: Experiment, training_days: int) -> tuple[Imitation, ...]:
    """The methods to run where the training period has so many days, HA-1 first.

    HA-2 takes what there is where the training period is shorter than its demonstrations should be.
    """
    short = experiment.demonstration_days
    long = min(experiment.long_demonstration_days, training_days)
    by_ppo, ours = Proximal(experiment.ppo), airl(experiment)
    known = (
        ("HA-1", ours, short),
        ("HA-2", ours, long),
        ("GAIL", airl(experiment, ImitationScore), short),
        ("MaxEnt IRL", linear_maxent(experiment.maxent, by_ppo), long),
        ("MaxEnt IRL neural", neural_maxent(experiment.maxent, by_ppo), long),
        ("BC", BehaviourCloning(experiment.cloning), short),
    )
    wanted = [
        Imitation(method, algorithm, days, experiment.seeds, method)
        for method, algorithm, days in known
        if method in experiment.learned
    ]
    done = {one.days for one in wanted if one.algorithm == ours}
    efficiency = experiment.data_efficiency
    others = [days for days in efficiency.days if days not in done and days <= training_days]
    lengths = [
        Imitation(ANY_LENGTH, ours, days, efficiency.seeds, f"{ANY_LENGTH}-{days}-days") for days in others
    ]
    return (*wanted, *lengths)


def lessons(case: Case, expert: Expert, store: Store, wanted: Sequence[Imitation]) -> tuple[Lesson, ...]:
    """The lesson of each: its expert demonstrates, and its task sees those days and nothing else.

    All tasks are padded to one length, so that those with as many runs share compiled code.
    """
    if not wanted:
        return ()
    shown = {days: demonstration(store, expert, days) for days in dict.fromkeys(one.days for one in wanted)}
    runs = [(shown[one.days], seed) for one in wanted for seed in range(one.seeds)]
    together = task.stack([demonstrated_task(expert, d, seed) for d, seed in runs])
    ends = list(accumulate(one.seeds for one in wanted))
    return tuple(
        Lesson(
            label=one.label,
            algorithm=one.algorithm,
            task=jax.tree.map(lambda x, part=slice(*part): x[part], together),
            basis=_basis(case, shown[one.days]),
        )
        for one, part in zip(wanted, zip([0, *ends], ends, strict=False), strict=True)
    )


def demonstrated_task(expert: Expert, shown: Demonstration, seed: int) -> Task:
    """The task of one run that learns from what ``expert`` showed, on the days on which it did."""
    case = expert.case
    return make_task(expert.planning_home, case.home, case.first_days(shown.days), shown.demonstrated, seed)


def _basis(case: Case, shown: Demonstration) -> str:
    return fingerprint("lesson", case.home, shown.mark)
