"""Carry a plan out on a home, so that what is reported is what the home does."""

import numpy as np
from jaxtyping import Float

from hemma.home import Battery, Home, HomeState, Schedule, Trajectory, replay_in_double
from hemma.types import Action, Array, Exogenous


def carry_out(
    home: Home,
    exogenous: Exogenous,
    actions: Action,
    initial: HomeState,
    disturbances: Float[Array, "slots"] | None = None,
) -> Trajectory:
    """What ``actions`` [kW] do to ``home`` from ``initial``, in float64; all leaves are NumPy arrays.

    ``disturbances`` are epsilon_t [degC], zero unless given.
    """
    known = np.zeros(exogenous.slots) if disturbances is None else disturbances
    return replay_in_double(home, exogenous, Schedule(actions), initial, disturbances=known)


def net_power(battery: Battery, charge: np.ndarray, discharge: np.ndarray) -> np.ndarray:
    """e [kW] that moves the same energy into the store without charging and discharging at once.

    Both are lowered by the energy that only went round: charge by r, discharge by eta_c eta_d r. The grid
    gives (1 - eta_c eta_d) r less and the battery ages less.
    """
    product = battery.charging_efficiency * battery.discharging_efficiency
    round_trip = np.minimum(charge, discharge / product)
    return (charge - round_trip) - (discharge - product * round_trip)
