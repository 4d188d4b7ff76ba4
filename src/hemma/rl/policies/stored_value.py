"""Decisions about the battery as what a stored kWh is worth: the battery then does what pays in this slot."""

from dataclasses import dataclass

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Float

from hemma.home import Home
from hemma.rl.policies.action_space import Deed
from hemma.rl.policies.fractions import SLOPE_BEYOND, censored, hvac_fraction, hvac_power
from hemma.rl.policies.scaling import StateScaler
from hemma.types import Action, Array, Observation

FAR = 1e3
"""Where a reach without end ends, in the scaler's spreads."""
SAME = 1e-5
"""Powers that differ by less are the same [kW]."""
LEAST = 1e-4
"""Shortest reach: prices may make two powers worth the same."""


class Menu(eqx.Module):
    """What a battery can do in a slot that may be best, and for which worth of a stored kWh it is.

    The bill of a slot is convex and piecewise linear in the battery's power e, so the best e for a given
    worth of a stored kWh is where the slope changes: full discharging, covering the demand exactly, rest,
    storing the surplus exactly, full charging. The more a stored kWh is worth, the higher e.
    """

    powers: Float[Array, "*batch 4"]
    """Ascending [kW]; demand and surplus exclude each other, so there are four. Equal ones may stand side by
    side: an empty battery can't discharge."""
    edges: Float[Array, "*batch 3"]
    """Worth at which one power gives way to the next, ascending, as the scaler scales prices."""

    def chosen(self, worth: Float[Array, "*batch"]) -> Float[Array, "*batch"]:
        """The best power at this worth, scaled [kW]."""
        place = jnp.sum(worth[..., None] > self.edges, axis=-1)
        return jnp.take_along_axis(self.powers, place[..., None], axis=-1)[..., 0]

    def nearest(self, power: Float[Array, "*batch"]) -> Float[Array, "*batch"]:
        """The power of the menu that is nearest [kW]."""
        place = jnp.argmin(jnp.abs(self.powers - power[..., None]), axis=-1)
        return jnp.take_along_axis(self.powers, place[..., None], axis=-1)[..., 0]

    def reach(self, power: Float[Array, "*batch"]) -> Float[Array, "*batch 2"]:
        """From which worth to which this power of the menu is the best, scaled; -FAR and FAR at the ends."""
        end = jnp.full_like(self.edges[..., :1], FAR)
        begins = jnp.concatenate([-end, self.edges], axis=-1)
        ends = jnp.concatenate([self.edges, end], axis=-1)
        same = jnp.abs(self.powers - power[..., None]) < SAME
        low = jnp.min(jnp.where(same, begins, FAR), axis=-1)
        high = jnp.max(jnp.where(same, ends, -FAR), axis=-1)
        return jnp.stack([low, jnp.maximum(high, low + LEAST)], axis=-1)


def menu(
    planning_home: Home, observation: Observation, hvac: Float[Array, "*batch"], scaler: StateScaler
) -> Menu:
    """What the battery can do while the HVAC runs at ``hvac`` [kW].

    A kWh that goes into the battery costs u and its wear k_e, and stores eta_c; one that comes out saves u,
    costs k_e and takes 1 / eta_d; u is the selling price while there is a surplus. So charging pays where a
    stored kWh is worth more than (u + k_e) / eta_c, discharging where it is worth less than (u - k_e) eta_d.
    """
    o, battery = observation, planning_home.battery
    lowest, highest = battery.power_limits(o.battery_energy, planning_home.slot_length)
    surplus = o.pv_generation - o.load - hvac
    balanced = jnp.clip(surplus, lowest, highest)
    powers = [lowest, jnp.minimum(balanced, 0.0), jnp.maximum(balanced, 0.0), highest]
    wear, into, out = battery.ageing_cost, battery.charging_efficiency, battery.discharging_efficiency
    covering, storing = (o.buying_price - wear) * out, (o.selling_price + wear) / into
    edges = [
        (o.selling_price - wear) * out,
        jnp.where(surplus > 0, storing, covering),
        (o.buying_price + wear) / into,
    ]
    ascending = jax.lax.cummax(jnp.stack(edges, axis=-1), axis=powers[0].ndim)
    return Menu(jnp.stack(powers, axis=-1), scaler.price(ascending))


@dataclass(frozen=True)
class StoredValue:
    """The battery's decision is the worth of a stored kWh, scaled as the scaler scales prices.

    So a policy says what the optimum says, whose battery does the same with the dual value of its energy
    balance, and every decision ends in a power that some optimum has: nothing is smeared between them, and
    what several policies agree on is a worth, not a trickle. The density is that of the power, the chance of
    all worths that end in it under a logistic distribution: an ordered logit (McCullagh 1980). Powers that
    are the same, such as every way to discharge an empty battery, are one.

    The HVAC's decision is a fraction as in ``Fractions``, with a Gaussian.
    """

    @property
    def name(self) -> str:
        """As settings and files call it."""
        return "stored value"

    @property
    def bounds(self) -> int:
        """From and to."""
        return 2

    def carry_out(
        self,
        planning_home: Home,
        observation: Observation,
        decision: Float[Array, "*batch actions"],
        scaler: StateScaler,
    ) -> Deed:
        """The power that is best at the decided worth; rewards read it as a share of the largest."""
        hvac = hvac_power(planning_home, observation, decision[..., 1])
        offered = menu(planning_home, observation, hvac, scaler)
        power = offered.chosen(decision[..., 0])
        fractions = jnp.stack([_share(planning_home, power), decision[..., 1]], axis=-1)
        return Deed(Action(power, hvac), fractions, offered.reach(power))

    def shown(
        self, planning_home: Home, observation: Observation, action: Action, scaler: StateScaler
    ) -> Deed:
        """The battery at the nearest power that may be best, the HVAC as it was."""
        offered = menu(planning_home, observation, action.hvac_power, scaler)
        power = offered.nearest(action.battery_power)
        fraction = hvac_fraction(planning_home, observation, action.hvac_power)
        fractions = jnp.stack([_share(planning_home, power), fraction], axis=-1)
        return Deed(Action(power, action.hvac_power), fractions, offered.reach(power))

    def tried(
        self,
        planning_home: Home,
        observation: Observation,
        fractions: Float[Array, "*batch actions"],
    ) -> Deed:
        """The share of the largest power, as far as it is feasible, of the menu or not."""
        battery = planning_home.battery
        lowest, highest = battery.power_limits(observation.battery_energy, planning_home.slot_length)
        share = fractions[..., 0]
        limit = jnp.where(share > 0, battery.max_charging_power, battery.max_discharging_power)
        power = jnp.clip(share * limit, lowest, highest)
        action = Action(power, hvac_power(planning_home, observation, fractions[..., 1]))
        read = jnp.stack([_share(planning_home, power), fractions[..., 1]], axis=-1)
        return Deed(action, read, jnp.zeros((*read.shape[:-1], self.bounds)))

    def noise(self, key: Array, shape: tuple[int, ...]) -> Float[Array, "*shape actions"]:
        """Standard logistic for the worth, standard normal for the HVAC."""
        worth_key, hvac_key = jax.random.split(key)
        worth, hvac = jax.random.logistic(worth_key, shape), jax.random.normal(hvac_key, shape)
        return jnp.stack([worth, hvac], axis=-1)

    def log_density(
        self,
        fractions: Float[Array, "*batch actions"],
        reach: Float[Array, "*batch bounds"],
        mean: Float[Array, "*batch actions"],
        deviation: Float[Array, "actions"],
    ) -> Float[Array, "*batch"]:
        """log of the chance of the battery's power, and log of the density of the HVAC's fraction.

        With F the logistic function, F(b) - F(a) = F(b) F(-a) (1 - exp(a - b)).
        """
        battery = _log_chance(reach, mean[..., 0], deviation[0])
        distance = (fractions[..., 1] - mean[..., 1]) / deviation[1]
        return battery - 0.5 * distance**2 - jnp.log(deviation[1] * jnp.sqrt(2 * jnp.pi))

    def surprise(
        self,
        reach: Float[Array, "*batch bounds"],
        mean: Float[Array, "*batch actions"],
        deviation: Float[Array, "actions"],
    ) -> Float[Array, "*batch"]:
        """-log of the chance of the battery's power: far from every edge nothing is ever tried."""
        return -_log_chance(reach, mean[..., 0], deviation[0])

    def jitter(self, key: Array, shape: tuple[int, ...]) -> Float[Array, "*shape actions"]:
        """The HVAC's fraction alone: powers of the battery have a chance as they are."""
        hvac = jax.random.normal(key, shape)
        return jnp.stack([jnp.zeros_like(hvac), hvac], axis=-1)

    @property
    def heeds(self) -> tuple[bool, ...]:
        """Of the paper's state the battery's energy, and the hour as sine and cosine.

        The price decides by what it is compared with. A worth that follows the price, the sun or the load of
        fifteen days finds in them what those days happened to have (``docs/stored-value.md``).
        """
        return False, False, True, False, False, False, True, True

    def bent(self, raw: Float[Array, "actions"]) -> Float[Array, "actions"]:
        """The worth as it is; the HVAC's fraction bent at -1 and 1."""
        bounded = jnp.clip(raw[1:], -1.0, 1.0)
        return jnp.concatenate([raw[:1], bounded + SLOPE_BEYOND * (raw[1:] - bounded)])

    def agreed(self, decisions: Float[Array, "members actions"]) -> Float[Array, "actions"]:
        """The mean worth, and the mean fraction of the HVAC, each within its bounds."""
        hvac = jnp.clip(decisions[:, 1:], -1.0, 1.0)
        return jnp.mean(jnp.concatenate([decisions[:, :1], hvac], axis=1), axis=0)

    def error(
        self,
        mean: Float[Array, "*batch actions"],
        fractions: Float[Array, "*batch actions"],
        reach: Float[Array, "*batch bounds"],
    ) -> Float[Array, "*batch actions"]:
        """How far the mean worth lies outside the reach of the power shown; the HVAC as in ``Fractions``."""
        below, above = reach[..., 0] - mean[..., 0], mean[..., 0] - reach[..., 1]
        hvac = censored(mean[..., 1] - fractions[..., 1], fractions[..., 1])
        return jnp.stack([jnp.maximum(above, 0.0) - jnp.maximum(below, 0.0), hvac], axis=-1)


def _share(planning_home: Home, power: Float[Array, "*batch"]) -> Float[Array, "*batch"]:
    battery = planning_home.battery
    limit = jnp.where(power > 0, battery.max_charging_power, battery.max_discharging_power)
    return jnp.where(limit > 0, power / jnp.where(limit > 0, limit, 1.0), 0.0)


def _log_chance(reach: Float[Array, "*batch 2"], mean: Float[Array, "*batch"], deviation: Array) -> Array:
    """log of the chance that a logistic variable lies within the reach."""
    low, high = (reach[..., 0] - mean) / deviation, (reach[..., 1] - mean) / deviation
    return jax.nn.log_sigmoid(high) + jax.nn.log_sigmoid(-low) + jnp.log1p(-jnp.exp(low - high))
