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
    for _ in range(settings.rounds):
        modes = _modes(problem, duals, tolerance)
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
    return _Duals(energy, comfort)


def _modes(problem: PlanningProblem, duals: _Duals, tolerance: float) -> BestModes:
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
    return best_modes(home, energy, _slot_modes(problem, duals.energy), building, tolerance)


def _slot_modes(problem: PlanningProblem, duals: Float[np.ndarray, "slots"]) -> list[SlotModes]:
    """The modes of every slot, each with its cost as a sum of what battery and HVAC cost by themselves.

    Where X1 is concave (u- > u+) a mode has the price u+ or u- for all. Where it is convex and s is in
    [u-, u+], X1 is at least s h plus its least over h of X1 - s h: u- e, s e or u+ e, with kinks where the
    HVAC can no longer make g zero. The dual of the power balance is the s that makes most of it.
    """
    home, x = problem.home, problem.exogenous
    usable = problem.energy is not None
    C, D = float(home.battery.max_charging_power) * usable, float(home.battery.max_discharging_power) * usable
    demand = np.asarray(x.load, float) - np.asarray(x.pv_generation, float)
    most = float(home.hvac.max_power)
    if problem.response is None:
        demand, most = demand + problem.hvac, 0.0
    burns, dt = idling_pays(home.battery, x) & usable, float(home.slot_length)
    found = []
    for t in range(x.slots):
        u, v, idle = float(x.buying_price[t]), float(x.selling_price[t]), float(demand[t])
        if v > u:
            sides = [(1.0, u)] * (idle + most + C > 0) + [(0.0, v)] * (idle - D < 0)
            costs = [(buys, p, p * idle * dt, p, p, p) for buys, p in sides]
        else:
            s = float(np.clip(duals[t], v, u))
            constant = u * max(idle, 0.0) + s * float(np.clip(idle, -most, 0.0)) + v * min(idle + most, 0.0)
            costs = [(1.0, s, constant * dt, v, s, u)]
        powers = [(1.0, C, 0.0), (0.0, 0.0, D)] if burns[t] else [(1.0, C, D)]
        table = np.array([power + cost for power in powers for cost in costs])
        found.append(SlotModes(*table[:, :6].T, prices=table[:, 6:], kinks=np.array([-idle - most, -idle])))
    return found


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
