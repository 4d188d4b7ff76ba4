"""Many training runs at once: seeds, homes and demonstration lengths in one compiled call, resumable."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Float

from hemma.checkpoint import load_header, load_tree, save_tree
from hemma.errors import HemmaError
from hemma.home import HomeState, Step, observe
from hemma.irl import airl
from hemma.irl.airl import CHUNK, AIRLSettings, Progress, TrainingState
from hemma.irl.task import Task
from hemma.rl.environment import Environment
from hemma.rl.policy import GaussianPolicy, PolicyController
from hemma.types import Array


class Curve(eqx.Module):
    """Learning curves: one chunk of one run, or (runs, chunks)."""

    progress: Progress
    """Means over the chunk."""
    training_cost: Float[Array, "*chunks"]
    """X1 + X2 a day of the policy without exploration on its own training days [currency/day]."""
    training_deviation: Float[Array, "*chunks"]
    """Mean X3 of the same [degC]."""


class Training(eqx.Module):
    """Runs under way or finished, stacked along a first axis."""

    state: TrainingState
    curve: Curve

    @property
    def iterations(self) -> int:
        """How many iterations of Algorithm 1 are done."""
        return self.curve.training_cost.shape[1] * CHUNK


def begin(task: Task, settings: AIRLSettings) -> Training:
    """All runs of a stacked task at iteration 0."""
    state = _start(task, settings)
    shape = jax.eval_shape(partial(_chunk, settings=settings), state, task)[1]
    return Training(state, jax.tree.map(lambda x: jnp.zeros((x.shape[0], 0), x.dtype), shape))


def advance(training: Training, task: Task, settings: AIRLSettings) -> Training:
    """All runs, one chunk of iterations further. Raises if a run has diverged."""
    state, row = _chunk(training.state, task, settings)
    healthy = jnp.isfinite(row.progress.discriminator_loss) & jnp.isfinite(row.training_cost)
    if not bool(jnp.all(healthy)):
        failed = [int(s) for s in task.seed[~healthy]]
        raise HemmaError(
            f"AIRL: the numbers of seeds {failed} were no longer finite by iteration "
            f"{training.iterations + CHUNK}; lower airl.learning_rate or airl.ppo.learning_rate"
        )
    curve = jax.tree.map(lambda old, new: jnp.concatenate([old, new[:, None]], axis=1), training.curve, row)
    return Training(state, curve)


def train(
    task: Task,
    settings: AIRLSettings,
    training: Training | None = None,
    on_chunk: Callable[[Training], None] = lambda _: None,
) -> Training:
    """Run Algorithm 1 to its end, from the beginning or from where ``training`` stands."""
    training = begin(task, settings) if training is None else training
    while training.iterations < settings.iterations:
        training = advance(training, task, settings)
        on_chunk(training)
    return training


def save(path: Path, training: Training, header: dict[str, Any]) -> None:
    """Store runs under way, whole or not at all."""
    save_tree(path, training, {**header, "chunks": training.iterations // CHUNK})


def load(path: Path, task: Task, settings: AIRLSettings) -> Training:
    """What ``save`` stored for the same task and settings; going on gives what an unbroken run gives."""
    like = begin(task, settings)
    chunks = load_header(path)["chunks"]
    curve = jax.tree.map(lambda x: jnp.zeros((x.shape[0], chunks), x.dtype), like.curve)
    return load_tree(path, Training(like.state, curve))


def controllers(training: Training, task: Task) -> PolicyController:
    """The averaged policies as controllers, stacked like the task."""
    return PolicyController(training.state.average, task.environment.scaler, task.environment.home)


@partial(jax.jit, static_argnames="settings")
def _start(task: Task, settings: AIRLSettings) -> TrainingState:
    return jax.vmap(lambda t: airl.start(t.environment, settings, jax.random.key(t.seed)))(task)


@partial(jax.jit, static_argnames="settings")
def _chunk(state: TrainingState, task: Task, settings: AIRLSettings) -> tuple[TrainingState, Curve]:
    def run(state: TrainingState, task: Task) -> tuple[TrainingState, Curve]:
        def iteration(state: TrainingState, _: None) -> tuple[TrainingState, Progress]:
            return airl.iterate(state, task.environment, task.expert, settings)

        state, progress = jax.lax.scan(iteration, state, length=CHUNK)
        cost, deviation = _score(state.average, task.environment)
        return state, Curve(jax.tree.map(jnp.mean, progress), cost, deviation)

    return jax.vmap(run)(state, task)


def _score(policy: GaussianPolicy, environment: Environment) -> tuple[Array, Array]:
    """Daily cost and mean deviation of the mean action on the training traces, padding left out."""
    home, traces = environment.home, environment.exogenous
    controller = PolicyController(policy, environment.scaler, home)

    def slot(state: HomeState, now) -> tuple[HomeState, Step]:
        action = controller(observe(state, now), jax.random.key(0))
        step = home.step(state, now, action, jnp.zeros(()))
        return step.state, step

    _, steps = jax.lax.scan(slot, home.reset(), traces)
    counted = jnp.arange(traces.slots) < environment.available
    days = environment.available * home.slot_length / 24
    cost = jnp.sum(jnp.where(counted, steps.costs.transaction + steps.costs.ageing, 0.0)) / days
    return cost, jnp.sum(jnp.where(counted, steps.costs.temperature_deviation, 0.0)) / environment.available
