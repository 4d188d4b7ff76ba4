"""Thresholds: the battery by two prices, fitted to the training period; the HVAC by the comfort law."""

from collections.abc import Callable

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float, Int

from hemma.control.comfort import ComfortHold
from hemma.home import AbstractController, Battery, Home, Memory, replay, transaction_cost
from hemma.home.comfort import observed_comfort_power
from hemma.home.precision import in_double
from hemma.home.selling import SellingLine, fit_selling
from hemma.types import Action, Array, Exogenous, Observation, Scalar

Ranks = Int[np.ndarray, "ranks"]
Pair = tuple[int, int]

GRID = 33
"""Candidates for each threshold in one pass of the search."""
EQUAL = 1e-9
"""Costs that differ by less than this share are equal; of equal thresholds those that rest most are taken."""


class PriceRule(eqx.Module):
    """Charge what costs less than one price, discharge for what brings more than another.

    A kWh charged costs u+, or u- while there is a surplus that would be sold; a kWh discharged saves u+ while
    there is a demand, and brings u- beyond it. So the battery
    charges at full power where u+ < p_lo, only the surplus where u- < p_lo <= u+,
    discharges at full power where u- > p_hi, only to cover the demand where u- <= p_hi < u+,
    and rests between. Whether it sells is decided by the prices, not by an option.
    """

    charge_below: Scalar
    """p_lo [currency/kWh]."""
    discharge_above: Scalar
    """p_hi [currency/kWh], at least p_lo."""
    selling: SellingLine | None
    """u- beside u+ in the training period; None where it is no line, and the observed u- counts."""

    def battery_power(
        self,
        battery: Battery,
        energy: Array,
        net_demand: Array,
        prices: tuple[Array, Array],
        slot_length: Scalar,
    ) -> Array:
        """e [kW], feasible at ``energy`` [kWh]; ``net_demand`` = l + h - p [kW], ``prices`` = (u+, u-)."""
        u, v = prices
        v = v if self.selling is None else self.selling(u)
        lowest, highest = battery.power_limits(energy, slot_length)
        stored = jnp.where(v < self.charge_below, jnp.clip(-net_demand, 0.0, highest), 0.0)
        used = jnp.where(u > self.discharge_above, jnp.clip(-net_demand, lowest, 0.0), 0.0)
        wholly = jnp.where(u < self.charge_below, highest, lowest)
        return jnp.where((u < self.charge_below) | (v > self.discharge_above), wholly, stored + used)


class Thresholds(AbstractController):
    """The battery by ``rule``, the HVAC at the least power that holds comfort by the home's thermal model."""

    home: Home
    """The home as it is believed to be: with the identified thermal model, nothing knows the true one."""
    rule: PriceRule

    def __call__(self, observation: Observation, memory: Memory, key: Array) -> tuple[Action, Memory]:
        """Action of the observed slot [kW]; no randomness, nothing to remember."""
        o, home = observation, self.home
        h = observed_comfort_power(home, o)
        prices = (o.buying_price, o.selling_price)
        e = self.rule.battery_power(
            home.battery, o.battery_energy, o.load + h - o.pv_generation, prices, home.slot_length
        )
        return Action(battery_power=e, hvac_power=h), memory


def fit_thresholds(home: Home, exogenous: Exogenous) -> Thresholds:
    """The two prices with the least sum of X1 + X2 over the training period ``exogenous``.

    ``home`` holds the identified thermal model: the demand that the battery meets is that of comfort held by
    it. The battery does not act on the building, so that path is run once, and the battery alone for each
    pair of prices. Candidates lie halfway between neighbours among all buying and selling prices of the
    period, and at -inf and inf (never), so nothing depends on currency or scale.
    """
    line = fit_selling(exogenous)
    u, v = (np.asarray(x, float) for x in (exogenous.buying_price, exogenous.selling_price))
    prices = _between(np.concatenate([u, v if line is None else np.asarray(line(u))]))
    with jax.enable_x64(True):
        inside, exogenous, selling = in_double((home, exogenous, line))
        demand = _comfort_demand(inside, exogenous)

        def bills(low: Ranks, high: Ranks) -> Float[np.ndarray, "low high"]:
            pairs = in_double((prices[low], prices[high]))
            return np.asarray(_bills(inside, exogenous, demand, selling, *pairs))

        low, high = _search(bills, len(prices))
    return Thresholds(home, PriceRule(float(prices[low]), float(prices[high]), line))


def _between(prices: Float[np.ndarray, "values"]) -> Float[np.ndarray, "candidates"]:
    distinct = np.unique(prices)
    return np.concatenate([[-np.inf], (distinct[1:] + distinct[:-1]) / 2, [np.inf]])


@eqx.filter_jit
def _comfort_demand(home: Home, exogenous: Exogenous) -> Float[Array, "slots"]:
    """l + h - p [kW] with comfort held and no thermal disturbance."""
    quiet = eqx.tree_at(lambda home: home.disturbance_deviation, home, 0.0)
    path = replay(quiet, exogenous, ComfortHold(home), home.reset(), jax.random.key(0))
    return exogenous.load + path.steps.action.hvac_power - exogenous.pv_generation


@eqx.filter_jit
def _bills(
    home: Home,
    exogenous: Exogenous,
    demand: Float[Array, "slots"],
    selling: SellingLine | None,
    low: Float[Array, "low"],
    high: Float[Array, "high"],
) -> Float[Array, "low high"]:
    """Sum of X1 + X2 [currency] for every pair of a price to charge below and one to discharge above."""
    battery, dt = home.battery, home.slot_length

    def bill(low: Array, high: Array) -> Array:
        rule = PriceRule(low, high, selling)

        def slot(energy: Array, inputs: tuple[Exogenous, Array]) -> tuple[Array, Array]:
            now, net_demand = inputs
            prices = (now.buying_price, now.selling_price)
            e = rule.battery_power(battery, energy, net_demand, prices, dt)
            cost = transaction_cost(net_demand + e, now, dt) + battery.ageing(e, dt)
            return battery.next_energy(energy, e, dt), cost

        return jnp.sum(jax.lax.scan(slot, home.reset().battery_energy, (exogenous, demand))[1])

    across = jax.vmap(bill, in_axes=(None, 0))
    return jax.vmap(across, in_axes=(0, None))(low, high)


def _search(bills: Callable[[Ranks, Ranks], Float[np.ndarray, "low high"]], candidates: int) -> Pair:
    """Ranks of the best pair: on a grid over all candidates, then ever finer around the best so far."""
    step = max(-(-(candidates - 1) // (GRID - 1)), 1)
    low = high = step * np.arange(GRID)
    while True:
        low, high = np.clip(low, 0, candidates - 1), np.clip(high, 0, candidates - 1)
        best = _least(np.where(low[:, None] <= high, bills(low, high), np.inf))
        low_rank, high_rank = int(low[best[0]]), int(high[best[1]])
        if step == 1:
            return low_rank, high_rank
        step = -(-step // (GRID // 2))
        around = step * (np.arange(GRID) - GRID // 2)
        low, high = low_rank + around, high_rank + around


def _least(bills: Float[np.ndarray, "low high"]) -> Pair:
    """Place of the least bill; among equals that of the lowest low and then the highest high price."""
    slack = EQUAL * np.max(np.abs(bills[np.isfinite(bills)]))
    backwards = bills[:, ::-1] <= np.min(bills) + slack
    row, column = np.unravel_index(np.argmax(backwards), backwards.shape)
    return int(row), bills.shape[1] - 1 - int(column)
