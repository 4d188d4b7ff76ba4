"""Stage: train a learner, all its runs side by side, saved while under way."""

import time
from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from itertools import accumulate
from pathlib import Path

import jax
import jax.numpy as jnp

from hemma.checkpoint import load_header, load_tree, save_tree
from hemma.errors import HemmaError
from hemma.forecasting.observations import PAPER
from hemma.results.fingerprint import code, fingerprint
from hemma.results.store import Store
from hemma.rl.policies.policy import PolicyController
from hemma.rl.task import Task
from hemma.rl.training import Algorithm, Training, blank_controllers, controllers, load, save, train
from hemma.stages.curves import write_curves
from hemma.stages.observer import HomeObserver
from hemma.stages.rewards import keep_rewards

STAGE = "train"
SECONDS_BETWEEN_SAVES = 20.0


@dataclass(frozen=True, eq=False)
class TrainingJob:
    """What some runs learn, side by side."""

    label: str
    """Of its files, and of the stage."""
    algorithm: Algorithm
    task: Task
    """One run a seed, stacked."""
    basis: str
    """Fingerprint of all that the task was made from."""
    observer: HomeObserver | None = None
    """What the policies see besides the paper's state, if anything."""

    @property
    def runs(self) -> int:
        """How many runs there are."""
        return self.task.seed.shape[0]

    @property
    def kind(self) -> Hashable:
        """Jobs of one kind can be trained together: the same algorithm, as many features, as much room."""
        return self.algorithm, self.task.environment.context.shape[1:]

    @property
    def mark(self) -> str:
        """Fingerprint of all that the trained controllers depend on."""
        seeds = [int(seed) for seed in self.task.seed]
        return fingerprint(STAGE, code("rl", "irl"), self.algorithm, self.basis, seeds)


@dataclass(frozen=True)
class Trained:
    """The product of the stage: one controller a run, stacked."""

    controllers: PolicyController
    curves: tuple[str, ...]
    """Paths of the learning curves inside the folder."""
    seconds: float
    """Wall-clock time in which all runs were trained side by side, compilation included; of jobs trained
    together each has the share of its runs [s]."""
    mark: str
    observer: HomeObserver | None = None
    """What the policies see besides the paper's state, if anything."""

    @property
    def runs(self) -> int:
        """How many runs there are."""
        return self.controllers.scaler.centre.shape[0]


@dataclass(frozen=True)
class _ResumableTraining:
    """A training job under way."""

    job: TrainingJob
    store: Store

    @property
    def under_way(self) -> Path:
        """Where the state of an unfinished training lies."""
        return self.store.folder / self.store.model(f"{self.job.label}.training.safetensors")

    def train(self) -> tuple[Training, float]:
        """Train to the end, from where an interrupted run stopped; also the seconds it took in total."""
        training, before = self._earlier()
        clock = _Clock(time.monotonic() - before)
        latest = training

        def on_chunk(now: Training) -> None:
            nonlocal latest
            latest = now
            self.store.progress.advanced(self.job.label, now.iterations, _message(now))
            if clock.should_save():
                self._save(now, clock)

        try:
            training = train(self.job.task, self.job.algorithm, training, on_chunk)
        except KeyboardInterrupt:
            if latest is not None:
                self._save(latest, clock)
            raise
        return training, clock.seconds

    def _earlier(self) -> tuple[Training | None, float]:
        try:
            header = load_header(self.under_way)
            if header.get("fingerprint") != self.job.mark or not isinstance(header.get("seconds"), float):
                return None, 0.0
            training = load(self.under_way, self.job.task, self.job.algorithm)
        except HemmaError:
            return None, 0.0
        self.store.progress.noticed(
            f"{self.job.label}: going on from iteration {training.iterations} of an interrupted run"
        )
        return training, header["seconds"]

    def _save(self, training: Training, clock: "_Clock") -> None:
        save(self.under_way, training, {"fingerprint": self.job.mark, "seconds": clock.seconds})
        clock.saved()


class _Clock:
    """How long a training has taken, and when its state was last saved."""

    def __init__(self, begun: float):
        self._begun = begun
        self._saved = time.monotonic()

    @property
    def seconds(self) -> float:
        return time.monotonic() - self._begun

    def should_save(self) -> bool:
        return time.monotonic() - self._saved >= SECONDS_BETWEEN_SAVES

    def saved(self) -> None:
        self._saved = time.monotonic()


def train_jobs(jobs: Sequence[TrainingJob], store: Store) -> tuple[Trained, ...]:
    """The controllers of jobs of one kind: those of earlier calls, and the rest trained together.

    Together they fill every call of the compiled code. The learning curves are written beside the
    controllers.
    """
    missing = [job for job in jobs if store.kept(job.label, job.mark) is None]
    for job in jobs:
        if job not in missing:
            store.progress.reused(job.label, f"{job.runs} runs")
    if missing:
        _train(missing, store)
    return tuple(_taken(job, store) for job in jobs)


def train_all(jobs: Sequence[TrainingJob], store: Store) -> dict[str, Trained]:
    """The controllers of each job by its label; those of one kind are trained in one call."""
    trained: dict[str, Trained] = {}
    for kind in dict.fromkeys(job.kind for job in jobs):
        same = [job for job in jobs if job.kind == kind]
        trained |= zip([job.label for job in same], train_jobs(same, store), strict=True)
    return trained


def train_job(job: TrainingJob, store: Store) -> Trained:
    """The controllers of one job."""
    return train_jobs([job], store)[0]


def _train(jobs: Sequence[TrainingJob], store: Store) -> None:
    whole = _together(jobs)
    store.progress.started(whole.label, whole.algorithm.iterations)
    resumable = _ResumableTraining(whole, store)
    training, seconds = resumable.train()
    ends = list(accumulate(job.runs for job in jobs))
    for job, start, stop in zip(jobs, [0, *ends], ends, strict=False):
        part = jax.tree.map(lambda x, own=slice(start, stop): x[own], training)
        _keep(job, part, seconds * job.runs / whole.runs, store)
    resumable.under_way.unlink(missing_ok=True)
    store.progress.finished(whole.label, f"{whole.runs} runs side by side. {_message(training)}")


def _together(jobs: Sequence[TrainingJob]) -> TrainingJob:
    """All runs of the jobs as one job."""
    first = jobs[0]
    if len(jobs) == 1:
        return first
    task = jax.tree.map(lambda *leaves: jnp.concatenate(leaves), *[job.task for job in jobs])
    basis = fingerprint("together", [job.mark for job in jobs])
    return TrainingJob(f"{first.label}-and-{len(jobs) - 1}-more", first.algorithm, task, basis)


def _keep(job: TrainingJob, training: Training, seconds: float, store: Store) -> None:
    curves, file = _curves(job, store), store.model(f"{job.label}.safetensors")
    home = jax.tree.map(lambda x: x[0], job.task.environment.home)
    write_curves(store.folder, curves, training.curve, home)
    made = controllers(training, job.task, job.algorithm)
    seen = PAPER.name if job.observer is None else job.observer.model.name
    save_tree(
        store.folder / file,
        made,
        {"fingerprint": job.mark, "observation_model": seen, "actions": made.policy.space.name},
    )
    rewards = keep_rewards(training, job.task, job.label, store)
    store.keep(job.label, job.mark, [file, *rewards, *curves], {"seconds": seconds})


def _taken(job: TrainingJob, store: Store) -> Trained:
    content = store.kept(job.label, job.mark)
    if content is None:
        raise HemmaError(
            f"{job.label}: expected the controllers just trained in {store.folder}, they are gone or "
            "changed; let one run at a time use a results folder, and run the same command again"
        )
    like = blank_controllers(job.task, job.algorithm)
    stored = load_tree(store.folder / store.model(f"{job.label}.safetensors"), like)
    return Trained(stored, _curves(job, store), content["seconds"], job.mark, job.observer)


def _curves(job: TrainingJob, store: Store) -> tuple[str, ...]:
    return tuple(store.curve(f"{job.label}-{run}.csv") for run in range(job.runs))


def _message(training: Training) -> str:
    cost, deviation = training.curve.training_cost[:, -1], training.curve.training_deviation[:, -1]
    return f"training days: {cost.mean():.3f} a day, deviation {deviation.mean():.3f} °C"
