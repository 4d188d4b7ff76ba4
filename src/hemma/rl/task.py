"""What one training run learns from: a home and its own days, a teacher, and a seed."""

import zlib
from collections.abc import Sequence
from typing import Generic, TypeVar

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float, Int, UInt

from hemma.errors import HemmaError
from hemma.home import Home
from hemma.home.selling import fit_selling
from hemma.rl.environment import Environment, Transitions
from hemma.rl.policies.action_space import ActionSpace, Deed
from hemma.rl.policies.scaling import NOTHING, SELLING, Context, StateScaler, fit_scaler
from hemma.rl.policies.spaces import FRACTIONS
from hemma.types import Action, Array, Costs, Exogenous, Observation, PaperState

LEAST_ROOM = 2048
"""Slots: 85 days by the hour, so that a season and a day of it share compiled code."""


class Demonstrated(eqx.Module):
    """Demonstrations as anyone may bring them: the paper's states and actions in their units."""

    states: Float[Array, "samples 7"]
    """s = (p, l, E, T_out, T_in, u, t')."""
    actions: Float[Array, "samples 2"]
    """a = (e, h) [kW], feasible."""
    next_states: Float[Array, "samples 7"]
    """s'."""


class ExpertData(eqx.Module):
    """A teacher who shows: demonstrations, as learners sample them."""

    transitions: Transitions
    """Shape (L + padding, ...)."""
    available: Int[Array, "*runs"]
    """L; what lies behind is padding and never read."""


class ExplicitReward(eqx.Module):
    """A teacher who pays: the hand-written reward of the paper's DRL baselines (its Section IV).

    r = -(X1 + X2) - beta_T X3 [currency]
    """

    comfort_price: Float[Array, "*runs"]
    """beta_T [currency/degC for one slot]."""

    def __call__(self, costs: Costs) -> Float[Array, "*batch"]:
        """r of slots with these costs."""
        return -(costs.transaction + costs.ageing) - self.comfort_price * costs.temperature_deviation


Teacher = TypeVar("Teacher", bound=eqx.Module)
"""An ``ExpertData`` or an ``ExplicitReward``."""


class Task(eqx.Module, Generic[Teacher]):
    """One run, or many stacked along a first axis."""

    environment: Environment
    teacher: Teacher
    seed: Int[Array, "*runs"]
    stream: UInt[Array, "*runs"]
    """Digest of the traces: the same seed draws other numbers in other homes, so that homes are independent
    samples."""

    @property
    def key(self) -> Array:
        """Where all randomness of one run comes from."""
        return jax.random.fold_in(jax.random.key(self.seed), self.stream)


def make_task(  # noqa: PLR0913 - a home, as believed and as it is, days, a teacher, a seed, what is seen and done
    planning_home: Home,
    home: Home,
    exogenous: Exogenous,
    demonstrated: Demonstrated,
    seed: int,
    context: Context = NOTHING,
    space: ActionSpace = FRACTIONS,
) -> Task[ExpertData]:
    """The task of learning from ``demonstrated`` and the traces ``exogenous`` of the same days, nothing else.

    ``planning_home`` is ``home`` with an identified thermal model: it turns the learner's decisions into
    powers, and the expert's powers into deeds of the ``space``. Where a deed is not what the expert did, the
    battery's next energy is that of the deed. The scaler is fitted to the demonstrated states, and to
    the traces' selling price where that is no line of the buying price: then it is one more feature.
    ``context`` is what there is to see in each slot of ``exogenous`` besides the paper's state.
    """
    if len(demonstrated.actions) != exogenous.slots - 1:
        raise HemmaError(
            f"demonstrations: expected {exogenous.slots - 1} transitions for traces of {exogenous.slots} "
            f"slots, got {len(demonstrated.actions)}; demonstrate and train on the same days"
        )
    selling = _untold(exogenous, context)
    scaler = fit_scaler(np.asarray(demonstrated.states), None if selling is None else selling[:-1])
    shown = jax.tree.map(lambda x: jnp.asarray(x, float), demonstrated)
    observation = _observed(shown.states, jnp.asarray(exogenous.selling_price, float)[:-1])
    deed = space.shown(planning_home, observation, Action(*shown.actions.T), scaler)
    environment = _environment(planning_home, home, exogenous, scaler, context)
    seen = environment.context
    transitions = Transitions(
        features=jnp.concatenate([scaler(shown.states), seen[:-1]], axis=1),
        fractions=deed.fractions,
        next_features=jnp.concatenate([scaler(_after(planning_home, shown, deed)), seen[1:]], axis=1),
        reach=deed.reach,
    )
    expert = ExpertData(transitions, jnp.asarray(len(demonstrated.actions)))
    return Task(environment, expert, jnp.asarray(seed), _stream(exogenous))


def explicit_task(
    planning_home: Home,
    home: Home,
    exogenous: Exogenous,
    comfort_price: float,
    seed: int,
    context: Context = NOTHING,
) -> Task[ExplicitReward]:
    """The task of learning from the explicit reward with beta_T = ``comfort_price`` on these days.

    ``planning_home`` and ``context`` are as in ``make_task``. The scaler is fitted to the traces, and to
    battery energies and indoor temperatures as rollouts start with: spread evenly over the battery's range,
    and over the comfort band and one degree beyond.
    """
    battery, comfort = home.battery, home.comfort
    spread = np.linspace(0.0, 1.0, exogenous.slots)
    order = np.random.default_rng(0).permutation(exogenous.slots)
    columns = (
        exogenous.pv_generation,
        exogenous.load,
        battery.min_energy + spread * (battery.max_energy - battery.min_energy),
        exogenous.outdoor_temperature,
        comfort.low - 1 + spread[order] * (comfort.high - comfort.low + 2),
        exogenous.buying_price,
        exogenous.hour_of_day,
    )
    states = np.stack([np.asarray(column, float) for column in columns], axis=1)
    scaler = fit_scaler(states, _untold(exogenous, context))
    reward = ExplicitReward(jnp.asarray(comfort_price, float))
    environment = _environment(planning_home, home, exogenous, scaler, context)
    return Task(environment, reward, jnp.asarray(seed), _stream(exogenous))


def stack(tasks: Sequence[Task[Teacher]]) -> Task[Teacher]:
    """All tasks along a new first axis, each padded with zeros, unread, to the length of ``room``."""
    return jax.tree.map(lambda *leaves: jnp.stack(leaves), *map(_padded, tasks))


def room(slots: int) -> int:
    """To how many slots traces of so many are padded: few lengths share compiled code, and it depends on
    nothing but the traces, because code compiled for another length may add up in another order."""
    return max(LEAST_ROOM, 2 ** (slots - 1).bit_length())


def _environment(
    planning_home: Home, home: Home, exogenous: Exogenous, scaler: StateScaler, context: Context
) -> Environment:
    if context.figures.shape[-1] == 0:
        nothing = jnp.zeros((exogenous.slots, 0))
        context = Context(nothing, nothing, context.kinds)
    if len(context.figures) != exogenous.slots:
        raise HemmaError(
            f"context: expected a row for each of the {exogenous.slots} slots of the traces, got "
            f"{len(context.figures)}; observe the days that are learned from"
        )
    planning_home, home, traces = jax.tree.map(
        lambda x: jnp.asarray(x, float), (planning_home, home, exogenous)
    )
    seen = jnp.concatenate(
        [scaler.selling(traces.selling_price), scaler.context(jax.tree.map(jnp.asarray, context))], axis=1
    )
    return Environment(planning_home, home, traces, jnp.asarray(exogenous.slots), scaler, seen)


def _untold(exogenous: Exogenous, context: Context) -> Float[np.ndarray, "slots"] | None:
    """The selling price where the paper's state does not tell it, or a context has figures of it."""
    if fit_selling(exogenous) is not None and SELLING not in np.asarray(context.kinds):
        return None
    return np.asarray(exogenous.selling_price, float)


def _after(home: Home, shown: Demonstrated, deed: Deed) -> Float[Array, "samples 7"]:
    """s' with the battery's energy after the deed; the very s' where the deed is what was done."""
    before = shown.states[:, PaperState.BATTERY_ENERGY]
    energy = home.battery.next_energy(before, deed.action.battery_power, home.slot_length)
    is_same = deed.action.battery_power == shown.actions[:, 0]
    kept = jnp.where(is_same, shown.next_states[:, PaperState.BATTERY_ENERGY], energy)
    return jnp.asarray(shown.next_states).at[:, PaperState.BATTERY_ENERGY].set(kept)


def _observed(states: Float[Array, "samples 7"], selling: Float[Array, "samples"]) -> Observation:
    """What a controller saw in the paper's states; the HVAC power before is not among them."""
    pv, load, energy, outdoor, indoor, price, hour = states.T
    slots = jnp.arange(len(states))
    return Observation(pv, load, energy, outdoor, indoor, price, selling, hour, jnp.zeros_like(pv), slots)


def _stream(exogenous: Exogenous) -> UInt[Array, ""]:
    digest = zlib.crc32(np.ascontiguousarray(exogenous.load, np.float64).tobytes())
    return jnp.asarray(digest, jnp.uint32)


def _padded(task: Task[Teacher]) -> Task[Teacher]:
    def timed(task: Task) -> tuple:
        shown = (task.teacher.transitions,) if isinstance(task.teacher, ExpertData) else ()
        return task.environment.exogenous, task.environment.context, *shown

    length = room(task.environment.exogenous.slots)
    return eqx.tree_at(timed, task, jax.tree.map(lambda x: _pad(x, length), timed(task)))


def _pad(leaf: Array, length: int) -> Array:
    return jnp.pad(leaf, [(0, length - leaf.shape[0])] + [(0, 0)] * (leaf.ndim - 1))
