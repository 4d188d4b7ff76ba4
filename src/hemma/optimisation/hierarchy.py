"""The expert (HMPC): one level plans the HVAC, the next the battery, and the home carries them out."""

from collections.abc import Callable
from dataclasses import dataclass, field

import jax
import numpy as np
from jaxtyping import Float

from hemma.errors import HemmaError
from hemma.home import Home, HomeState, Trajectory
from hemma.optimisation.battery import BatterySchedule, schedule_battery
from hemma.optimisation.carry_out import carry_out
from hemma.optimisation.exact.programme import SolverSettings
from hemma.optimisation.horizon import EVERY_DAY, WHOLE_PERIOD, Horizon
from hemma.optimisation.hvac import DescentSettings, plan_hvac
from hemma.types import Action, Exogenous

Progress = Callable[[int, int], None]
"""``on_progress(slots planned, slots in all)``."""


@dataclass(frozen=True)
class HierarchySettings:
    """How both levels plan."""

    hvac: Horizon = EVERY_DAY
    """Horizon of the upper level; each plan starts from the temperature that the real home then has."""
    battery: Horizon = WHOLE_PERIOD
    """Horizon of the lower level. The whole period is hindsight: the demonstrations lie in the past."""
    descent: DescentSettings = field(default_factory=DescentSettings)
    solver: SolverSettings = field(default_factory=SolverSettings)
    seed: int = 0
    """Of the real home's thermal disturbance, where it has one."""


@dataclass(frozen=True)
class HierarchyRun:
    """What the expert did over a period."""

    trajectory: Trajectory
    """What the real home saw and did, NumPy float64."""
    battery: BatterySchedule
    """The lower level's schedule, its cost, bound and gap."""
    plans: int
    """Plans of the upper level."""
    iterations: int
    """Most iterations that one of them took."""
    residual: float
    """Largest residual that one of them ended with [kW]; all converged."""


@dataclass(frozen=True)
class _Upper:
    hvac_power: Float[np.ndarray, "slots"]
    iterations: tuple[int, ...]
    residuals: tuple[float, ...]


def run_hierarchy(
    planning_home: Home,
    real_home: Home,
    exogenous: Exogenous,
    settings: HierarchySettings | None = None,
    on_progress: Progress | None = None,
) -> HierarchyRun:
    """Plan through ``planning_home`` with ``exogenous`` known, carry out on ``real_home`` from its start.

    ``planning_home`` is the real home with the identified network as its thermal model. The battery does
    not act on the temperature, so the upper level goes through the whole period first; its power, as the
    real home carried it out, is the lower level's known demand.

    Raises ``HemmaError`` if a plan of the upper level does not converge or one of the lower is not solved.
    """
    settings = HierarchySettings() if settings is None else settings
    with jax.enable_x64(True):
        initial = jax.tree.map(np.asarray, real_home.reset())
        disturbances = np.asarray(real_home.disturbances(jax.random.key(settings.seed), exogenous.slots))
    upper = _upper(planning_home, real_home, exogenous, settings, (initial, disturbances), on_progress)
    lower = schedule_battery(
        real_home, exogenous, upper.hvac_power, initial, settings.battery, settings.solver
    )
    actions = Action(lower.battery_power, upper.hvac_power)
    return HierarchyRun(
        trajectory=carry_out(real_home, exogenous, actions, initial, disturbances),
        battery=lower,
        plans=len(upper.iterations),
        iterations=max(upper.iterations),
        residual=max(upper.residuals),
    )


def _upper(
    planning_home: Home,
    real_home: Home,
    exogenous: Exogenous,
    settings: HierarchySettings,
    start: tuple[HomeState, np.ndarray],
    on_progress: Progress | None,
) -> _Upper:
    """Plan, carry out, measure the temperature, plan again."""
    state, disturbances = start
    powers, iterations, residuals = [], [], []
    windows = list(settings.hvac.windows(exogenous.slots, float(real_home.slot_length)))
    longest = max(window.end - window.start for window in windows)
    for window in windows:
        with jax.enable_x64(True):
            measured = planning_home.thermal_model.initial(state.indoor_temperature)
        ahead = exogenous.window(window.start, window.end)
        plan = plan_hvac(planning_home, ahead, measured, settings.descent, longest)
        if not plan.converged:
            raise HemmaError(
                f"expert: expected a converged HVAC plan from slot {window.start}, it still moved by "
                f"{float(plan.residual):.3g} kW after {int(plan.iterations)} iterations; allow more "
                "(max_iterations) or a larger tolerance"
            )
        h = np.asarray(plan.hvac_power)[: window.stop - window.start]
        done = slice(window.start, window.stop)
        actions = Action(np.zeros_like(h), h)
        path = carry_out(
            real_home, exogenous.window(window.start, window.stop), actions, state, disturbances[done]
        )
        state = jax.tree.map(lambda x: np.asarray(x[-1]), path.steps.state)
        powers.append(path.steps.action.hvac_power)
        iterations.append(int(plan.iterations))
        residuals.append(float(plan.residual))
        if on_progress is not None:
            on_progress(window.stop, exogenous.slots)
    return _Upper(np.concatenate(powers), tuple(iterations), tuple(residuals))
