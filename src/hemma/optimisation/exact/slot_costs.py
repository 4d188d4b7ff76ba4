"""X1 of a slot as the least of several costs, its modes: what battery and HVAC pay by themselves, added."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import groupby, pairwise

import numpy as np
from jaxtyping import Float

from hemma.optimisation.exact.constraints import idling_pays
from hemma.optimisation.exact.convex import EMPTY
from hemma.optimisation.exact.modes import SlotModes
from hemma.optimisation.exact.planning import PlanningProblem

Cost = tuple[float, ...]
"""buys, price of h, constant, least and most h, three prices of e."""


@dataclass(frozen=True)
class View:
    """How closely a slot with u+ >= u- is looked at."""

    price: float
    """s, what its energy is worth [currency/kWh]."""
    hvac: float
    """h [kW] at which X1 is exact, if ``is_split``."""
    is_split: bool
    points: tuple[tuple[float, float], ...] = ()
    """(h, e) [kW] at which it is exact."""


def slot_modes(problem: PlanningProblem, views: list[View]) -> list[SlotModes]:
    """The modes of every slot. They never cost more than X1."""
    home, x = problem.home, problem.exogenous
    usable = problem.energy is not None
    C, D = float(home.battery.max_charging_power) * usable, float(home.battery.max_discharging_power) * usable
    demand, most = net_demand(problem)
    burns = idling_pays(home.battery, x) & usable
    found = []
    for t, view in enumerate(views):
        slot = Slot(float(x.buying_price[t]), float(x.selling_price[t]), float(demand[t]), most)
        powers = [(1.0, 0.0, C), (0.0, -D, 0.0)] if burns[t] else [(1.0, -D, C)]
        rows = [(charges, *row) for charges, low, high in powers for row in slot.modes(low, high, view)]
        table = np.array(rows)
        table[:, 5] *= float(home.slot_length)
        found.append(SlotModes(*table[:, :8].T, prices=table[:, 8:], kinks=-demand[t] - table[:, [7, 6]]))
    return found


def net_demand(problem: PlanningProblem) -> tuple[Float[np.ndarray, "slots"], float]:
    """l - p, and h where it is known [kW]; and the most that the HVAC adds [kW]."""
    x = problem.exogenous
    demand = np.asarray(x.load, float) - np.asarray(x.pv_generation, float)
    if problem.response is None:
        return demand + np.asarray(problem.hvac, float), 0.0
    return demand, float(problem.home.hvac.max_power)


def below_cost(
    problem: PlanningProblem,
    modes: SlotModes,
    hvac: Float[np.ndarray, "slots"],
    power: Float[np.ndarray, "slots"],
) -> Float[np.ndarray, "slots"]:
    """By how much the mode of every slot is below X1 at these h and e [currency]."""
    x, dt, (demand, _) = problem.exogenous, float(problem.home.slot_length), net_demand(problem)
    u, v, g = np.asarray(x.buying_price, float), np.asarray(x.selling_price, float), demand + hvac + power
    pieces = modes.pieces(np.minimum(power, 0.0), np.maximum(power, 0.0)) * np.sign(power)[:, None]
    said = modes.constant + dt * (modes.hvac_price * hvac + np.sum(modes.prices * pieces, axis=1))
    return np.where(g > 0, u, v) * g * dt - said


@dataclass(frozen=True)
class Slot:
    """Prices and demand of one slot."""

    u: float
    """u+ [currency/kWh]."""
    v: float
    """u- [currency/kWh]."""
    demand: float
    """l - p, and h where it is known [kW]."""
    most: float
    """h^max [kW]."""

    def modes(self, low: float, high: float, view: View) -> Iterator[tuple[float, ...]]:
        """For e from ``low`` to ``high``: least and most e, and a cost."""
        if self.v > self.u:
            yield from ((low, high, *cost) for cost in self._concave(low, high))
        elif self.most > 0 and view.points:
            yield from self._cells(low, high, view)
        elif self.most > 0 and view.is_split:
            for s, parts in groupby(self._parts(low, high, view.hvac), key=lambda part: part[2]):
                ends = [end for part in parts for end in part[:2]]
                yield low, high, *self._convex(ends[0], ends[-1], s)
        else:
            yield low, high, *self._convex(0.0, self.most, self._within(view.price))

    def _concave(self, low: float, high: float) -> Iterator[Cost]:
        """u- > u+: one price for all, that of buying or that of selling where it can be."""
        sides = [(1.0, self.u)] * (self.demand + self.most + high >= 0)
        sides += [(0.0, self.v)] * (self.demand + low < 0)
        return ((buys, p, p * self.demand, 0.0, self.most, p, p, p) for buys, p in sides)

    def _convex(self, low: float, high: float, s: float) -> Cost:
        """s h + min over h in [``low``, ``high``] of X1 - s h, for s in [u-, u+]: less than X1 by nothing
        where g = 0, or h stands at the end that s favours least."""
        above, below = max(self.demand + low, 0.0), min(self.demand + high, 0.0)
        middle = s * (self.demand - above - below)
        return 1.0, s, self.u * above + middle + self.v * below, low, high, self.v, s, self.u

    def _within(self, price: float) -> float:
        return float(np.clip(price, self.v, self.u))

    def _parts(self, low: float, high: float, hvac: float) -> Iterator[tuple[float, float, float]]:
        """Parts of [0, h^max], each with s: exact at ``hvac``, and where g has one sign for all e."""
        never_buys, never_sells = (float(np.clip(-self.demand - e, 0.0, self.most)) for e in (high, low))
        middle = float(np.clip(hvac, never_buys, never_sells))
        edges = (0.0, never_buys, middle, never_sells, self.most)
        for (h0, h1), s in zip(pairwise(edges), (self.v, self.u, self.v, self.u), strict=True):
            if h1 - h0 > EMPTY:
                yield h0, h1, s

    def _cells(self, low: float, high: float, view: View) -> Iterator[tuple[float, ...]]:
        """Modes that are exact where g has one sign in a whole cell of h and e, and at the last point of the
        others."""
        edges = {end for part in self._parts(low, high, view.hvac) for end in part[:2]}
        edges |= {h for h, _ in view.points if 0 < h < self.most}
        for h0, h1 in pairwise(sorted(edges)):
            sold, bought = (float(np.clip(-self.demand - h, low, high)) for h in (h1, h0))
            between = self._side((h0, h1), (sold, bought), view)
            for begin, end, s in ((low, sold, self.v), (sold, bought, between), (bought, high, self.u)):
                if end - begin > EMPTY:
                    yield begin, end, *self._convex(h0, h1, s)

    def _side(self, hvac: tuple[float, float], power: tuple[float, float], view: View) -> float:
        """The s that is exact at the last point inside; without points, what energy is worth."""
        for h, e in reversed(view.points):
            if hvac[0] - EMPTY <= h <= hvac[1] + EMPTY and power[0] - EMPTY <= e <= power[1] + EMPTY:
                return self.u if self.demand + h + e > 0 else self.v
        return self._within(view.price)
