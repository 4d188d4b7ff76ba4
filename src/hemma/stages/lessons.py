"""What there is to learn from the expert on one home: which methods, from how many days, how many runs."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from hemma.irl.airl import AdversarialImitation
from hemma.irl.cloning import BehaviourCloning
from hemma.irl.maxent import linear_maxent, neural_maxent
from hemma.irl.reward import AbstractHead, ImitationScore, ShapedReward
from hemma.methods.pupils import PUPILS, Pupil
from hemma.results.fingerprint import fingerprint
from hemma.results.store import Store
from hemma.rl.improvement import Proximal
from hemma.rl.policies.committee import Committee
from hemma.rl.policies.scaling import NOTHING, Context
from hemma.rl.task import Task, make_task, stack
from hemma.rl.training import Algorithm
from hemma.settings.experiment import Experiment
from hemma.stages.case import Case
from hemma.stages.causal import causal_demonstration
from hemma.stages.demonstrate import Demonstration, Expert, demonstration
from hemma.stages.sight import Sight, sight_of
from hemma.stages.train import Lesson

ANY_LENGTH = "AIRL"
"""The method of HA-1 and HA-2 with demonstrations of another length."""


PLAIN = PUPILS["HA-1"]
"""Sees the paper's state and is taught in hindsight."""


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
    pupil: Pupil = PLAIN
    """What it sees, and who teaches it."""


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
    asked = [PUPILS[name] for name in experiment.learned]
    wanted = [
        Imitation(pupil.name, algorithm, days, experiment.seeds, pupil.name, pupil)
        for method, algorithm, days in known
        for pupil in asked
        if pupil.method == method
    ]
    done = {one.days for one in wanted if one.algorithm == ours and one.pupil.is_plain}
    efficiency = experiment.data_efficiency
    others = [days for days in efficiency.days if days not in done and days <= training_days]
    lengths = [
        Imitation(ANY_LENGTH, ours, days, efficiency.seeds, f"{ANY_LENGTH}-{days}-days") for days in others
    ]
    return (*wanted, *lengths)


def lessons(case: Case, expert: Expert, store: Store, wanted: Sequence[Imitation]) -> tuple[Lesson, ...]:
    """The lesson of each: its expert demonstrates, and its task sees those days and nothing else."""
    made: dict[str, Lesson] = {}
    for model in dict.fromkeys(one.pupil.model for one in wanted):
        made |= _alike(case, expert, store, [one for one in wanted if one.pupil.model == model])
    return tuple(made[one.label] for one in wanted)


def _alike(case: Case, expert: Expert, store: Store, wanted: Sequence[Imitation]) -> dict[str, Lesson]:
    """The lessons, by label, of pupils that see the same."""
    sights = {one.label: sight_of(one.pupil, expert, store) for one in wanted}
    shown = {one.label: _shown(one, expert, store, sights[one.label]) for one in wanted}
    sight = sights[wanted[0].label]
    seen = {days: sight.learning(days) for days in {one.days for one in wanted}}
    return {
        one.label: Lesson(
            label=one.label,
            algorithm=one.algorithm,
            task=stack(
                [
                    demonstrated_task(expert, shown[one.label], seed, seen[one.days])
                    for seed in range(one.seeds)
                ]
            ),
            basis=fingerprint("lesson", case.home, shown[one.label].mark, sights[one.label].mark),
            sight=sights[one.label],
        )
        for one in wanted
    }


def _shown(one: Imitation, expert: Expert, store: Store, sight: Sight) -> Demonstration:
    if one.pupil.is_causal:
        return causal_demonstration(store, expert, sight, one.days)
    return demonstration(store, expert, one.days)


def demonstrated_task(expert: Expert, shown: Demonstration, seed: int, context: Context = NOTHING) -> Task:
    """The task of one run that learns from what ``expert`` showed, on the days on which it did."""
    case, days = expert.case, expert.case.first_days(shown.days)
    return make_task(expert.planning_home, case.home, days, shown.demonstrated, seed, context)
