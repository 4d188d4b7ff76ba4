"""Carry a plan out on a home, so that what is reported is what the home does."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from hemma.home import Battery, Home, HomeState, Step, Trajectory, observe
from hemma.home.precision import in_double
from hemma.types import Action, Array, Exogenous, Observation


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
    if disturbances is None:
        disturbances = np.zeros(exogenous.slots)
    with jax.enable_x64(True):
        inputs = in_double((home, exogenous, actions, initial, disturbances))
        return jax.tree.map(np.asarray, _carried_out(*inputs))


@eqx.filter_jit
def _carried_out(
    home: Home, exogenous: Exogenous, actions: Action, initial: HomeState, disturbances: Array
) -> Trajectory:
    def slot(
        state: HomeState, inputs: tuple[Exogenous, Action, Array]
    ) -> tuple[HomeState, tuple[Observation, Step]]:
        now, action, disturbance = inputs
        step = home.step(state, now, action, disturbance)
        return step.state, (observe(state, now), step)

    start = eqx.tree_at(lambda s: s.slot, initial, jnp.zeros((), int))
    _, (observations, steps) = jax.lax.scan(slot, start, (exogenous, actions, disturbances))
    return Trajectory(observations=observations, steps=steps)


def net_power(battery: Battery, charge: np.ndarray, discharge: np.ndarray) -> np.ndarray:
    """e [kW] that moves the same energy into the store without charging and discharging at once.

    Both are lowered by the energy that only went round: charge by r, discharge by eta_c eta_d r. The grid
    gives (1 - eta_c eta_d) r less and the battery ages less.
    """
    product = battery.charging_efficiency * battery.discharging_efficiency
    round_trip = np.minimum(charge, discharge / product)
    return (charge - round_trip) - (discharge - product * round_trip)
