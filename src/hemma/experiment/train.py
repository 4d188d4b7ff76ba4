"""Stage: train HA-1, all its runs side by side, saved while under way."""

import time
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate
from pathlib import Path

import equinox as eqx
import jax
import jax.numpy as jnp

from hemma.checkpoint import load_header, load_tree, save_tree
from hemma.errors import HemmaError
from hemma.experiment.case import Case
from hemma.experiment.curves import write_curves
from hemma.experiment.demonstrate import Demonstration
from hemma.experiment.fingerprint import code, fingerprint
from hemma.experiment.store import Store
from hemma.irl.airl import AIRLSettings
from hemma.irl.task import Task, make_task, stack
from hemma.irl.training import Training, begin, controllers, load, save, train
from hemma.rl.policy import PolicyController

STAGE = "train"
SECONDS_BETWEEN_SAVES = 20.0


@dataclass(frozen=True)
class Lesson:
    """What some runs learn from, side by side, with the seeds 0, 1, ..."""

    label: str
    """Of its files, and of the stage."""
    demonstration: Demonstration
    seeds: int


@dataclass(frozen=True)
class Trained:
    """The product of the stage: one controller a seed, stacked."""

    controllers: PolicyController
    curves: tuple[str, ...]
    """Paths of the learning curves inside the folder."""
    seconds: float
    """Wall-clock time in which all seeds were trained side by side, compilation included [s]."""
    mark: str


@dataclass(frozen=True)
class _Classroom:
    """A lesson under way: all its seeds are trained in one compiled call."""

    label: str
    task: Task
    settings: AIRLSettings
    mark: str
    store: Store

    @property
    def under_way(self) -> Path:
        """Where the state of an unfinished training lies."""
        return self.store.folder / self.store.model(f"{self.label}.training.safetensors")

    def train(self) -> tuple[Training, float]:
        """Train to the end, from where an interrupted run stopped; also the seconds it took in total."""
        training, before = self._earlier()
        clock = _Clock(time.monotonic() - before)
        latest = training

        def on_chunk(now: Training) -> None:
            nonlocal latest
            latest = now
            self.store.progress.advanced(self.label, now.iterations, _message(now))
            if clock.should_save():
                self._save(now, clock)

        try:
            training = train(self.task, self.settings, training, on_chunk)
        except KeyboardInterrupt:
            if latest is not None:
                self._save(latest, clock)
            raise
        return training, clock.seconds

    def _earlier(self) -> tuple[Training | None, float]:
        try:
            header = load_header(self.under_way)
        except HemmaError:
            return None, 0.0
        if header.get("fingerprint") != self.mark:
            return None, 0.0
        training = load(self.under_way, self.task, self.settings)
        self.store.progress.noticed(
            f"{self.label}: going on from iteration {training.iterations} of an interrupted run"
        )
        return training, header["seconds"]

    def _save(self, training: Training, clock: "_Clock") -> None:
        save(self.under_way, training, {"fingerprint": self.mark, "seconds": clock.seconds})
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


def tasks(lessons: Sequence[Lesson], case: Case) -> list[Task]:
    """The tasks of the lessons, padded to one length, so that all with as many seeds share compiled code.

    Each learns from its demonstrations and the traces of the same days, and from nothing else.
    """
    seeds = [(lesson, seed) for lesson in lessons for seed in range(lesson.seeds)]
    together = stack(
        [
            make_task(case.home, case.first_days(shown.days), shown.demonstrated, seed)
            for lesson, seed in seeds
            for shown in [lesson.demonstration]
        ]
    )
    ends = list(accumulate(lesson.seeds for lesson in lessons))
    parts = zip([0, *ends], ends, strict=False)
    return [jax.tree.map(lambda x, part=part: x[slice(*part)], together) for part in parts]


def train_lesson(lesson: Lesson, task: Task, case: Case, store: Store) -> Trained:
    """Train all seeds of a lesson, or take the controllers that an earlier run trained.

    The learning curves are written beside the controllers.
    """
    settings, label = case.experiment.airl, lesson.label
    mark = fingerprint(STAGE, code("rl", "irl"), case.home, settings, lesson.demonstration.mark, lesson.seeds)
    file = store.model(f"{label}.safetensors")
    curves = tuple(store.curve(f"{label}-{seed}.csv") for seed in range(lesson.seeds))
    content = store.kept(label, mark)
    if content is not None:
        store.progress.reused(label, f"{lesson.seeds} runs")
    else:
        store.progress.started(label, settings.iterations)
        classroom = _Classroom(label, task, settings, mark, store)
        training, seconds = classroom.train()
        write_curves(store.folder, curves, training.curve, case.home)
        content = {"seconds": seconds}
        save_tree(store.folder / file, controllers(training, task), {"fingerprint": mark})
        store.keep(label, mark, [file, *curves], content)
        classroom.under_way.unlink(missing_ok=True)
        store.progress.finished(label, f"{lesson.seeds} runs side by side. {_message(training)}")
    stored = load_tree(store.folder / file, _structure(task, settings))
    return Trained(stored, curves, content["seconds"], mark)


def _structure(task: Task, settings: AIRLSettings) -> PolicyController:
    """Controllers of these sizes, to be filled from a checkpoint; nothing is computed for it."""
    shapes = eqx.filter_eval_shape(lambda t: controllers(begin(t, settings), t), task)
    return jax.tree.map(lambda leaf: jnp.zeros(leaf.shape, leaf.dtype), shapes)


def _message(training: Training) -> str:
    cost, deviation = training.curve.training_cost[:, -1], training.curve.training_deviation[:, -1]
    return f"training days: {cost.mean():.3f} a day, deviation {deviation.mean():.3f} °C"
