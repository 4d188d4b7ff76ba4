"""Run a controller on a home over a period: the one loop that every layer above shares."""

from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from hemma.home.controller import AbstractController
from hemma.home.home import Home, HomeState, Step, observe
from hemma.home.precision import in_double
from hemma.types import Action, Array, Exogenous, Observation


class Trajectory(eqx.Module):
    """A period as it went: ``slots`` entries of what happened, and the fence posts after each slot."""

    observations: Observation
    """What there was to see, shape (slots,)."""
    steps: Step
    """What each slot did, shape (slots,); ``steps.state`` stands at the end of the slot."""
    memory: Any = ()
    """What the controller remembers after the last slot."""

    @property
    def energy_cost(self) -> Float[Array, ""]:
        """Sum of X1 + X2 over the period [currency], objective (1)."""
        return jnp.sum(self.steps.costs.transaction + self.steps.costs.ageing)

    @property
    def temperature_deviation(self) -> Float[Array, ""]:
        """Sum of X3 over the period [degC], objective (2)."""
        return jnp.sum(self.steps.costs.temperature_deviation)


def replay(
    home: Home,
    exogenous: Exogenous,
    controller: AbstractController,
    initial: HomeState,
    key: Array,
    disturbances: Float[Array, "slots"] | None = None,
) -> Trajectory:
    """Let ``controller`` run ``home`` from ``initial`` through all slots of ``exogenous``.

    The slot counter starts at 0. ``disturbances`` are epsilon_t [degC]; without them the home draws its own.
    The key feeds them and the controller, each its own part. A controller that can be traced runs in one
    compiled loop, another in a Python loop; both do the same.
    """
    noise_key, controller_key = jax.random.split(key)
    if disturbances is None:
        disturbances = home.disturbances(noise_key, exogenous.slots)
    initial = eqx.tree_at(lambda state: state.slot, initial, jnp.zeros((), int))
    inputs = (exogenous, disturbances, jax.random.split(controller_key, exogenous.slots))
    if not controller.is_traceable:
        return _stepwise(home, controller, initial, inputs)

    def slot(carry: tuple[HomeState, Any], inputs: tuple[Exogenous, Array, Array]):
        state, memory = carry
        now, disturbance, key = inputs
        observation = observe(state, now)
        action, memory = controller(observation, memory, key)
        step = home.step(state, now, action, disturbance)
        return (step.state, memory), (observation, step)

    (_, memory), (observations, steps) = jax.lax.scan(slot, (initial, controller.start()), inputs)
    return Trajectory(observations, steps, memory)


def replay_in_double(
    home: Home,
    exogenous: Exogenous,
    controller: AbstractController,
    initial: HomeState | None = None,
    key: Array | None = None,
    disturbances: Float[Array, "slots"] | None = None,
) -> Trajectory:
    """``replay`` in float64, whatever the controller was trained in; all numbers come back as NumPy arrays.

    From the home's own initial state, with a fixed key, unless others are given. Compiled once for each kind
    of controller.
    """
    with jax.enable_x64(True):
        begin = home.reset() if initial is None else initial
        random = jax.random.key(0) if key is None else key
        inputs = in_double((home, exogenous, controller, begin, random, disturbances))
        path = (_compiled if controller.is_traceable else replay)(*inputs)
        return jax.tree.map(lambda x: x if _is_key(x) else np.asarray(x), path)


def _is_key(leaf: object) -> bool:
    return isinstance(leaf, jax.Array) and jnp.issubdtype(leaf.dtype, jax.dtypes.prng_key)


_compiled = eqx.filter_jit(replay)


def _stepwise(
    home: Home, controller: AbstractController, state: HomeState, inputs: tuple[Exogenous, Array, Array]
) -> Trajectory:
    """The loop in Python: only the home is compiled."""
    memory, passed = controller.start(), []
    observation, key = _observed(state, inputs)
    for _ in range(inputs[0].slots):
        action, memory = controller(observation, memory, key)
        step, following = _advanced(home, state, inputs, action)
        passed.append((observation, step))
        state, (observation, key) = step.state, following
    observations, steps = jax.tree.map(lambda *slots: np.stack(slots), *passed)
    return Trajectory(observations, steps, memory)


@eqx.filter_jit
def _observed(state: HomeState, inputs: tuple[Exogenous, Array, Array]) -> tuple[Observation, Array]:
    now, _, key = jax.tree.map(lambda x: jnp.asarray(x)[state.slot], inputs)
    return observe(state, now), key


@eqx.filter_jit
def _advanced(
    home: Home, state: HomeState, inputs: tuple[Exogenous, Array, Array], action: Action
) -> tuple[Step, tuple[Observation, Array]]:
    """What a slot does, and what is observed after it; there is nothing after the last one, so it is read
    again."""
    now, disturbance, _ = jax.tree.map(lambda x: jnp.asarray(x)[state.slot], inputs)
    step = home.step(state, now, action, disturbance)
    return step, _observed(step.state, inputs)
