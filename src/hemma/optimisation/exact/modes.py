"""Buy or sell, charge or discharge: the best of all sequences of modes, by an exact dynamic programme.

Once the mode of every slot is known, its energy has one price, and then battery and building do not meet: the
least cost to go is A(E) + B(T) with A and B convex and piecewise linear. Backward in time every such pair is
extended by every mode, and those that other pairs cover are dropped. ``docs/expert.md`` has the proof; a few
dozen pairs at most survive where prices are not all alike.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from hemma.home import Battery, Home
from hemma.optimisation.exact.convex import Convex

MOST_PAIRS = 512
"""Pairs kept; where more would be needed, the best are, and nothing is proved."""

Row = Float[np.ndarray, "modes"]


@dataclass(frozen=True)
class SlotModes:
    """What a slot may be; one entry a mode."""

    charges: Row
    """1 where it may charge, 0 where it may discharge; the switch z of ``charge_or_discharge``."""
    least_power: Row
    """Of the battery [kW]."""
    most_power: Row
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

    def of(self, modes: Int[np.ndarray, "some"]) -> "SlotModes":
        """Some of them, in this order."""
        return SlotModes(*(getattr(self, name)[modes] for name in self.__dataclass_fields__))

    def pieces(self, low: Row, high: Row) -> Float[np.ndarray, "modes 3"]:
        """How much power from ``low`` to ``high`` has each price [kW]."""
        edges = np.clip(self.kinks, low[:, None], high[:, None])
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
    modes: SlotModes
    """The mode of every slot."""


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
    scales = dt, penalty(battery, stacked(slots))
    trace, complete = [], True
    for t in reversed(range(count)):
        mode = np.repeat(np.arange(len(slots[t].buys)), len(store.start))
        after = np.tile(np.arange(len(store.start)), len(slots[t].buys))
        modes = slots[t].of(mode)
        store = _stored(store.of(after), battery, modes, scales)
        indoors = indoors.of(after)
        if building is not None:
            indoors = _cooled(indoors, building, t, ranges, (modes, dt))
        pairs = _Pairs(store, indoors, mode, after)
        kept = _undominated(pairs, tolerance)
        complete = complete and len(kept) <= MOST_PAIRS
        kept = kept[:MOST_PAIRS]
        store, indoors = store.of(kept), indoors.of(kept)
        trace.append((mode[kept], after[kept]))
    offset = np.array([energy - float(battery.min_energy)])
    costs = store.at(offset)[:, 0] + indoors.start
    chosen = _followed(trace, int(np.argmin(costs)))
    bound = float(np.min(costs)) - count * tolerance if complete else -np.inf
    return BestModes(
        bound, stacked([modes.of(np.array([k])) for modes, k in zip(slots, chosen, strict=True)])
    )


def stacked(modes: list[SlotModes]) -> SlotModes:
    """All of them, one after the other."""
    names = SlotModes.__dataclass_fields__
    return SlotModes(*(np.concatenate([getattr(one, name) for one in modes]) for name in names))


def penalty(battery: Battery, modes: SlotModes) -> float:
    """More than any energy in the battery is worth in these modes [currency/kWh]."""
    losses = float(battery.charging_efficiency * battery.discharging_efficiency)
    return 2.0 * (float(np.max(np.abs(modes.prices))) + float(battery.ageing_cost)) / losses


def _stored(ahead: Convex, battery: Battery, modes: SlotModes, scales: tuple[float, float]) -> Convex:
    """min over e of the cost of e + ageing + A(E'), for every pair and its mode.

    A mode that must charge or discharge has no such e where the battery is too full or too empty: there the
    missing energy costs a ``penalty``. ``scales``: dt and this.
    """
    dt, missing = scales
    eta_c, eta_d, k_e = (
        float(x) for x in (battery.charging_efficiency, battery.discharging_efficiency, battery.ageing_cost)
    )
    low, high, nothing = modes.least_power, modes.most_power, np.zeros(len(modes.buys))
    must_charge, must_discharge = np.maximum(low, 0.0), np.minimum(high, 0.0)
    charged = modes.pieces(must_charge, np.maximum(high, 0.0)) * dt
    discharged = modes.pieces(np.minimum(low, 0.0), must_discharge) * dt
    most_charged = modes.pieces(nothing, np.maximum(high, 0.0)) * dt
    least_discharged = modes.pieces(must_discharge, nothing) * dt
    stored, taken = charged * eta_c, discharged / eta_d
    must_store, must_take = must_charge * dt * eta_c, -must_discharge * dt / eta_d
    paid, earned = modes.prices + k_e, modes.prices - k_e
    slopes = np.column_stack([-paid / eta_c, -earned * eta_d, nothing + missing, nothing - missing])
    lengths = np.column_stack([stored, taken, must_store, must_take])
    fixed = np.sum(paid * most_charged, axis=1) - np.sum(earned * least_discharged, axis=1)
    full = ahead.raised(fixed + modes.constant + missing * must_take)
    capacity = float(battery.max_energy - battery.min_energy)
    return full.convolved(slopes, lengths, np.sum(stored, axis=1) + must_store, capacity)


def _cooled(
    ahead: Convex,
    building: Building,
    t: int,
    ranges: Float[np.ndarray, "posts 2"],
    now: tuple[SlotModes, float],
) -> Convex:
    """min over h of the cost of h + beta X3 + B(x'), as a function of x at the start of slot ``t``."""
    modes, dt = now
    a, b = float(building.carry[t]), float(building.gain[t])
    least, most, cost = modes.least_hvac, modes.most_hvac, modes.hvac_price * dt
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
    """Pairs that the kept ones do not cover, up to the tolerance; the cheapest come first.

    A pair (A, B) is covered where each piece of B lies above a kept B' raised by the most by which its A'
    exceeds A, and likewise with A and B exchanged.
    """
    store, building = (function.at(function.kinks()) for function in (pairs.store, pairs.building))
    order = np.argsort(np.mean(store, axis=1) + np.mean(building, axis=1), kind="stable")
    store, building = store[order], building[order]
    in_store, in_building = (np.zeros((len(order), max(x.shape[1] - 1, 1)), bool) for x in (store, building))
    kept = []
    while len(order):
        kept.append(int(order[0]))
        above, over = store[0] - store[1:], building[0] - building[1:]
        in_store = in_store[1:] | _whole(above <= tolerance - np.max(over, axis=1, keepdims=True))
        in_building = in_building[1:] | _whole(over <= tolerance - np.max(above, axis=1, keepdims=True))
        left = ~(np.all(in_store, axis=1) | np.all(in_building, axis=1))
        order, store, building = order[1:][left], store[1:][left], building[1:][left]
        in_store, in_building = in_store[left], in_building[left]
    return np.array(kept)


def _whole(below: Bool[np.ndarray, "pairs points"]) -> Bool[np.ndarray, "pairs pieces"]:
    """Pieces at both ends of which a line is below another is it everywhere."""
    return below[:, :-1] & below[:, 1:] if below.shape[1] > 1 else below


def _followed(trace: list[tuple[np.ndarray, np.ndarray]], pair: int) -> list[int]:
    """The modes from the first slot on."""
    chosen = []
    for mode, after in reversed(trace):
        chosen.append(int(mode[pair]))
        pair = int(after[pair])
    return chosen
