"""The one training loop of every learner: runs side by side, in chunks, resumable, with learning curves."""

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any, Protocol, TypeVar, runtime_checkable

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Float

from hemma.checkpoint import load_header, load_tree, save_tree
from hemma.errors import HemmaError
from hemma.home import HomeState
from hemma.rl.environment import Environment
from hemma.rl.policies.policy import Policy, PolicyController
from hemma.rl.task import Task
from hemma.types import Array

jax.config.update("jax_cpu_enable_async_dispatch", False)  # each call in its own thread, not in XLA's few

Result = TypeVar("Result")

CHUNK = 25
"""Iterations between two looks at a run: one row of its learning curve, one occasion to save it."""
WIDTH = 2
"""Runs in one call of the compiled code, whatever there is to train and whatever it is trained on.

Compiled code adds up in another order where the batch is wider, and training makes another run of it. With a
fixed width every run is the same alone and among others. One run a call takes half as long again for each;
more than two take as long as two.
"""


@runtime_checkable
class Algorithm(Protocol):
    """A learner, one iteration at a time. Frozen and hashable: it is fixed while its loop is compiled.

    The state is an ``eqx.Module`` of arrays that holds all that training carries from iteration to iteration;
    progress is an ``eqx.Module`` of scalars, and the names of its fields head the learning curve.
    """

    @property
    def iterations(self) -> int:
        """How many iterations a training takes, a multiple of ``CHUNK``."""
        ...

    def start(self, task: Task, key: Array) -> Any:
        """The state of one run before its first iteration."""
        ...

    def iterate(self, state: Any, task: Task) -> tuple[Any, Any]:
        """State and progress after one more iteration."""
        ...

    def policy(self, state: Any) -> Policy:
        """The result, as far as training has come."""
        ...


class Curve(eqx.Module):
    """Learning curves: one chunk of one run, or (runs, chunks)."""

    progress: Any
    """Means of the learner's progress over the chunk."""
    training_cost: Float[Array, "*chunks"]
    """X1 + X2 a day of the policy without exploration on its own training days [currency/day]."""
    training_deviation: Float[Array, "*chunks"]
    """Mean X3 of the same [degC]."""


class Training(eqx.Module):
    """Runs under way or finished, stacked along a first axis."""

    state: Any
    curve: Curve

    @property
    def iterations(self) -> int:
        """How many iterations are done."""
        return self.curve.training_cost.shape[1] * CHUNK


def begin(task: Task, algorithm: Algorithm) -> Training:
    """All runs of a stacked task at iteration 0."""
    state = _side_by_side(partial(_start, algorithm=algorithm), task)
    shape = jax.eval_shape(partial(_chunk, algorithm=algorithm), state, task)[1]
    return Training(state, jax.tree.map(lambda x: jnp.zeros((x.shape[0], 0), x.dtype), shape))


def advance(training: Training, task: Task, algorithm: Algorithm) -> Training:
    """All runs, one chunk of iterations further. Raises if a run has diverged."""
    state, row = _side_by_side(partial(_chunk, algorithm=algorithm), training.state, task)
    figures = jnp.stack([jnp.asarray(leaf, float) for leaf in jax.tree.leaves(row)])
    healthy = jnp.all(jnp.isfinite(figures), axis=0)
    if not bool(jnp.all(healthy)):
        failed = [int(s) for s in task.seed[~healthy]]
        raise HemmaError(
            f"{type(algorithm).__name__}: the numbers of seeds {failed} were no longer finite by iteration "
            f"{training.iterations + CHUNK}; lower its learning rates"
        )
    curve = jax.tree.map(lambda old, new: jnp.concatenate([old, new[:, None]], axis=1), training.curve, row)
    return Training(state, curve)


def train(
    task: Task,
    algorithm: Algorithm,
    training: Training | None = None,
    on_chunk: Callable[[Training], None] = lambda _: None,
) -> Training:
    """Run an algorithm to its end, from the beginning or from where ``training`` stands."""
    training = begin(task, algorithm) if training is None else training
    while training.iterations < algorithm.iterations:
        training = advance(training, task, algorithm)
        on_chunk(training)
    return training


def save(path: Path, training: Training, header: dict[str, Any]) -> None:
    """Store runs under way, whole or not at all."""
    save_tree(path, training, {**header, "chunks": training.iterations // CHUNK})


def load(path: Path, task: Task, algorithm: Algorithm) -> Training:
    """What ``save`` stored for the same task and algorithm; going on gives what an unbroken run gives."""
    chunks = load_header(path).get("chunks")
    if not isinstance(chunks, int) or chunks < 0:
        raise HemmaError(f"{path}: expected a training under way, its header has {chunks!r} chunks")
    like = begin(task, algorithm)
    curve = jax.tree.map(lambda x: jnp.zeros((x.shape[0], chunks), x.dtype), like.curve)
    return load_tree(path, Training(like.state, curve))


def controllers(training: Training, task: Task, algorithm: Algorithm) -> PolicyController:
    """The resulting policies as controllers, stacked like the task."""
    return _acting(training.state, task, algorithm)


def blank_controllers(task: Task, algorithm: Algorithm) -> PolicyController:
    """Controllers of these sizes, to be filled from a checkpoint; nothing is computed for it."""
    shapes = eqx.filter_eval_shape(lambda t: _acting(_start(t, algorithm), t, algorithm), task)
    return jax.tree.map(lambda leaf: jnp.zeros(leaf.shape, leaf.dtype), shapes)


def _acting(state: Any, task: Task, algorithm: Algorithm) -> PolicyController:
    policies = eqx.filter_vmap(algorithm.policy)(state)
    return PolicyController(policies, task.environment.scaler, task.environment.planning_home)


def _side_by_side(function: Callable[..., Result], *stacked: Any) -> Result:
    """What ``function`` makes of all runs, ``WIDTH`` of them a call, a call on each core at a time.

    XLA uses little more than one core for a program of many small steps, so each core gets its own calls.
    """
    runs = jax.tree.leaves(stacked)[0].shape[0]
    calls = -(-runs // WIDTH)
    places = jnp.arange(calls * WIDTH) % runs  # the last call is filled up; what is over is cut off

    def call(number: int) -> Result:
        own = places[number * WIDTH : (number + 1) * WIDTH]
        return jax.block_until_ready(function(*jax.tree.map(lambda x: x[own], stacked)))

    cores = os.cpu_count() or 1 if jax.default_backend() == "cpu" else 1
    with ThreadPoolExecutor(min(cores, calls)) as pool:
        parts = list(pool.map(call, range(calls)))
    return jax.tree.map(lambda *leaves: jnp.concatenate(leaves)[:runs], *parts)


@partial(jax.jit, static_argnames="algorithm")
def _start(task: Task, algorithm: Algorithm) -> Any:
    return jax.vmap(lambda t: algorithm.start(t, t.key))(task)


@partial(jax.jit, static_argnames="algorithm")
def _chunk(state: Any, task: Task, algorithm: Algorithm) -> tuple[Any, Curve]:
    def run(state: Any, task: Task) -> tuple[Any, Curve]:
        def iteration(state: Any, _: None) -> tuple[Any, Any]:
            return algorithm.iterate(state, task)

        state, progress = jax.lax.scan(iteration, state, length=CHUNK)
        cost, deviation = _score(algorithm.policy(state), task.environment)
        return state, Curve(jax.tree.map(jnp.mean, progress), cost, deviation)

    return jax.vmap(run)(state, task)


def _score(policy: Policy, environment: Environment) -> tuple[Array, Array]:
    """Daily cost and mean deviation of the mean action on the training traces, padding left out."""
    home = environment.home

    def slot(_: Array, carry: tuple[HomeState, Array, Array]) -> tuple[HomeState, Array, Array]:
        state, cost, deviation = carry
        decision = policy.mean(environment.features(state, state.slot))
        step = environment.step(state, jnp.zeros((), int), decision, policy.space, jnp.zeros(()))[0]
        cost = cost + step.costs.transaction + step.costs.ageing
        return step.state, cost, deviation + step.costs.temperature_deviation

    first = (home.reset(), jnp.zeros(()), jnp.zeros(()))
    _, cost, deviation = jax.lax.fori_loop(0, environment.available, slot, first)
    return cost / (environment.available * home.slot_length / 24), deviation / environment.available
