"""HMPC joint: both levels of the expert in one exact plan through the identified network."""

import jax
import numpy as np
from jaxtyping import Float

from hemma.home import Home, Trajectory
from hemma.optimisation.carry_out import carry_out
from hemma.optimisation.exact.programme import EXACT, SolverSettings
from hemma.optimisation.optimum import optimum_problem
from hemma.types import Array, Exogenous


def joint_hmpc(
    planning_home: Home,
    real_home: Home,
    exogenous: Exogenous,
    disturbances: Float[Array, "slots"] | None = None,
    solver: SolverSettings = EXACT,
) -> Trajectory:
    """Plan the whole period with ``exogenous`` known, through ``planning_home``; carry out on ``real_home``.

    The plan minimises the sum of X1 + X2 at the least sum of X3 that the planning home can reach: what
    perfect information would do if the network were the building. Nothing is measured on the way. The
    thermal model must be affine in the HVAC power, as the physically consistent network is; another
    raises ``HemmaError``. ``disturbances`` are epsilon_t [degC] of the real home, zero unless given.
    """
    plan = optimum_problem(planning_home, exogenous).solve(solver=solver)
    with jax.enable_x64(True):
        initial = jax.tree.map(np.asarray, real_home.reset())
    return carry_out(real_home, exogenous, plan.actions, initial, disturbances)
