"""What would be done if every slot cost what its mode says: where X1 has to be looked at more closely."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from hemma.optimisation.exact.constraints import add_battery, add_building
from hemma.optimisation.exact.modes import SlotModes, penalty
from hemma.optimisation.exact.planning import PlanningProblem
from hemma.optimisation.exact.programme import EXACT, Programme


@dataclass(frozen=True)
class OwnSchedule:
    """What is best by the modes' costs alone."""

    hvac: Float[np.ndarray, "slots"]
    """h [kW]."""
    battery: Float[np.ndarray, "slots"]
    """e [kW]."""
    deviation: float
    """Sum of X3 [degC]."""


def own_schedule(problem: PlanningProblem, modes: SlotModes, comfort: float) -> OwnSchedule:
    """The best schedule at the costs of these modes: those of battery and building, which do not meet.

    Where a mode must charge or discharge more than the battery can, it does less, at a ``penalty``: what the
    dynamic programme forgives may be such a little more.
    """
    dt, programme = float(problem.home.slot_length), Programme(problem.exogenous.slots)
    house = store = h = None
    if problem.response is not None:
        house = add_building(programme, problem.home, problem.response, comfort)
        h = programme.add_columns(modes.least_hvac, modes.most_hvac, modes.hvac_price * dt)
        programme.add_rows(0.0, 0.0, (house.hvac, 1.0), (h, -1.0))
    if problem.energy is not None:
        store = add_battery(programme, problem.home, problem.exogenous, problem.energy)
        lengths = modes.pieces(modes.least_power, modes.most_power)
        parts = [
            programme.add_columns(0.0, kW, price * dt)
            for kW, price in zip(lengths.T, modes.prices.T, strict=True)
        ]
        dear = penalty(problem.home.battery, modes) * dt
        short = programme.add_columns(0.0, np.maximum(modes.least_power, 0.0), dear)
        over = programme.add_columns(0.0, np.maximum(-modes.most_power, 0.0), dear)
        e = ((store.charge, 1.0), (store.discharge, -1.0), *((part, -1.0) for part in parts))
        programme.add_rows(modes.least_power, modes.least_power, *e, (short, 1.0), (over, -1.0))
        programme.add_rows(-np.inf, np.maximum(modes.most_power, 0.0), (store.charge, 1.0))
        programme.add_rows(-np.inf, np.maximum(-modes.least_power, 0.0), (store.discharge, 1.0))
    x, nothing = programme.relaxed().solve(EXACT).values, np.zeros(problem.exogenous.slots)
    return OwnSchedule(
        hvac=nothing if house is None else x[house.hvac],
        battery=nothing if store is None else x[store.charge] - x[store.discharge],
        deviation=0.0 if house is None else float(np.sum(x[house.excess] + x[house.lack])),
    )
