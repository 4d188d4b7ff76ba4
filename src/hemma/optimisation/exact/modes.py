"""Buy or sell, charge or discharge: the best of all sequences of modes, by an exact dynamic programme.

Once the mode of every slot is known, its energy has one price, and then battery and building do not meet: the
least cost to go is A(E) + B(T) with A and B convex and piecewise linear. Backward in time every such pair is
extended by every mode, and those that another pair nowhere exceeds are dropped. ``docs/expert.md`` has the
proof; a handful of pairs survive.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from hemma.home import Battery, Home
from hemma.optimisation.exact.convex import Convex

MOST_PAIRS = 256
"""Pairs kept; where more would be needed, the best are, and nothing is proved."""

Row = Float[np.ndarray, "modes"]


@dataclass(frozen=True)
class SlotModes:
    """What a slot may be; one entry a mode."""

    charges: Row
    """1 where it may charge, 0 where it may discharge; the switch z of ``charge_or_discharge``."""
    most_charge: Row
    """[kW]."""
    most_discharge: Row
    """[kW]."""
    buys: Row
    """1 where the slot buys, 0 where it sells; the switch z of ``power_balance``."""
    hvac_price: Row
    """Of the HVAC's energy [currency/kWh]."""
    constant: Row
    """Cost without battery and at no HVAC power [currency]."""
    least_hvac: Row
    """[kW]."""
    most_hvac: Row
    """[kW]."""
    prices: Float[np.ndarray, "modes 3"]
    """Of the battery's energy, rising with its power [currency/kWh]."""
    kinks: Float[np.ndarray, "modes 2"]
    """Battery powers at which one price ends and the next begins [kW]."""

    def pieces(self, mode: Int[np.ndarray, "pairs"], charging: bool) -> Float[np.ndarray, "pairs 3"]:
        """How much power has each price [kW], within what may be charged or discharged."""
        low = np.zeros(len(mode)) if charging else -self.most_discharge[mode]
        high = self.most_charge[mode] if charging else np.zeros(len(mode))
        edges = np.clip(self.kinks[mode], low[:, None], high[:, None])
        return np.diff(np.column_stack([low, edges, high]), axis=1)


@dataclass(frozen=True)
class Building:
    """T - free in one dimension: x' = a x + b h, from 0, at ``price`` for each degC beyond the band."""

    carry: Float[np.ndarray, "slots"]
    """a > 0."""
    gain: Float[np.ndarray, "slots"]
    """b [degC/kW]."""
    low: Float[np.ndarray, "slots"]
    """Edges of the comfort band, as x at the end of each slot [degC]."""
    high: Float[np.ndarray, "slots"]
    max_power: float
    price: float

    def ranges(self) -> Float[np.ndarray, "posts 2"]:
        """Lowest and highest x that can be reached at every fence post."""
        found = np.zeros((len(self.carry) + 1, 2))
        for t, (a, b) in enumerate(zip(self.carry, self.gain, strict=True)):
            found[t + 1] = a * found[t] + np.sort([0.0, b * self.max_power])
        return found


@dataclass(frozen=True)
class BestModes:
    """The sequence, and what it proves."""

    bound: float
    """No schedule costs less [currency]; -inf where pairs were lost."""
    buys: Float[np.ndarray, "slots"]
    charges: Float[np.ndarray, "slots"]


@dataclass(frozen=True)
class _Pairs:
    """A(E) and B(T) side by side, and how each goes on."""

    store: Convex
    building: Convex
    mode: Int[np.ndarray, "pairs"]
    """Mode of the slot."""
    after: Int[np.ndarray, "pairs"]
    """Pair of the next slot."""


def best_modes(
    home: Home, energy: float, slots: list[SlotModes], building: Building | None, tolerance: float
) -> BestModes:
    """The cheapest modes from ``energy`` [kWh]; ``tolerance`` [currency] is forgiven in every slot."""
    battery, dt = home.battery, float(home.slot_length)
    count = len(slots)
    ranges = np.zeros((count + 1, 2)) if building is None else building.ranges()
    store = Convex.zero(float(battery.max_energy - battery.min_energy))
    indoors = Convex.zero(float(np.ptp(ranges[-1])))
    trace, complete = [], True
    for t in reversed(range(count)):
        modes = slots[t]
        mode = np.repeat(np.arange(len(modes.buys)), len(store.start))
        after = np.tile(np.arange(len(store.start)), len(modes.buys))
        store = _stored(store.of(after), battery, modes, mode, dt)
        indoors = indoors.of(after)
        if building is not None:
            indoors = _cooled(indoors, building, t, ranges, (modes, mode, dt))
        pairs = _Pairs(store, indoors, mode, after)
        kept = _undominated(pairs, tolerance)
        complete = complete and len(kept) <= MOST_PAIRS
        kept = kept[:MOST_PAIRS]
        store, indoors = store.of(kept), indoors.of(kept)
        trace.append((mode[kept], after[kept]))
    offset = np.array([energy - float(battery.min_energy)])
    costs = store.at(offset)[:, 0] + indoors.start
    chosen = _followed(trace, int(np.argmin(costs)))
    return BestModes(
        bound=float(np.min(costs)) - count * tolerance if complete else -np.inf,
        buys=np.array([modes.buys[k] for modes, k in zip(slots, chosen, strict=True)]),
        charges=np.array([modes.charges[k] for modes, k in zip(slots, chosen, strict=True)]),
    )


def _stored(ahead: Convex, battery: Battery, modes: SlotModes, mode: np.ndarray, dt: float) -> Convex:
    """min over e of the cost of e + ageing + A(E'), for every pair and its mode."""
    eta_c, eta_d, k_e = (
        float(x) for x in (battery.charging_efficiency, battery.discharging_efficiency, battery.ageing_cost)
    )
    prices = modes.prices[mode]
    charged, discharged = modes.pieces(mode, True) * dt, modes.pieces(mode, False) * dt
    stored, taken = charged * eta_c, discharged / eta_d
    slopes = np.concatenate([-(prices + k_e) / eta_c, -(prices - k_e) * eta_d], axis=1)
    full = ahead.raised(np.sum((prices + k_e) * charged, axis=1) + modes.constant[mode])
    capacity = float(battery.max_energy - battery.min_energy)
    lengths = np.concatenate([stored, taken], axis=1)
    return full.convolved(slopes, lengths, np.sum(stored, axis=1), capacity)


def _cooled(
    ahead: Convex,
    building: Building,
    t: int,
    ranges: Float[np.ndarray, "posts 2"],
    now: tuple[SlotModes, Int[np.ndarray, "pairs"], float],
) -> Convex:
    """min over h of the cost of h + beta X3 + B(x'), as a function of x at the start of slot ``t``."""
    modes, mode, dt = now
    a, b = float(building.carry[t]), float(building.gain[t])
    least, most, cost = modes.least_hvac[mode], modes.most_hvac[mode], modes.hvac_price[mode] * dt
    lowest = ranges[t + 1, 0]
    priced = ahead.bent(building.low[t] - lowest, building.high[t] - lowest, building.price)
    if b == 0:
        return priced.raised(np.minimum(cost * least, cost * most)).stretched(1 / a)
    at_left = most if b > 0 else least  # h at the lower end of x = (x' - b h) / a
    reach = abs(b) * (most - least)
    cut = a * ranges[t, 0] - lowest + b * at_left
    length = a * float(np.ptp(ranges[t]))
    priced = priced.raised(cost * at_left)
    return priced.convolved((-cost / b)[:, None], reach[:, None], cut, length).stretched(1 / a)


def _undominated(pairs: _Pairs, tolerance: float) -> Int[np.ndarray, "kept"]:
    """Pairs that no other kept one undercuts everywhere, up to the tolerance; the cheapest come first."""
    values = [function.at(function.kinks()) for function in (pairs.store, pairs.building)]
    over = np.sum([np.min(value[:, None] - value[None, :], axis=2) for value in values], axis=0)
    dominates = (over >= -tolerance).T
    kept: list[int] = []
    alive = np.ones(len(dominates), bool)
    for pair in np.argsort(sum(np.mean(value, axis=1) for value in values), kind="stable"):
        if alive[pair]:
            kept.append(int(pair))
            alive &= ~dominates[pair]
    return np.array(kept)


def _followed(trace: list[tuple[np.ndarray, np.ndarray]], pair: int) -> list[int]:
    """The modes from the first slot on."""
    chosen = []
    for mode, after in reversed(trace):
        chosen.append(int(mode[pair]))
        pair = int(after[pair])
    return chosen
