"""What one training run learns from: its own days, the demonstrations on them, and a seed."""

from collections.abc import Sequence

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float, Int

from hemma.errors import HemmaError
from hemma.home import Home
from hemma.irl.airl import Expert
from hemma.rl.actions import to_fractions
from hemma.rl.environment import Environment, Transitions
from hemma.rl.scaling import fit_scaler
from hemma.types import Action, Array, Exogenous

ENERGY = 2
"""Position of E in the paper's state."""


class Demonstrated(eqx.Module):
    """Demonstrations as anyone may bring them: the paper's states and actions in their units."""

    states: Float[Array, "samples 7"]
    """s = (p, l, E, T_out, T_in, u, t')."""
    actions: Float[Array, "samples 2"]
    """a = (e, h) [kW], feasible."""
    next_states: Float[Array, "samples 7"]
    """s'."""


class Task(eqx.Module):
    """One run, or many stacked along a first axis."""

    environment: Environment
    expert: Expert
    seed: Int[Array, "*runs"]


def make_task(home: Home, exogenous: Exogenous, demonstrated: Demonstrated, seed: int) -> Task:
    """The task of learning from ``demonstrated`` and the traces ``exogenous`` of the same days, nothing else.

    The scaler is fitted to the demonstrated states.
    """
    if len(demonstrated.actions) != exogenous.slots - 1:
        raise HemmaError(
            f"demonstrations: expected {exogenous.slots - 1} transitions for traces of {exogenous.slots} "
            f"slots, got {len(demonstrated.actions)}; demonstrate and train on the same days"
        )
    scaler = fit_scaler(np.asarray(demonstrated.states))
    actions = Action(*jnp.asarray(demonstrated.actions, float).T)
    energy = jnp.asarray(demonstrated.states, float)[:, ENERGY]
    transitions = Transitions(
        features=scaler(jnp.asarray(demonstrated.states, float)),
        fractions=to_fractions(home, energy, actions),
        next_features=scaler(jnp.asarray(demonstrated.next_states, float)),
    )
    traces = jax.tree.map(lambda x: jnp.asarray(x, float), exogenous)
    home = jax.tree.map(lambda x: jnp.asarray(x, float), home)
    return Task(
        environment=Environment(home, traces, jnp.asarray(exogenous.slots), scaler),
        expert=Expert(transitions, jnp.asarray(len(demonstrated.actions))),
        seed=jnp.asarray(seed),
    )


def stack(tasks: Sequence[Task]) -> Task:
    """All tasks along a new first axis; shorter ones are padded with zeros that nobody reads."""
    slots = max(task.environment.exogenous.slots for task in tasks)
    samples = max(task.expert.transitions.fractions.shape[0] for task in tasks)

    def padded(task: Task) -> Task:
        return eqx.tree_at(
            lambda t: (t.environment.exogenous, t.expert.transitions),
            task,
            (_pad(task.environment.exogenous, slots), _pad(task.expert.transitions, samples)),
        )

    return jax.tree.map(lambda *leaves: jnp.stack(leaves), *[padded(task) for task in tasks])


def _pad(tree, length: int):
    return jax.tree.map(lambda x: jnp.pad(x, [(0, length - x.shape[0])] + [(0, 0)] * (x.ndim - 1)), tree)
