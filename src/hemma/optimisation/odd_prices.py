"""The best plan at any prices: a linear programme, or modes first where buying and selling are odd.

Where selling is dearer than buying or burning energy pays, modes (``optimisation.modes``) take the place of
branch and bound. They prove a bound with prices of comfort and of the other slots' energy that are the duals
of a linear programme; see ``docs/expert.md``.
"""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from hemma.optimisation.constraints import idling_pays
from hemma.optimisation.modes import BestModes, Building, SlotModes, best_modes
from hemma.optimisation.planning import Plan, PlanningProblem, WrittenProblem, written
from hemma.optimisation.programme import EXACT, Solution, SolverSettings

FORGIVEN = 0.1
"""Share of the gap that the dynamic programme may use up."""


@dataclass(frozen=True)
class _Duals:
    """What one more kWh and one more degC are worth."""

    energy: Float[np.ndarray, "slots"]
    """[currency/kWh]."""
    comfort: float
    """[currency/degC]."""
    hvac_power: Float[np.ndarray, "slots"]
    """h of the plan they come from [kW]."""


def best_plan(problem: PlanningProblem, settings: SolverSettings = EXACT, branches: bool = True) -> Plan:
    """The plan with the least objective, and the bound that was proved within the settings' work.

    What the modes leave open goes to branch and bound, unless it ``branches`` not: a plan whose first slot
    alone is carried out is not worth it.

    Raises ``HemmaError`` if there is no plan.
    """
    whole = written(problem)
    if not whole.programme.has_whole or not _separable(problem):
        return whole.read(whole.programme.solve(settings))
    plan = _by_modes(problem, whole, settings)
    if settings.proves(plan.objective, plan.bound) or not branches:
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
    for count in range(settings.rounds):
        modes = _modes(problem, duals, tolerance, bends=count % 2 == 0)
        bound = max(bound, modes.bound - duals.comfort * (problem.budget or 0.0))
        inside = _in_modes(problem, modes)
        found = inside.programme.solve(settings)
        if best is None or found.objective < best.objective:
            best = inside.read(found)
        if settings.proves(best.objective, bound):
            break
        duals = _duals(inside, found)
    assert best is not None
    return replace(best, bound=min(bound, best.objective))


def _duals(within: WrittenProblem, found: Solution) -> _Duals:
    problem = within.problem
    comfort = problem.comfort_price
    if within.budget is not None:
        comfort = max(-float(found.row_duals[within.budget[0]]), 0.0)
    energy = found.row_duals[within.balance] / float(problem.home.slot_length)
    return _Duals(energy, comfort, within.read(found).hvac_power)


def _modes(problem: PlanningProblem, duals: _Duals, tolerance: float, bends: bool) -> BestModes:
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
    return best_modes(home, energy, _slot_modes(problem, duals, bends), building, tolerance)


def _slot_modes(problem: PlanningProblem, duals: _Duals, bends: bool) -> list[SlotModes]:
    """The modes of every slot. Where burning energy pays, battery and HVAC are told apart in two ways, see
    ``_Slot``; ``bends`` chooses.
    """
    home, x = problem.home, problem.exogenous
    usable, known = problem.energy is not None, problem.response is None
    C, D = float(home.battery.max_charging_power) * usable, float(home.battery.max_discharging_power) * usable
    demand = np.asarray(x.load, float) - np.asarray(x.pv_generation, float)
    if known:
        demand = demand + duals.hvac_power
    most = 0.0 if known else float(home.hvac.max_power)
    expected = np.zeros(x.slots) if known else duals.hvac_power
    burns = idling_pays(home.battery, x) & usable
    found = []
    for t in range(x.slots):
        u, v = float(x.buying_price[t]), float(x.selling_price[t])
        slot = _Slot(u, v, float(demand[t]), most, float(home.slot_length))
        rows = []
        for charges, c, d in ((1.0, C, 0.0), (0.0, 0.0, D)) if burns[t] else ((1.0, C, D),):
            if burns[t] and bends and u > v:
                parts = slot.bent(c, d, float(expected[t]))
            else:
                parts = slot.priced(c, d, float(duals.energy[t]))
            rows += [(charges, c, d, *part) for part in parts]
        found.append(SlotModes(*np.array(rows).T))
    return found


@dataclass(frozen=True)
class _Slot:
    """X1 as a sum of what battery and HVAC cost each for itself, never more than it is.

    A part is (buys, price of h, kink, price of e below and above it, constant); X1 is the least of the parts.
    """

    u: float
    """u+ [currency/kWh]."""
    v: float
    """u- [currency/kWh]."""
    demand: float
    """l - p, and h where it is known [kW]."""
    most_hvac: float
    """[kW]."""
    length: float
    """dt [h]."""

    def priced(self, charge: float, discharge: float, dual: float) -> list[tuple[float, ...]]:
        """One price for all: that of the side on which g must lie; u+ or u- where X1 is concave; or the dual.

        For p in [u-, u+] p g dt is never above X1; the dual of the power balance makes most of it.
        """
        if self.demand - discharge >= 0:
            choices = [(1.0, self.u)]
        elif self.demand + self.most_hvac + charge <= 0:
            choices = [(0.0, self.v)]
        elif self.v > self.u:
            choices = [(1.0, self.u), (0.0, self.v)]
        else:
            choices = [(1.0, float(np.clip(dual, self.v, self.u)))]
        return [(buys, p, 0.0, p, p, p * self.demand * self.length) for buys, p in choices]

    def bent(self, charge: float, discharge: float, hvac: float) -> list[tuple[float, ...]]:
        """X1 as it is for the battery at h = ``hvac``; more of h costs at least u-, less saves at most u+."""
        expected = self.demand + hvac
        if expected - discharge >= 0 or self.most_hvac == 0:
            choices = [self.u]
        elif expected + charge <= 0:
            choices = [self.v]
        else:
            choices = [self.u, self.v]
        without = max(self.u * expected, self.v * expected)
        return [(1.0, p, -expected, self.v, self.u, (without - p * hvac) * self.length) for p in choices]


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
