"""The best plan at any prices: a linear programme, and modes first where they are odd.

Where selling is dearer than buying or burning energy pays, modes (``optimisation.exact.modes``) take the
place of branch and bound. They prove a bound with prices of comfort and of the other slots' energy that are
the duals of a linear programme; see ``docs/expert.md``.
"""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Int

from hemma.optimisation.exact.constraints import idling_pays
from hemma.optimisation.exact.modes import BestModes, Building, SlotModes, best_modes
from hemma.optimisation.exact.own_schedule import OwnSchedule, own_schedule
from hemma.optimisation.exact.planning import Plan, PlanningProblem, WrittenProblem, written
from hemma.optimisation.exact.programme import EXACT, Solution, SolverSettings
from hemma.optimisation.exact.slot_costs import View, below_cost, net_demand, slot_modes

FORGIVEN = 0.1
"""Share of the allowed gap that the dynamic programme may use up."""
ENOUGH = 0.5
"""Share of the allowed gap at which the search stops."""
UNSEEN = 0.1
"""Share of the gap that may hide in slots which are not looked at more closely."""
SLOW = 0.7
"""Part of the gap that better duals alone may leave before more is looked at more closely."""
AT_ONCE = 60
"""Slots that are looked at more closely in one round."""
HOPELESS = 0.4
"""Share of the slots beyond which looking at all of them more closely would need too many pairs."""
STEEPER = 8.0
"""By how much the price of comfort is raised where it is too low and no limit is known."""
WITHIN = 1e-6
"""How near to the budget the modes' own schedule has to come [degC]."""


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
    views, comfort = _first_views(problem, duals), ComfortPrice.first(problem, duals)
    best: Plan | None = None
    gap = np.inf
    for _ in range(settings.rounds):
        modes = _modes(problem, views, comfort.price, tolerance)
        bound = max(bound, modes.bound - comfort.price * (problem.budget or 0.0))
        inside = _in_modes(problem, modes.modes)
        found = inside.programme.solve(settings)
        if best is None or found.objective < best.objective:
            best = inside.read(found)
        best = replace(best, bound=bound)
        before, gap = gap, max(best.objective - bound, 0.0)
        if _proves(settings, best) or np.isinf(modes.bound):  # finer views lose yet more pairs
            break
        duals = _duals(inside, found)
        own = own_schedule(problem, modes.modes, comfort.price)
        hidden = _hidden(below_cost(problem, modes.modes, own.hvac, own.battery), gap)
        if len(hidden) <= AT_ONCE or gap > SLOW * before:
            if len(hidden) > max(AT_ONCE, HOPELESS * len(views)):
                break
            views = _closer(problem, views, own, hidden[:AT_ONCE])
        views = _priced(views, duals)
        if problem.budget is not None:
            comfort = comfort.nearer(own.deviation - problem.budget, duals.comfort)
    assert best is not None
    return best


@dataclass(frozen=True)
class ComfortPrice:
    """beta on X3 [currency/degC], which has to make the modes' own schedule keep to the budget."""

    price: float
    unit: float
    """The dearest slot of full HVAC: tried first where nothing is known but that 0 is too low."""
    low: float = 0.0
    """Too low."""
    high: float = np.inf
    """Too high."""

    @classmethod
    def first(cls, problem: PlanningProblem, duals: _Duals) -> "ComfortPrice":
        """The dual; where no deviation is allowed, more does no harm."""
        home, x = problem.home, problem.exogenous
        dearest = float(max(np.max(np.abs(x.buying_price)), np.max(np.abs(x.selling_price))))
        strict = problem.budget is not None and problem.budget <= WITHIN
        price = STEEPER * duals.comfort if strict else duals.comfort
        return cls(price, dearest * float(home.hvac.max_power) * float(home.slot_length))

    def nearer(self, beyond: float, expected: float) -> "ComfortPrice":
        """After a schedule that is ``beyond`` the budget [degC]; ``expected`` is tried if it can be."""
        if abs(beyond) <= WITHIN:
            return self
        low = max(self.low, self.price) if beyond > 0 else self.low
        high = min(self.high, self.price) if beyond < 0 else self.high
        if low < expected < high:
            price = expected
        elif np.isinf(high):
            price = STEEPER * low if low > 0 else self.unit
        else:
            price = 0.5 * (low + high)
        return replace(self, price=price, low=low, high=high)


def _first_views(problem: PlanningProblem, duals: _Duals) -> list[View]:
    """Where burning energy pays, X1 is taken as it is at the plan's h."""
    x = problem.exogenous
    split = idling_pays(problem.home.battery, x) & (np.asarray(x.buying_price) < 0)
    split &= problem.energy is not None and problem.response is not None
    return _priced([View(0.0, 0.0, bool(is_split)) for is_split in split], duals)


def _priced(views: list[View], duals: _Duals) -> list[View]:
    """The same with these duals and the plan they come from."""
    return [
        replace(view, price=float(s), hvac=float(h))
        for view, s, h in zip(views, duals.energy, duals.plan.hvac_power, strict=True)
    ]


def _hidden(missing: Float[np.ndarray, "slots"], gap: float) -> Int[np.ndarray, "some"]:
    """The slots whose ``missing`` cost [currency] matters for the gap; the worst come first."""
    hidden = np.flatnonzero(missing > UNSEEN * gap / len(missing))
    return hidden[np.argsort(-missing[hidden], kind="stable")]


def _closer(
    problem: PlanningProblem, views: list[View], own: OwnSchedule, slots: Int[np.ndarray, "some"]
) -> list[View]:
    """The same, but exact also where the modes' own schedule is in some slots."""
    demand, _ = net_demand(problem)
    found = list(views)
    for t in slots:
        h, e = float(own.hvac[t]), float(own.battery[t])
        across = -float(demand[t]) - e - h  # to where g = 0
        tried = [h]
        while (tried[-1], e) in views[t].points:  # exact there in smaller cells
            across *= 0.25
            tried = [h + across * step for step in (1.0, 2.0, 3.0)]
        found[t] = replace(views[t], points=views[t].points + tuple((h, e) for h in tried))
    return found


def _proves(settings: SolverSettings, plan: Plan) -> bool:
    return plan.objective - plan.bound <= ENOUGH * settings.relative_gap * abs(plan.objective)


def _duals(within: WrittenProblem, found: Solution) -> _Duals:
    problem = within.problem
    comfort = problem.comfort_price
    if within.budget is not None:
        comfort = max(-float(found.row_duals[within.budget[0]]), 0.0)
    energy = found.row_duals[within.balance] / float(problem.home.slot_length)
    return _Duals(energy, comfort, within.read(found))


def _modes(problem: PlanningProblem, views: list[View], comfort: float, tolerance: float) -> BestModes:
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
            price=comfort,
        )
    energy = float(home.battery.min_energy) if problem.energy is None else problem.energy
    return best_modes(home, energy, slot_modes(problem, views), building, tolerance)


def _in_modes(problem: PlanningProblem, modes: SlotModes) -> WrittenProblem:
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
