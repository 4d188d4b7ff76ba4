"""Rolling-horizon optimisation (MPC): plan battery and HVAC, do the first slot, measure, plan again."""

import jax
import jax.numpy as jnp
import numpy as np

from hemma.errors import HemmaError
from hemma.home import AbstractController, Home, Memory
from hemma.home.precision import in_numpy
from hemma.optimisation.affine import AffineResponse, affine_response
from hemma.optimisation.exact.odd_prices import best_plan
from hemma.optimisation.exact.planning import PlanningProblem
from hemma.optimisation.exact.programme import SolverSettings
from hemma.types import Action, Array, Exogenous, Observation

DEAR = 1000.0
"""How many times its dearest energy a plan would pay for comfort, see ``comfort_price``."""
ROUGH = SolverSettings(rounds=3, most_branched=10)
"""Of a plan only the first slot is carried out: at odd prices a proof is not worth more."""


class RollingPlanner(AbstractController):
    """Plans battery and HVAC of the next slots together through ``home``, and does the first of them.

    A plan minimises the sum of X1 + X2 + beta X3 over its slots, subject to (3) to (8), from the observed
    temperature and energy; beta is ``comfort_price``. No plan reaches beyond the last row of ``forecasts``,
    and energy left at the end of a plan has no value, as in objective (1).

    The home's thermal model must be affine in the HVAC power; another raises ``HemmaError``, as do forecasts
    without a row for the observed slot.
    """

    home: Home
    """As it is believed to be."""
    forecasts: Exogenous
    """(slots, horizon): row t is what slot t believes of the slots t, t + 1, ...; column 0 is taken as it
    stands, so it should be what was read (``forecasting.outlook`` makes it so)."""

    @property
    def is_traceable(self) -> bool:
        """It calls a solver."""
        return False

    def __call__(self, observation: Observation, memory: Memory, key: Array) -> tuple[Action, Memory]:
        """The first slot of the best plan."""
        slot = int(observation.slot)
        rows, horizon = self._shape(slot)
        planned = min(horizon, rows - slot)
        with jax.enable_x64(True):
            row = _row(self.forecasts, jnp.asarray(slot))
            thermal = self.home.thermal_model.initial(jnp.asarray(observation.indoor_temperature, float))
        response = _first(affine_response(self.home, row, thermal), planned)
        believed, ahead = in_numpy((self.home, row))
        e, h = _plan(believed, ahead.window(0, planned), response, float(observation.battery_energy))
        return Action(jnp.asarray(e), jnp.asarray(h)), memory

    def _shape(self, slot: int) -> tuple[int, int]:
        shape = np.shape(self.forecasts.pv_generation)
        if len(shape) != 2 or shape[0] <= slot or shape[1] < 1:
            raise HemmaError(
                f"MPC: expected forecasts of shape (slots, horizon) with a row for slot {slot}, got {shape}; "
                "make them for this period with hemma.forecasting.outlook"
            )
        return shape


def comfort_price(home: Home, window: Exogenous, response: AffineResponse) -> float:
    """beta [currency/degC], what a plan pays for X3: so much that it gives comfort up for no price.

    beta = 1000 max(|u+|, |u-|, k_e) dt / min |b|, b = dT'/dh of the HVAC [degC/kW] in the window: a thousand
    times what a degree costs that is made in its own slot at the dearest price. Made k slots earlier it costs
    a^-k times as much (a = dT'/dT), so a plan pre-cools as long as a^-k < 1000 for heat that full power
    cannot meet. Where nothing has a price or the HVAC no effect, a degree costs 1.
    """
    effects = np.abs(response.gain[:, 0])
    effects = effects[effects > 0]
    prices = (window.buying_price, window.selling_price, home.battery.ageing_cost)
    dearest = max(float(np.max(np.abs(price))) for price in prices)
    if dearest == 0 or len(effects) == 0:
        return 1.0
    return DEAR * dearest * float(home.slot_length) / float(np.min(effects))


def _plan(home: Home, window: Exogenous, response: AffineResponse, energy: float) -> tuple[float, float]:
    """e and h [kW] of the first slot of the best plan."""
    price = comfort_price(home, window, response)
    plan = best_plan(PlanningProblem(home, window, energy, response, price), ROUGH)
    return float(plan.battery_power[0]), float(plan.hvac_power[0])


def _first(response: AffineResponse, slots: int) -> AffineResponse:
    """The first ``slots`` slots alone. All are linearised at full length, so that one compilation does."""
    return AffineResponse(response.free[:slots], response.carry[:slots], response.gain[:slots])


@jax.jit
def _row(forecasts: Exogenous, slot: Array) -> Exogenous:
    return jax.tree.map(lambda x: jnp.asarray(x, float)[slot], forecasts)
