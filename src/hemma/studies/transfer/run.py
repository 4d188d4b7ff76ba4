"""The transfer test: is a reward that was learned in one home worth anything in a changed one?

Fu et al. 2018 (arXiv 1710.11248) claim it for AIRL: the reward carries over where the policy does not.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import jax

from hemma.data import Traces
from hemma.evaluation import evaluate_stacked
from hemma.results.fingerprint import fingerprint
from hemma.results.progress import Progress, Silence
from hemma.results.reading import json_content, write_record
from hemma.results.records import MethodRuns
from hemma.results.store import Store
from hemma.results.summary import method_runs
from hemma.rl.policies.policy import PolicyController
from hemma.settings.experiment import Experiment
from hemma.stages.demonstrate import Expert
from hemma.stages.evaluate import Evaluator, Played
from hemma.stages.identify import IdentifiedBuilding, identify
from hemma.stages.job import at_work, require_long_enough
from hemma.stages.rewards import kept_rewards
from hemma.stages.train import Trained, TrainingJob, train_job, train_jobs
from hemma.studies.transfer.changes import CHANGES, Change, Place, places
from hemma.studies.transfer.document import MeasuredPlace, transfer_record
from hemma.studies.transfer.maps import draw_maps
from hemma.studies.transfer.records import TRANSFER_FILE
from hemma.studies.transfer.report import write_transfer_report
from hemma.studies.transfer.training_jobs import (
    Origin,
    Settled,
    adaptation_jobs,
    airl_job,
    bill_job,
    carried_policies,
    gail_job,
    ground_jobs,
    reward_jobs,
)

ADAPTED, REWARD, GROUND = "adapted by r", "PPO on r", "PPO on g"
POLICY, GAIL = "policy of AIRL", "policy of GAIL"
ANEW, BILL = "AIRL anew", "PPO on the bill"


@dataclass(frozen=True)
class TransferJob:
    """What to test, on which home, and where the results go."""

    experiment: Experiment
    traces: Traces
    folder: Path
    test_from: str | None = None
    command: str = "hemma transfer"
    changes: tuple[Change, ...] = CHANGES
    """The first is none: there the reward is learned."""


def transfer(job: TransferJob, progress: Progress | None = None) -> dict[str, Any]:
    """Learn in the unchanged home, again in each changed one, measure all; the content of ``transfer.json``.

    Every product is kept in the folder as that of the main job is; the same call goes on where it stopped.
    """
    progress = Silence() if progress is None else progress
    tried = places(job.experiment, job.traces, job.changes, job.test_from)
    require_long_enough(tried[0].case)
    with at_work(job.folder, job.command, progress):
        return _transferred(job, tried, Store(job.folder, job.traces.name, progress))


def _transferred(job: TransferJob, tried: tuple[Place, ...], store: Store) -> dict[str, Any]:
    settled = _settled(tried, store)
    first, *changed = settled
    own = airl_job(first)
    trained, *anew = train_jobs([own, *map(airl_job, changed)], store)
    gail = train_job(gail_job(first), store)
    origin = Origin(first, trained, gail, kept_rewards(own.label, store))
    draw_maps(origin, job.folder)
    columns = [*_carried(origin, len(settled)), *_paid(settled, origin, store), _Column(ANEW, (None, *anew))]
    frozen = reward_jobs(settled, origin)
    measured = [
        MeasuredPlace(one.place, dict(_measured(_There(one, training_job), columns, number)))
        for number, (one, training_job) in enumerate(zip(settled, frozen, strict=True))
    ]
    found = transfer_record(job.command, job.experiment, measured)
    write_record(job.folder / TRANSFER_FILE, found)
    write_transfer_report(job.folder)
    return json_content(found)


@dataclass(frozen=True)
class _There:
    """A place, and what a policy from elsewhere finds there."""

    settled: Settled
    frozen: TrainingJob
    """Its task has the home, and the scaler of the unchanged home carried over."""


def _as_trained(trained: Trained, _: TrainingJob) -> PolicyController:
    return trained.controllers


@dataclass(frozen=True)
class _Column:
    """A method, with what it learned for each place."""

    method: str
    trained: tuple[Trained | None, ...]
    """None where it would repeat another."""
    controllers: Callable[[Trained, TrainingJob], PolicyController] = _as_trained


def _carried(origin: Origin, count: int) -> list[_Column]:
    """The policies of the unchanged home, as they are."""
    return [
        _Column(POLICY, (origin.trained,) * count, carried_policies),
        _Column(GAIL, (origin.gail,) * count, carried_policies),
    ]


def _paid(settled: list[Settled], origin: Origin, store: Store) -> list[_Column]:
    """What is trained in every place on a reward."""
    training_jobs = {
        ADAPTED: adaptation_jobs(settled, origin),
        REWARD: reward_jobs(settled, origin),
        GROUND: ground_jobs(settled, origin),
        BILL: [bill_job(one) for one in settled],
    }
    return [_Column(method, train_jobs(made, store)) for method, made in training_jobs.items()]


def _measured(there: _There, columns: Sequence[_Column], number: int) -> Iterator[tuple[str, MethodRuns]]:
    """What each method does in the place of that number."""
    evaluator = Evaluator(there.settled.place.case, there.settled.store)
    for column in columns:
        trained = column.trained[number]
        if trained is not None:
            controllers = column.controllers(trained, there.frozen)
            mark = fingerprint("transfer", there.frozen.mark, trained.mark)
            play = partial(_play, there.settled, controllers, trained.seconds)
            yield column.method, method_runs(evaluator.evaluated(column.method, mark, play))


def _play(settled: Settled, controllers: PolicyController, seconds: float) -> list[Played]:
    """One outcome a seed."""
    case = settled.place.case
    keys = jax.random.split(jax.random.key(0), len(settled.seeds))
    outcomes = evaluate_stacked(case.home, case.test, controllers, keys)
    return [Played(outcome, seed, seconds) for outcome, seed in zip(outcomes, settled.seeds, strict=True)]


def _settled(all_places: tuple[Place, ...], store: Store) -> list[Settled]:
    """Every place with its expert; the network is that of the unchanged home where the building is."""
    old = identify(all_places[0].case, store)
    return [_settle(place, old, store) for place in all_places]


def _settle(place: Place, old: IdentifiedBuilding, store: Store) -> Settled:
    change = place.change
    own = Store(store.folder, f"{store.home}/{change.slug}", store.progress)
    expert = Expert(place.case, identify(place.case, own) if change.is_identified else old)
    believed = expert if change.knows_building else Expert(place.case, old)
    return Settled(place, expert, believed.planning_home, own)
