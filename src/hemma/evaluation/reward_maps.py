"""What a learned reward wants: the action that it pays best, over a grid of states in physical units."""

from dataclasses import dataclass
from enum import IntEnum

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from hemma.errors import HemmaError
from hemma.home import Home, HomeState, observe
from hemma.irl.learned_reward import LearnedReward
from hemma.irl.reoptimise import ground
from hemma.types import Array, Exogenous

FRACTIONS = np.linspace(-1.0, 1.0, 81)
"""Those that are compared."""


class Moment(eqx.Module):
    """A slot of a usual day and the one after it, whatever is on the axes of a map replaced."""

    now: Exogenous
    after: Exogenous
    """Likewise of the slot after it."""
    battery_energy: Float[Array, "*grid"]
    """E [kWh]."""
    indoor_temperature: Float[Array, "*grid"]
    """T_in [degC]."""


class Varied(IntEnum):
    """Which of the two fractions is chosen; the other one rests at 0, the HVAC then at comfort."""

    BATTERY = 0
    HVAC = 1


class Answers(eqx.Module):
    """What each fraction leads to and what it is paid, shape (runs, ..., fractions) or (..., fractions)."""

    battery_power: Float[Array, "*grid"]
    """e [kW]."""
    next_temperature: Float[Array, "*grid"]
    """T_in at the end of the slot [degC]."""
    ground: Float[Array, "*grid"]
    """g(s, a)."""
    reward: Float[Array, "*grid"]
    """r(s, a, s')."""


@dataclass(frozen=True)
class Grid:
    """A map's two axes, in their units."""

    x: Float[np.ndarray, "columns"]
    y: Float[np.ndarray, "rows"]

    @property
    def points(self) -> tuple[Array, Array]:
        """x and y of all points, shape (rows, columns)."""
        x, y = np.meshgrid(self.x, self.y)
        return jnp.asarray(x, float), jnp.asarray(y, float)


def usual_hour(days: Exogenous, hour: float, slot_length: float) -> tuple[Exogenous, Exogenous]:
    """The mean over the days of the slot at ``hour``, and that of the slot after it."""
    return _mean_at(days, hour), _mean_at(days, (hour + slot_length) % 24)


def at_price(exogenous: Exogenous, price: Array) -> Exogenous:
    """The same slot at another buying price [currency/kWh]."""
    return eqx.tree_at(lambda e: e.buying_price, exogenous, price)


def at_outdoor(exogenous: Exogenous, temperature: Array) -> Exogenous:
    """The same slot in other weather [degC]."""
    return eqx.tree_at(lambda e: e.outdoor_temperature, exogenous, temperature)


def price_and_energy(days: Exogenous, hour: float, grid: Grid, home: Home) -> Moment:
    """Buying price (x) and battery energy (y) at an hour; the price stays, the room is at its edge."""
    now, after = usual_hour(days, hour, float(home.slot_length))
    price, energy = grid.points
    now, after = (_everywhere(e, price.shape) for e in (now, after))
    edge = home.comfort.low if home.hvac.heats else home.comfort.high
    return Moment(at_price(now, price), at_price(after, price), energy, jnp.full(price.shape, edge, float))


def outdoor_and_indoor(days: Exogenous, hour: float, grid: Grid, home: Home) -> Moment:
    """Outdoor (x) and indoor temperature (y) at an hour; the weather stays, the battery is half full."""
    now, after = usual_hour(days, hour, float(home.slot_length))
    outdoor, indoor = grid.points
    now, after = (_everywhere(e, outdoor.shape) for e in (now, after))
    half = (home.battery.min_energy + home.battery.max_energy) / 2
    energy = jnp.full(outdoor.shape, half, float)
    return Moment(at_outdoor(now, outdoor), at_outdoor(after, outdoor), energy, indoor)


def answers(rewards: LearnedReward, home: Home, moment: Moment, choice: Varied) -> Answers:
    """What each fraction of ``choice`` is paid by every run; ``home`` is the one that counts fractions."""
    tried = jnp.zeros((FRACTIONS.size, len(Varied))).at[:, choice].set(FRACTIONS)
    shape = moment.battery_energy.shape
    points = jax.tree.map(lambda x: jnp.asarray(x).reshape(-1), moment)

    @jax.jit
    def all_of(rewards: LearnedReward) -> Answers:
        over_fractions = jax.vmap(_answer, in_axes=(None, None, None, 0))
        over_points = jax.vmap(over_fractions, in_axes=(None, None, 0, None))
        return jax.vmap(over_points, in_axes=(0, None, None, None))(rewards, home, points, tried)

    found = jax.tree.map(lambda x: x.reshape(-1, *shape, FRACTIONS.size), all_of(rewards))
    return eqx.tree_at(
        lambda a: (a.battery_power, a.next_temperature),
        found,
        (found.battery_power[0], found.next_temperature[0]),
    )


def preferred(
    value: Float[Array, "*grid fractions"], paid: Float[Array, "runs *grid fractions"]
) -> Float[Array, "runs *grid"]:
    """The value of the fraction that each run pays best."""
    best = jnp.argmax(paid, axis=-1)
    return jax.vmap(lambda place: jnp.take_along_axis(value, place[..., None], axis=-1)[..., 0])(best)


def _answer(run: LearnedReward, home: Home, point: Moment, fractions: Float[Array, "actions"]) -> Answers:
    state = HomeState(
        battery_energy=point.battery_energy,
        thermal=home.thermal_model.initial(point.indoor_temperature),
        previous_hvac_power=jnp.zeros(()),
        slot=jnp.zeros((), int),
    )
    observation = observe(state, point.now)
    deed = run.space.tried(home, observation, fractions)
    step = home.step(state, point.now, deed.action, jnp.zeros(()))
    seen = run.transitions(observation, deed.fractions, observe(step.state, point.after))
    return Answers(
        battery_power=step.action.battery_power,
        next_temperature=step.state.indoor_temperature,
        ground=ground(run.head).rewards(seen),
        reward=run.head.rewards(seen),
    )


def _everywhere(exogenous: Exogenous, shape: tuple[int, ...]) -> Exogenous:
    return jax.tree.map(lambda x: jnp.full(shape, x, float), exogenous)


def _mean_at(days: Exogenous, hour: float) -> Exogenous:
    chosen = np.isclose(np.asarray(days.hour_of_day), hour)
    if not chosen.any():
        raise HemmaError(f"reward map: expected an hour that begins a slot of the traces, got {hour:g}")
    return jax.tree.map(lambda x: np.asarray(x, float)[chosen].mean(), days)
