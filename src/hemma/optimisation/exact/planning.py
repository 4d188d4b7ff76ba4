"""One plan: battery and HVAC together over some slots, written as a programme and read off its solution."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from hemma.home import Home
from hemma.optimisation.affine import AffineResponse
from hemma.optimisation.carry_out import net_power
from hemma.optimisation.exact.constraints import (
    BatteryColumns,
    Block,
    ThermalColumns,
    add_battery,
    add_building,
    comfort_budget,
    power_balance,
)
from hemma.optimisation.exact.programme import Programme, Solution
from hemma.types import Exogenous


@dataclass(frozen=True)
class PlanningProblem:
    """Minimise the sum of X1 + X2 + price X3 subject to (3) to (8) and sum of X3 <= D."""

    home: Home
    exogenous: Exogenous
    energy: float | None
    """E at the start of the first slot [kWh]; None for e = 0."""
    hvac: AffineResponse | Float[np.ndarray, "slots"]
    """How the house answers to the HVAC, or its known power [kW]."""
    comfort_price: float = 0.0
    """Of X3 [currency/degC]."""
    budget: float | None = None
    """D [degC]; None for no limit."""

    @property
    def response(self) -> AffineResponse | None:
        """None where the HVAC's power is known."""
        return self.hvac if isinstance(self.hvac, AffineResponse) else None


@dataclass(frozen=True)
class Plan:
    """What to do, and the proof of how good it is."""

    battery_power: Float[np.ndarray, "slots"]
    """e [kW]."""
    hvac_power: Float[np.ndarray, "slots"]
    """h [kW]."""
    battery_energy: Float[np.ndarray, "slots"]
    """E at the end of each slot [kWh]; NaN without battery."""
    objective: float
    bound: float
    """Proven: no plan has a smaller objective."""


@dataclass(frozen=True)
class WrittenProblem:
    """A problem as a programme, and where its quantities stand."""

    problem: PlanningProblem
    programme: Programme
    building: ThermalColumns | None
    store: BatteryColumns | None
    balance: Block
    """Rows of the power balance."""
    budget: Int[np.ndarray, "1"] | None
    """The row of the comfort budget."""

    def read(self, found: Solution) -> Plan:
        """The plan that the columns' values describe."""
        problem, x = self.problem, found.values
        slots = problem.exogenous.slots
        e, energy = np.zeros(slots), np.full(slots, np.nan)
        if self.store is not None:
            e = net_power(problem.home.battery, x[self.store.charge], x[self.store.discharge])
            energy = x[self.store.energy]
        h = problem.hvac if self.building is None else x[self.building.hvac]
        return Plan(e, np.asarray(h), energy, found.objective, found.bound)


def written(problem: PlanningProblem) -> WrittenProblem:
    """Write it down."""
    home, exogenous = problem.home, problem.exogenous
    programme = Programme(exogenous.slots)
    building = store = budget = None
    hvac = problem.hvac
    if isinstance(hvac, AffineResponse):
        building = add_building(programme, home, hvac, problem.comfort_price)
        hvac = building.hvac
        if problem.budget is not None:
            budget = comfort_budget(programme, building, problem.budget)
    if problem.energy is not None:
        store = add_battery(programme, home, exogenous, problem.energy)
    balance = power_balance(programme, home, exogenous, hvac, store)
    return WrittenProblem(problem, programme, building, store, balance, budget)
