"""Stage: train a learner, all its runs side by side, saved while under way."""

import time
from dataclasses import dataclass
from pathlib import Path

import equinox as eqx
import jax
import jax.numpy as jnp

from hemma.checkpoint import load_header, load_tree, save_tree
from hemma.errors import HemmaError
from hemma.experiment.curves import write_curves
from hemma.experiment.fingerprint import code, fingerprint
from hemma.experiment.store import Store
from hemma.rl.policy import PolicyController
from hemma.rl.task import Task
from hemma.rl.training import Algorithm, Training, begin, controllers, load, save, train

STAGE = "train"
SECONDS_BETWEEN_SAVES = 20.0


@dataclass(frozen=True)
class Lesson:
    """What some runs learn, side by side."""

    label: str
    """Of its files, and of the stage."""
    algorithm: Algorithm
    task: Task
    """One run a seed, stacked."""
    basis: str
    """Fingerprint of all that the task was made from."""

    @property
    def runs(self) -> int:
        """How many runs there are."""
        return self.task.seed.shape[0]

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
    """Wall-clock time in which all runs were trained side by side, compilation included [s]."""
    mark: str


@dataclass(frozen=True)
class _Classroom:
    """A lesson under way."""

    lesson: Lesson
    store: Store

    @property
    def under_way(self) -> Path:
        """Where the state of an unfinished training lies."""
        return self.store.folder / self.store.model(f"{self.lesson.label}.training.safetensors")

    def train(self) -> tuple[Training, float]:
        """Train to the end, from where an interrupted run stopped; also the seconds it took in total."""
        training, before = self._earlier()
        clock = _Clock(time.monotonic() - before)
        latest = training

        def on_chunk(now: Training) -> None:
            nonlocal latest
            latest = now
            self.store.progress.advanced(self.lesson.label, now.iterations, _message(now))
            if clock.should_save():
                self._save(now, clock)

        try:
            training = train(self.lesson.task, self.lesson.algorithm, training, on_chunk)
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
        if header.get("fingerprint") != self.lesson.mark:
            return None, 0.0
        training = load(self.under_way, self.lesson.task, self.lesson.algorithm)
        self.store.progress.noticed(
            f"{self.lesson.label}: going on from iteration {training.iterations} of an interrupted run"
        )
        return training, header["seconds"]

    def _save(self, training: Training, clock: "_Clock") -> None:
        save(self.under_way, training, {"fingerprint": self.lesson.mark, "seconds": clock.seconds})
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


def train_lesson(lesson: Lesson, store: Store) -> Trained:
    """Train all runs of a lesson, or take the controllers that an earlier call trained.

    The learning curves are written beside the controllers.
    """
    label, mark, seeds = lesson.label, lesson.mark, [int(seed) for seed in lesson.task.seed]
    file = store.model(f"{label}.safetensors")
    curves = tuple(store.curve(f"{label}-{run}.csv") for run in range(lesson.runs))
    content = store.kept(label, mark)
    if content is not None:
        store.progress.reused(label, f"{lesson.runs} runs")
    else:
        store.progress.started(label, lesson.algorithm.iterations)
        classroom = _Classroom(lesson, store)
        training, seconds = classroom.train()
        home = jax.tree.map(lambda x: x[0], lesson.task.environment.home)
        write_curves(store.folder, curves, training.curve, home)
        content = {"seconds": seconds, "seeds": seeds}
        made = controllers(training, lesson.task, lesson.algorithm)
        save_tree(store.folder / file, made, {"fingerprint": mark})
        store.keep(label, mark, [file, *curves], content)
        classroom.under_way.unlink(missing_ok=True)
        store.progress.finished(label, f"{lesson.runs} runs side by side. {_message(training)}")
    stored = load_tree(store.folder / file, _structure(lesson))
    return Trained(stored, curves, content["seconds"], mark)


def _structure(lesson: Lesson) -> PolicyController:
    """Controllers of these sizes, to be filled from a checkpoint; nothing is computed for it."""
    algorithm = lesson.algorithm
    shapes = eqx.filter_eval_shape(lambda t: controllers(begin(t, algorithm), t, algorithm), lesson.task)
    return jax.tree.map(lambda leaf: jnp.zeros(leaf.shape, leaf.dtype), shapes)


def _message(training: Training) -> str:
    cost, deviation = training.curve.training_cost[:, -1], training.curve.training_deviation[:, -1]
    return f"training days: {cost.mean():.3f} a day, deviation {deviation.mean():.3f} °C"
