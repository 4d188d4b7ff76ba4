"""Carry a plan out on the home itself, so that what is reported is what the home does."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from hemma.home import Battery, Home, HomeState, Schedule, Trajectory, replay
from hemma.home.precision import in_double
from hemma.types import Action, Array, Exogenous


def carry_out(home: Home, exogenous: Exogenous, actions: Action, initial: HomeState) -> Trajectory:
    """Replay ``actions`` [kW] in float64 without disturbance; every leaf of the result is a NumPy array."""
    with jax.enable_x64(True):
        quiet = eqx.tree_at(lambda h: h.disturbance_deviation, home, 0.0)
        inputs = in_double((quiet, exogenous, actions, initial))
        return jax.tree.map(np.asarray, _replayed(*inputs, jax.random.key(0)))


@eqx.filter_jit
def _replayed(
    home: Home, exogenous: Exogenous, actions: Action, initial: HomeState, key: Array
) -> Trajectory:
    start = eqx.tree_at(lambda s: s.slot, initial, jnp.zeros((), int))
    return replay(home, exogenous, Schedule(actions), start, key)


def net_power(battery: Battery, charge: np.ndarray, discharge: np.ndarray) -> np.ndarray:
    """e [kW] that moves the same energy into the store without charging and discharging at once.

    Both are lowered by the energy that only went round: charge by r, discharge by eta_c eta_d r. The grid
    gives (1 - eta_c eta_d) r less and the battery ages less.
    """
    product = battery.charging_efficiency * battery.discharging_efficiency
    round_trip = np.minimum(charge, discharge / product)
    return (charge - round_trip) - (discharge - product * round_trip)
