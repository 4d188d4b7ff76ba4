"""Perfect information: the least cost that any controller can reach, proved, at a given comfort."""

from dataclasses import dataclass, replace

import equinox as eqx
import jax
import numpy as np
from jaxtyping import Float

from hemma.errors import HemmaError
from hemma.home import Home, HomeState, Trajectory
from hemma.home.precision import in_numpy
from hemma.optimisation.affine import AffineResponse, affine_response
from hemma.optimisation.battery import relative_gap
from hemma.optimisation.carry_out import carry_out
from hemma.optimisation.exact.constraints import add_building
from hemma.optimisation.exact.odd_prices import best_plan
from hemma.optimisation.exact.planning import PlanningProblem
from hemma.optimisation.exact.programme import EXACT, Programme, SolverSettings
from hemma.types import Action, Array, Exogenous

BUDGET_SLACK = 1e-7
"""Added to every budget [degC in total], so that rounding cannot make the least deviation infeasible."""


class Optimum(eqx.Module):
    """A schedule and the proof of how good it is."""

    actions: Action
    """e and h [kW], shape (slots,), NumPy float64, as the home carried them out."""
    trajectory: Trajectory
    """The replay of these actions on the home: energies, temperatures and costs of every slot."""
    cost: float
    """Sum of X1 + X2 [currency] of that replay."""
    bound: float
    """Proven: no schedule within the budget costs less [currency]."""
    deviation: float
    """Sum of X3 [degC] of that replay."""
    budget: float
    """D [degC], the largest sum of X3 that was allowed."""

    @property
    def gap(self) -> float:
        """(cost - bound) / |cost|: no schedule can be better by more than this fraction."""
        return relative_gap(self.cost, self.bound)


@dataclass(frozen=True)
class OptimumProblem:
    """Battery and HVAC together over one period of one home, to be solved for many budgets of comfort."""

    home: Home
    exogenous: Exogenous
    initial: HomeState
    response: AffineResponse
    """The home's thermal model along the weather of the period."""
    least_deviation: float
    """The smallest sum of X3 that any schedule reaches [degC]; 0 where comfort can be held."""
    disturbances: Float[Array, "slots"] | None = None
    """epsilon_t [degC], known like everything else; None for zero."""

    def solve(
        self, budget: float | None = None, battery: bool = True, solver: SolverSettings = EXACT
    ) -> Optimum:
        """Minimise the sum of X1 + X2 subject to (3) to (8) and sum of X3 <= D = ``budget`` [degC].

        Without a budget, D is the least reachable deviation. Without ``battery`` e = 0.

        Raises ``HemmaError`` if the budget is below the least reachable deviation (by more than rounding),
        or if the solver found no schedule within its limit of work.
        """
        budget = self._checked(budget)
        energy = float(self.initial.battery_energy) if battery else None
        found = best_plan(
            PlanningProblem(self.home, self.exogenous, energy, self.response, budget=budget + BUDGET_SLACK),
            solver,
        )
        actions = Action(found.battery_power, found.hvac_power)
        path = carry_out(self.home, self.exogenous, actions, self.initial, self.disturbances)
        costs = path.steps.costs
        return Optimum(
            actions=path.steps.action,
            trajectory=path,
            cost=float(np.sum(costs.transaction) + np.sum(costs.ageing)),
            bound=found.bound,
            deviation=float(np.sum(costs.temperature_deviation)),
            budget=budget,
        )

    def _checked(self, budget: float | None) -> float:
        if budget is None:
            return self.least_deviation
        if not budget >= self.least_deviation - 1e-6 * self.exogenous.slots:
            raise HemmaError(
                f"optimum: expected a comfort budget of at least {self.least_deviation:.6g} degC in total, "
                f"the least this home can reach, got {budget:.6g}; leave the budget out to get the least"
            )
        return max(budget, self.least_deviation)


def optimum_problem(
    home: Home,
    exogenous: Exogenous,
    initial: HomeState | None = None,
    disturbances: Float[Array, "slots"] | None = None,
) -> OptimumProblem:
    """The problem of ``home`` from ``initial`` (its own initial state unless given) over ``exogenous``.

    The thermal model must be affine in the HVAC power, as the explicit model and the physically
    consistent network are; another raises ``HemmaError``. ``disturbances`` are epsilon_t [degC], zero unless
    given; perfect information knows them in advance.
    """
    home, exogenous = in_numpy((home, exogenous))
    if initial is None:
        with jax.enable_x64(True):
            initial = home.reset()
    response = affine_response(home, exogenous, initial.thermal)
    if disturbances is not None:
        response = replace(response, free=_idle_path(home, exogenous, initial, disturbances))
    programme = Programme(exogenous.slots)
    add_building(programme, home, response, price=1.0)
    least = programme.solve(EXACT).objective
    return OptimumProblem(home, exogenous, initial, response, max(least, 0.0), disturbances)


def _idle_path(
    home: Home, exogenous: Exogenous, initial: HomeState, disturbances: Float[Array, "slots"]
) -> Float[np.ndarray, "slots 2"]:
    """T_in and the model's memory [degC] at the end of each slot of the disturbed house without HVAC."""
    nothing = np.zeros(exogenous.slots)
    idle = carry_out(home, exogenous, Action(nothing, nothing), initial, disturbances)
    thermal = idle.steps.state.thermal
    return np.stack([thermal.indoor_temperature, thermal.memory], axis=1)
