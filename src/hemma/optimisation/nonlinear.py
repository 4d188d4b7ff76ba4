"""DNLP: perfect information as a nonlinear programme, solved by an interior-point method.

An independent check of ``hemma.optimisation.optimum``: another formulation of equations (1) to (8), written
slot by slot from the explicit building model, and another solver (IPOPT through CasADi, the extra ``nlp``).
The kinks of the cost and of the battery are absolute values:

    X1 = (u+ + u-)/2 g dt + (u+ - u-)/2 |g| dt,     X2 = k_e |e| dt,
    E' = E + (eta_c + 1/eta_d)/2 e dt - (1/eta_d - eta_c)/2 |e| dt.

Each is a variable |x| >= x, |x| >= -x where a larger one cannot lower the cost. In slots in which it can
(selling dearer than buying; prices so negative that charging while discharging pays) it is smooth,
|x| = sqrt(x^2 + delta^2), and the programme is not convex.
"""

import equinox as eqx
import jax
import numpy as np
from jaxtyping import Float

from hemma.errors import HemmaError
from hemma.home import ExplicitThermalModel, Home, HomeState, Trajectory
from hemma.home.precision import in_numpy
from hemma.optimisation.carry_out import carry_out
from hemma.optimisation.exact.constraints import ROUNDING, arbitrage_pays, idling_pays
from hemma.optimisation.nonlinear_programme import NonlinearProgramme, Symbols
from hemma.types import Action, Exogenous

COMFORT_SLACK = 1e-4
"""Added to every budget [degC in total]: an interior-point method needs room between its constraints."""


class NonlinearOptimum(eqx.Module):
    """A schedule of the whole period, and what the solver says about it."""

    trajectory: Trajectory
    """What the home did with it, float64: actions, energies, temperatures and costs of every slot."""
    budget: float
    """D [degC], the largest sum of X3 that was allowed, but for ``COMFORT_SLACK``."""
    convex: bool
    """Whether the programme was convex: only then is the local optimum the optimum."""
    status: str
    """IPOPT's own word for how it ended."""

    @property
    def actions(self) -> Action:
        """e and h [kW], shape (slots,), as the home carried them out."""
        return self.trajectory.steps.action

    @property
    def cost(self) -> float:
        """Sum of X1 + X2 [currency]."""
        costs = self.trajectory.steps.costs
        return float(np.sum(costs.transaction) + np.sum(costs.ageing))

    @property
    def deviation(self) -> float:
        """Sum of X3 [degC]."""
        return float(np.sum(self.trajectory.steps.costs.temperature_deviation))


def nonlinear_optimum(
    home: Home, exogenous: Exogenous, initial: HomeState | None = None, budget: float | None = None
) -> NonlinearOptimum:
    """Minimise the sum of X1 + X2 subject to (3) to (8) and sum of X3 <= D = ``budget`` [degC].

    First the least reachable sum of X3 is found; it is the budget unless one is given. ``initial`` is the
    home's own initial state unless given. Disturbances are taken as zero. Where the programme is not convex
    IPOPT finds a local optimum only, which may cost more than the proven one of ``optimum_problem``. The
    schedule is feasible in either case: it is what the home does with the planned energies and HVAC powers.

    Raises ``HemmaError`` without CasADi, for traces that are not finite, for a home whose thermal model is
    not the explicit one, for a battery that starts outside its limits, for a budget below the least, and if
    IPOPT does not converge.
    """
    home, exogenous = in_numpy((home, exogenous))
    _require_finite(exogenous)
    if initial is None:
        with jax.enable_x64(True):
            initial = home.reset()
    budget = _checked_budget(budget, _least_deviation(home, exogenous, initial), exogenous.slots)
    programme = NonlinearProgramme(exogenous.slots)
    h, deviation = _building(programme, home, exogenous, initial)
    programme.constrain(programme.total(deviation), -np.inf, budget + COMFORT_SLACK)
    e, throughput, E = _battery(programme, home, exogenous, initial)
    g = h + e + (exogenous.load - exogenous.pv_generation)
    ageing = home.battery.ageing_cost * home.slot_length * throughput
    found = programme.minimise(programme.total(_transaction(programme, g, home, exogenous) + ageing))
    path = carry_out(home, exogenous, Action(_power(home, initial, found.of(E)), found.of(h)), initial)
    return NonlinearOptimum(path, budget, programme.convex, found.status)


def _building(
    programme: NonlinearProgramme, home: Home, exogenous: Exogenous, initial: HomeState
) -> tuple[Symbols, Symbols]:
    """h [kW] and X3 [degC], equations (2), (6) and (7).

    T' = eps T + (1 - eps) (T_out +- (eta / A) h);  X3 >= T' - T^upp, X3 >= T^low - T', X3 >= 0.
    """
    model, comfort, most = home.thermal_model, home.comfort, home.hvac.max_power
    if type(model) is not ExplicitThermalModel:
        raise HemmaError(
            f"DNLP: expected a home with the explicit thermal model, got {type(model).__name__}; use the "
            "proven optimum (hemma.optimisation.optimum), which plans through any affine model"
        )
    h = programme.variable(0.0, most, most / 2)
    T = programme.variable(-np.inf, np.inf, comfort.low if home.hvac.heats else comfort.high)
    deviation = programme.variable(0.0, np.inf, 1.0)
    moved = (1.0 if home.hvac.heats else -1.0) * model.efficiency / model.conductance * h
    kept = model.inertia * programme.before(float(initial.indoor_temperature), T)
    after = kept + (1 - model.inertia) * (exogenous.outdoor_temperature + moved)
    programme.constrain(T - after, 0.0, 0.0)
    programme.constrain(deviation - T, -comfort.high, np.inf)
    programme.constrain(deviation + T, comfort.low, np.inf)
    return h, deviation


def _battery(
    programme: NonlinearProgramme, home: Home, exogenous: Exogenous, initial: HomeState
) -> tuple[Symbols, Symbols, Symbols]:
    """e, |e| [kW] and E at the end of each slot [kWh], equations (3) to (5)."""
    battery, came = home.battery, float(initial.battery_energy)
    energy = float(np.clip(came, battery.min_energy, battery.max_energy))
    if not abs(energy - came) <= ROUNDING:
        raise HemmaError(
            f"DNLP: expected an initial energy from {battery.min_energy:g} to {battery.max_energy:g} kWh, "
            f"got {came:g}; correct the initial state"
        )
    e = programme.variable(-battery.max_discharging_power, battery.max_charging_power, 0.0)
    E = programme.variable(battery.min_energy, battery.max_energy, energy)
    most = max(battery.max_charging_power, battery.max_discharging_power)
    size = programme.size(e, most, idling_pays(battery, exogenous))
    mean = (battery.charging_efficiency + 1 / battery.discharging_efficiency) / 2
    loss = (1 / battery.discharging_efficiency - battery.charging_efficiency) / 2
    change = home.slot_length * (mean * e - loss * size)
    programme.constrain(E - programme.before(energy, E) - change, 0.0, 0.0)
    return e, size, E


def _transaction(programme: NonlinearProgramme, g: Symbols, home: Home, exogenous: Exogenous) -> Symbols:
    """X1 [currency] of the grid power ``g`` [kW], equation (1)."""
    mean = (exogenous.buying_price + exogenous.selling_price) / 2
    spread = (exogenous.buying_price - exogenous.selling_price) / 2
    powers = home.hvac.max_power, home.battery.max_charging_power, home.battery.max_discharging_power
    most = np.abs(exogenous.load - exogenous.pv_generation) + sum(powers)
    size = programme.size(g, most, arbitrage_pays(exogenous))
    return home.slot_length * (mean * g + spread * size)


def _power(home: Home, initial: HomeState, energy: np.ndarray) -> Float[np.ndarray, "slots"]:
    """e [kW] that leads from one planned energy [kWh] to the next: equation (5) solved for e."""
    change = np.diff(energy, prepend=float(initial.battery_energy)) / home.slot_length
    battery = home.battery
    return np.where(change > 0, change / battery.charging_efficiency, change * battery.discharging_efficiency)


def _least_deviation(home: Home, exogenous: Exogenous, initial: HomeState) -> float:
    """The smallest sum of X3 that any schedule reaches [degC]."""
    programme = NonlinearProgramme(exogenous.slots)
    total = programme.total(_building(programme, home, exogenous, initial)[1])
    return max(float(programme.minimise(total).of(total)[0]), 0.0)


def _require_finite(exogenous: Exogenous) -> None:
    for name, values in vars(exogenous).items():
        wrong = np.flatnonzero(~np.isfinite(values))
        if wrong.size:
            raise HemmaError(
                f"DNLP: expected finite traces, got {values[wrong[0]]} for {name} in slot {wrong[0]}; fill it"
            )


def _checked_budget(budget: float | None, least: float, slots: int) -> float:
    if budget is None:
        return least
    if not budget >= least - ROUNDING * slots:
        raise HemmaError(
            f"DNLP: expected a comfort budget of at least {least:.6g} degC in total, the least this home can "
            f"reach, got {budget:.6g}; leave the budget out to get the least"
        )
    return max(budget, least)
