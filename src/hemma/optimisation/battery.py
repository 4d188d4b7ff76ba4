"""Lower level of the hierarchy: the battery's schedule with the HVAC power known, by branch and bound."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from hemma.home import Home, HomeState
from hemma.home.precision import in_numpy
from hemma.optimisation.carry_out import carry_out
from hemma.optimisation.exact.odd_prices import best_plan
from hemma.optimisation.exact.planning import PlanningProblem
from hemma.optimisation.exact.programme import EXACT, SolverSettings
from hemma.optimisation.horizon import WHOLE_PERIOD, Horizon
from hemma.types import Action, Exogenous

ZERO = 1e-9
"""Differences of cost up to this [currency] are rounding; costs nearer to zero are no denominator."""


@dataclass(frozen=True)
class BatterySchedule:
    """The battery's schedule over a period."""

    battery_power: Float[np.ndarray, "slots"]
    """e [kW], charging positive, feasible."""
    battery_energy: Float[np.ndarray, "slots"]
    """E [kWh] at the end of each slot."""
    cost: float
    """Sum of X1 + X2 [currency] as the home carries it out."""
    bound: float
    """Proven: no schedule of the whole period costs less with this HVAC power [currency]."""

    @property
    def gap(self) -> float:
        """(cost - bound) / |cost|: what the solver left open and what a short horizon lost."""
        return relative_gap(self.cost, self.bound)


def schedule_battery(
    home: Home,
    exogenous: Exogenous,
    hvac_power: Float[np.ndarray, "slots"],
    initial: HomeState,
    horizon: Horizon = WHOLE_PERIOD,
    solver: SolverSettings = EXACT,
) -> BatterySchedule:
    """Minimise the sum of X1 + X2 over e, subject to (3) to (5) and (8), with h = ``hvac_power`` [kW] known.

    The energy at the end of a plan has no value, as in objective (1). With a receding ``horizon`` the
    bound is still that of the whole period in one plan, which costs one more programme.

    Raises ``HemmaError`` if a programme has no solution or none was found within the limit of work.
    """
    home, exogenous, hvac_power = in_numpy((home, exogenous, hvac_power))
    energy, powers, plans = float(initial.battery_energy), [], []
    for window in horizon.windows(exogenous.slots, float(home.slot_length)):
        ahead = slice(window.start, window.end)
        part = exogenous.window(window.start, window.end)
        plan = best_plan(PlanningProblem(home, part, energy, hvac_power[ahead]), solver)
        done = window.stop - window.start
        powers.append(plan.battery_power[:done])
        last = plan.battery_energy[done - 1]
        energy = float(np.clip(last, home.battery.min_energy, home.battery.max_energy))
        plans.append(plan)
    if len(plans) > 1:
        whole = PlanningProblem(home, exogenous, float(initial.battery_energy), hvac_power)
        plans.append(best_plan(whole, solver))
    path = carry_out(home, exogenous, Action(np.concatenate(powers), hvac_power), initial)
    return BatterySchedule(
        battery_power=np.asarray(path.steps.action.battery_power),
        battery_energy=np.asarray(path.steps.state.battery_energy),
        cost=float(np.sum(path.steps.costs.transaction) + np.sum(path.steps.costs.ageing)),
        bound=plans[-1].bound,
    )


def relative_gap(cost: float, bound: float) -> float:
    """(cost - bound) / |cost|; what is within rounding of zero counts as zero."""
    return 0.0 if cost - bound <= ZERO else (cost - bound) / max(abs(cost), ZERO)
