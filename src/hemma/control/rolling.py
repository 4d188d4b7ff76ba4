"""Rolling-horizon optimisation (MPC): plan battery and HVAC, do the first slot, measure, plan again."""

from dataclasses import dataclass

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float, Int

from hemma.control.adaptation import Adaptation, corrected, unadapted
from hemma.control.sensors import Measured, Readings, faultless, first_measured, measure_state, taught
from hemma.errors import HemmaError
from hemma.home import Home, HomeState, Trajectory
from hemma.home.precision import in_double, in_numpy
from hemma.optimisation.affine import AffineResponse, affine_response
from hemma.optimisation.carry_out import carry_out
from hemma.optimisation.odd_prices import best_plan
from hemma.optimisation.planning import PlanningProblem
from hemma.optimisation.programme import SolverSettings
from hemma.types import Action, Array, Exogenous

DEAR = 1000.0
"""How many times its dearest energy a plan would pay for comfort, see ``comfort_price``."""
ROUGH = SolverSettings(rounds=3, most_branched=10)
"""Of a plan only the first slot is carried out: at odd prices a proof is not worth more."""


def rolling_mpc(
    planning_home: Home,
    real_home: Home,
    exogenous: Exogenous,
    forecasts: Exogenous,
    readings: Readings | None = None,
    adapts: bool = False,
) -> Trajectory:
    """Run ``real_home`` from its start through ``exogenous``, planning every slot through ``planning_home``.

    Row t of ``forecasts`` (slots, horizon) is what slot t believes of the slots t, t + 1, ...; column 0 is
    taken as it stands, so it should be the truth (``forecasting.outlook`` makes it so). A plan minimises the
    sum of X1 + X2 + beta X3 over its slots, subject to (3) to (8), from the measured temperature and energy;
    beta is ``comfort_price``. No plan reaches beyond the end of the period, and energy left at the end of a
    plan has no value, as in objective (1).

    The planning home's thermal model must be affine in the HVAC power; another raises ``HemmaError``.
    ``readings`` say what is measured of temperature and energy, and what disturbs the real home; without
    them everything is as it is. What they make of ``exogenous`` is the affair of whoever forecasts. If it
    ``adapts``, it plans through a building that is corrected by what was measured before
    (``control.adaptation``). All results are NumPy float64.
    """
    horizon = _checked_horizon(exogenous, forecasts)
    readings = faultless(exogenous) if readings is None else readings
    believed, beliefs = in_numpy((planning_home, forecasts))
    with jax.enable_x64(True):
        planning, ahead = in_double((planning_home, forecasts))
        real = _RealHome(*in_double((real_home, exogenous, readings)))
        initial = state = real.home.reset()
        last = first_measured(state)
        adaptation = unadapted(planning) if adapts else None
    actions = np.empty((exogenous.slots, 2))
    for slot in range(exogenous.slots):
        planned = min(horizon, exogenous.slots - slot)
        with jax.enable_x64(True):
            index = jnp.asarray(slot)
            before, last = last, real.measured(state, index, last)
            now, temperature = planning, last.temperature
            if adaptation is not None:
                if slot > 0:
                    power = jnp.asarray(actions[slot - 1, 1])
                    measured = (before, last)
                    adaptation = _learned(adaptation, planning, real.readings, index - 1, power, measured)
                now = corrected(planning, adaptation)
                temperature = _present(adaptation, planning, real.readings, index, temperature)
            thermal = now.thermal_model.initial(temperature)
            response = _first(affine_response(now, _row(ahead, index), thermal), planned)
            window = jax.tree.map(lambda x, slot=slot, planned=planned: x[slot, :planned], beliefs)
            actions[slot] = _plan(believed, window, response, float(last.energy))
            state = real.after(state, index, actions[slot])
    return carry_out(real_home, exogenous, Action(*actions.T), initial, readings.disturbance)


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


def _checked_horizon(exogenous: Exogenous, forecasts: Exogenous) -> int:
    shape = np.shape(forecasts.pv_generation)
    if len(shape) != 2 or shape[0] != exogenous.slots or shape[1] < 1:
        raise HemmaError(
            f"MPC: expected forecasts of shape (slots, horizon) with {exogenous.slots} slots, got {shape}; "
            "make them for this period with hemma.forecasting.outlook"
        )
    return shape[1]


@dataclass(frozen=True)
class _RealHome:
    """The home that carries the first slot of every plan out; all numbers are JAX arrays of float64."""

    home: Home
    exogenous: Exogenous
    readings: Readings

    def measured(self, state: HomeState, slot: Int[Array, ""], last: Measured) -> Measured:
        """What is read of ``state`` at the start of ``slot``."""
        return _measured(self.home, state, self.readings, slot, last)

    def after(self, state: HomeState, slot: Int[Array, ""], action: Float[np.ndarray, "2"]) -> HomeState:
        """State at the end of ``slot`` under ``action`` = (e, h) [kW]."""
        driven = (self.exogenous, self.readings.disturbance)
        return _stepped(self.home, driven, slot, state, Action(*jnp.asarray(action)))


_measured = eqx.filter_jit(measure_state)


@eqx.filter_jit
def _learned(
    adaptation: Adaptation,
    believed: Home,
    readings: Readings,
    slot: Int[Array, ""],
    hvac_power: Array,
    measured: tuple[Measured, Measured],
) -> Adaptation:
    """After ``slot``, which began and ended with what was ``measured``."""
    read = jax.tree.map(lambda x: x[slot], readings.exogenous)
    return adaptation.learned(believed, taught(*measured), read, hvac_power)


@eqx.filter_jit
def _present(
    adaptation: Adaptation, believed: Home, readings: Readings, slot: Int[Array, ""], reading: Array
) -> Array:
    read = jax.tree.map(lambda x: x[slot], readings.exogenous)
    return adaptation.temperature(believed, reading, read)


@eqx.filter_jit
def _stepped(
    home: Home, driven: tuple[Exogenous, Array], slot: Int[Array, ""], state: HomeState, action: Action
) -> HomeState:
    now, disturbance = jax.tree.map(lambda x: x[slot], driven)
    return home.step(state, now, action, disturbance).state


@jax.jit
def _row(exogenous: Exogenous, slot: Int[Array, ""]) -> Exogenous:
    return jax.tree.map(lambda x: x[slot], exogenous)
