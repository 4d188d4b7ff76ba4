"""The best plan at any prices: a linear programme, and modes first where they are odd.

Where selling is dearer than buying or burning energy pays, modes (``optimisation.exact.modes``) take the
place of branch and bound. They prove a bound with prices of comfort and of the other slots' energy that are
the duals of a linear programme; see ``docs/expert.md``.
"""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from hemma.optimisation.exact.constraints import idling_pays
from hemma.optimisation.exact.modes import BestModes, Building, SlotModes, best_modes
from hemma.optimisation.exact.planning import Plan, PlanningProblem, WrittenProblem, written
from hemma.optimisation.exact.programme import EXACT, Solution, SolverSettings

FORGIVEN = 0.1
"""Share of the allowed gap that the dynamic programme may use up."""
ENOUGH = 0.5
"""Share of the allowed gap at which the search stops."""


@dataclass(frozen=True)
class _Duals:
    """What one more kWh and one more degC are worth."""

    energy: Float[np.ndarray, "slots"]
    """[currency/kWh]."""
    comfort: float
    """[currency/degC]."""
    plan: Plan
    """The plan they come from."""


def best_plan(problem: PlanningProblem, settings: SolverSettings = EXACT) -> Plan:
    """The plan with the least objective, and the bound that was proved within the settings' work.

    Raises ``HemmaError`` if there is no plan.
    """
    whole = written(problem)
    if not whole.programme.whole_numbers or not _separable(problem):
        return whole.read(whole.programme.solve(settings))
    plan = _by_modes(problem, whole, settings)
    if _proves(settings, plan) or whole.programme.whole_numbers > settings.most_branched:
        return plan
    branched = whole.read(whole.programme.solve(settings))
    best = min(plan, branched, key=lambda found: found.objective)
    return replace(best, bound=max(plan.bound, branched.bound))


def _separable(problem: PlanningProblem) -> bool:
    """Whether the building is one temperature that never turns round by itself."""
    response = problem.response
    return response is None or (not response.memory_matters and bool(np.all(response.carry[:, 0, 0] > 0)))


def _by_modes(problem: PlanningProblem, whole: WrittenProblem, settings: SolverSettings) -> Plan:
    """Duals, the best modes at these duals, the best plan in these modes, its duals, and so on."""
    relaxed = whole.programme.relaxed().solve(settings)
    duals, bound = _duals(whole, relaxed), relaxed.bound
    tolerance = FORGIVEN * settings.relative_gap * abs(relaxed.objective) / problem.exogenous.slots
    best: Plan | None = None
    idle = 0  # rounds since the last that found something: without and with splits
    for count in range(settings.rounds):
        modes = _modes(problem, duals, tolerance, splits=count % 2 == 0)
        before = bound, None if best is None else best.objective
        bound = max(bound, modes.bound - duals.comfort * (problem.budget or 0.0))
        inside = _in_modes(problem, modes)
        found = inside.programme.solve(settings)
        if best is None or found.objective < best.objective:
            best = inside.read(found)
        best = replace(best, bound=bound)
        idle = idle + 1 if before == (bound, best.objective) else 0
        if _proves(settings, best) or idle == 2:
            break
        duals = _duals(inside, found)
    assert best is not None
    return best


def _proves(settings: SolverSettings, plan: Plan) -> bool:
    return plan.objective - plan.bound <= ENOUGH * settings.relative_gap * abs(plan.objective)


def _duals(within: WrittenProblem, found: Solution) -> _Duals:
    problem = within.problem
    comfort = problem.comfort_price
    if within.budget is not None:
        comfort = max(-float(found.row_duals[within.budget[0]]), 0.0)
    energy = found.row_duals[within.balance] / float(problem.home.slot_length)
    return _Duals(energy, comfort, within.read(found))


def _modes(problem: PlanningProblem, duals: _Duals, tolerance: float, splits: bool) -> BestModes:
    home, response = problem.home, problem.response
    building = None
    if response is not None:
        free = response.free[:, 0]
        building = Building(
            carry=response.carry[:, 0, 0],
            gain=response.gain[:, 0],
            low=float(home.comfort.low) - free,
            high=float(home.comfort.high) - free,
            max_power=float(home.hvac.max_power),
            price=duals.comfort,
        )
    energy = float(home.battery.min_energy) if problem.energy is None else problem.energy
    return best_modes(home, energy, _slot_modes(problem, duals, splits), building, tolerance)


def _slot_modes(problem: PlanningProblem, duals: _Duals, splits: bool) -> list[SlotModes]:
    """The modes of every slot, each with its cost as a sum of what battery and HVAC cost by themselves."""
    home, x = problem.home, problem.exogenous
    usable = problem.energy is not None
    C, D = float(home.battery.max_charging_power) * usable, float(home.battery.max_discharging_power) * usable
    demand = np.asarray(x.load, float) - np.asarray(x.pv_generation, float)
    most = float(home.hvac.max_power)
    expected = duals.plan.hvac_power
    if problem.response is None:
        demand, expected, most = demand + expected, np.zeros(x.slots), 0.0
    burns = idling_pays(home.battery, x) & usable
    found = []
    for t in range(x.slots):
        slot = _Slot(float(x.buying_price[t]), float(x.selling_price[t]), float(demand[t]), most)
        powers = [(1.0, C, 0.0), (0.0, 0.0, D)] if burns[t] else [(1.0, C, D)]
        rows = []
        for power in powers:
            if slot.v > slot.u:
                costs = slot.concave(*power[1:])
            elif splits and slot.u < 0 and burns[t]:
                costs = slot.split(float(np.clip(expected[t], 0.0, most)), *power[1:])
            else:
                costs = [slot.convex(0.0, most, float(np.clip(duals.energy[t], slot.v, slot.u)))]
            rows += [power + cost for cost in costs]
        table = np.array(rows)
        table[:, 5] *= float(home.slot_length)
        found.append(SlotModes(*table[:, :8].T, prices=table[:, 8:], kinks=-demand[t] - table[:, [7, 6]]))
    return found


@dataclass(frozen=True)
class _Slot:
    """X1 / dt as the least of several costs, each a sum of one of h and one of e and never above X1.

    A cost is (buys, price of h, constant, least and most h, three prices of e).
    """

    u: float
    """u+ [currency/kWh]."""
    v: float
    """u- [currency/kWh]."""
    demand: float
    """l - p, and h where it is known [kW]."""
    most: float
    """h^max [kW]."""

    def concave(self, charge: float, discharge: float) -> list[tuple[float, ...]]:
        """u- > u+: one price for all, that of buying or that of selling where it can be."""
        sides = [(1.0, self.u)] * (self.demand + self.most + charge > 0)
        sides += [(0.0, self.v)] * (self.demand - discharge < 0)
        return [(buys, p, p * self.demand, 0.0, self.most, p, p, p) for buys, p in sides]

    def convex(self, low: float, high: float, s: float) -> tuple[float, ...]:
        """s h + min over h in [``low``, ``high``] of X1 - s h, for s in [u-, u+]: less than X1 by nothing
        where g = 0, or h stands at the end that s favours least."""
        above, below = max(self.demand + low, 0.0), min(self.demand + high, 0.0)
        middle = s * (self.demand - above - below)
        return 1.0, s, self.u * above + middle + self.v * below, low, high, self.v, s, self.u

    def split(self, hvac: float, charge: float, discharge: float) -> list[tuple[float, ...]]:
        """X1 as it is at h = ``hvac``: less of it saves at most u+, more costs at least u-."""
        expected = self.demand + hvac
        if expected - discharge >= 0 or hvac >= self.most:
            return [self.convex(0.0, self.most, self.u)]
        if expected + charge <= 0 or hvac <= 0:
            return [self.convex(0.0, self.most, self.v)]
        return [self.convex(0.0, hvac, self.u), self.convex(hvac, self.most, self.v)]


def _in_modes(problem: PlanningProblem, modes: BestModes) -> WrittenProblem:
    """The linear programme with these modes.

    A slot that buys has the price u+ for whatever it does, one that sells u-: never less than X1.
    """
    x = problem.exogenous
    u, v = np.asarray(x.buying_price, float), np.asarray(x.selling_price, float)
    odd = v > u
    price = np.where(modes.buys > 0, u, v)
    prices = replace(x, buying_price=np.where(odd, price, u), selling_price=np.where(odd, price, v))
    inside = written(replace(problem, exogenous=prices))
    burns = idling_pays(problem.home.battery, prices)
    fixed = modes.charges[burns] if problem.energy is not None else np.zeros(0)
    return replace(inside, programme=inside.programme.fixed(fixed))
