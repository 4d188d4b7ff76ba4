"""The best plan at any prices: a linear programme, or modes first where buying and selling are odd.

Where selling is dearer than buying or burning energy pays, modes (``optimisation.modes``) take the place of
branch and bound. They prove a bound with prices of the other slots' energy and of comfort that are the duals of
a linear programme; see ``docs/expert.md``.
"""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float

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


def best_plan(problem: PlanningProblem, settings: SolverSettings = EXACT) -> Plan:
    """The plan with the least objective, and the bound that was proved within the settings' work.

    Raises ``HemmaError`` if there is no plan.
    """
    whole = written(problem)
    if not whole.programme.has_whole:
        return whole.read(whole.programme.solve(settings))
    if not _separable(problem):
        return whole.read(whole.programme.solve(settings))
    plan = _by_modes(problem, whole, settings)
    if settings.proves(plan.objective, plan.bound) or settings.max_nodes == 0:
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
    return _Duals(found.row_duals[within.balance] / float(problem.home.slot_length), comfort)


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
    return best_modes(home, energy, _slot_modes(problem, duals), building, tolerance)


def _slot_modes(problem: PlanningProblem, duals: _Duals) -> list[SlotModes]:
    """The modes of every slot; those in which no grid power of the right sign is possible are left out.

    Where buying costs no less than selling brings, X1 = max over p in [u-, u+] of p g dt: any such p
    bounds it from below, the dual of the power balance well.
    """
    home, x = problem.home, problem.exogenous
    battery, dt = home.battery, float(home.slot_length)
    usable = problem.energy is not None
    C, D = float(battery.max_charging_power) * usable, float(battery.max_discharging_power) * usable
    u, v = np.asarray(x.buying_price, float), np.asarray(x.selling_price, float)
    demand = np.asarray(x.load, float) - np.asarray(x.pv_generation, float)
    most = 0.0
    if problem.response is None:
        demand = demand + problem.hvac
    else:
        most = float(home.hvac.max_power)
    burns = idling_pays(battery, x) & usable
    found = []
    for t in range(x.slots):
        rows = []
        for charges, c, d in ((1.0, C, 0.0), (0.0, 0.0, D)) if burns[t] else ((1.0, C, D),):
            low, high = demand[t] - d, demand[t] + most + c
            if high <= 0 or low >= 0:
                rows.append((float(low >= 0), charges, u[t] if low >= 0 else v[t], c, d))
            elif v[t] > u[t]:
                rows += [(1.0, charges, u[t], c, d), (0.0, charges, v[t], c, d)]
            else:
                rows.append((1.0, charges, np.clip(duals.energy[t], v[t], u[t]), c, d))
        table = np.array(rows)
        found.append(SlotModes(*table.T, constant=table[:, 2] * demand[t] * dt))
    return found


def _in_modes(problem: PlanningProblem, modes: BestModes) -> WrittenProblem:
    """The linear programme with these modes.

    A slot that buys has the price u+ for whatever it does, one that sells u-: never less than X1.
    """
    x = problem.exogenous
    u, v = np.asarray(x.buying_price, float), np.asarray(x.selling_price, float)
    odd: Bool[np.ndarray, "slots"] = v > u
    price = np.where(modes.buys > 0, u, v)
    prices = replace(x, buying_price=np.where(odd, price, u), selling_price=np.where(odd, price, v))
    inside = written(replace(problem, exogenous=prices))
    burns = idling_pays(problem.home.battery, prices)
    fixed = modes.charges[burns] if problem.energy is not None else np.zeros(0)
    return replace(inside, programme=inside.programme.fixed(fixed))
