"""Stage: demonstrations of a planner that knows no more than its policy may: the default controller's."""

import time

import jax.numpy as jnp
import numpy as np

from hemma.control.rolling import RollingPlanner
from hemma.home import replay_in_double
from hemma.optimisation.demonstrations import states_and_actions
from hemma.results.fingerprint import code, fingerprint
from hemma.results.store import Store
from hemma.rl.task import Demonstrated
from hemma.stages.demonstrate import INDOOR, Demonstration, Expert
from hemma.stages.observer import HomeObserver

STAGE = "demonstrate causally"


def causal_demonstration(store: Store, expert: Expert, observer: HomeObserver, days: int) -> Demonstration:
    """What the rolling planner does on the first ``days`` days, with forecasts that have not seen them.

    It plans as the default controller does (``control.rolling``), each three days with a forecast fitted
    to all other training days, and with published prices where its policy sees them. Demonstrations of an
    earlier run are taken again.
    """
    case = expert.case
    layers = code("forecasting", "optimisation", "control")
    facts = (observer.facts, observer.model.published, case.experiment.forecast_horizon)
    mark = fingerprint(STAGE, layers, expert.mark, facts, days)
    variant = "-published" if observer.model.published else ""
    product = f"causal-demonstrations-{days}-days{variant}"
    content = store.product(product, mark, lambda: (_shown(store, expert, observer, days), []), STAGE)
    arrays = (jnp.asarray(content[name], float) for name in ("states", "actions", "next_states"))
    return Demonstration(days, Demonstrated(*arrays), mark)


def _shown(store: Store, expert: Expert, observer: HomeObserver, days: int) -> dict:
    case, begun = expert.case, time.monotonic()
    period, dt = case.first_days(days), float(case.home.slot_length)
    store.progress.started(STAGE, 1)
    known = case.first_days(case.training_days)
    ahead = observer.sees.training_forecast(known, period.slots, dt, case.experiment.forecast_horizon)
    planner, quiet = RollingPlanner(expert.planning_home, ahead), np.zeros(period.slots)
    path = replay_in_double(case.home, period, planner, disturbances=quiet)
    states, actions = states_and_actions(path)
    deviation = float(np.mean(case.home.comfort.deviation(states[1:, INDOOR])))
    message = f"{days} days, {len(states) - 1} transitions, mean deviation {deviation:.3f} °C"
    store.progress.finished(STAGE, message)
    return {
        "message": message,
        "seconds": time.monotonic() - begun,
        "states": states[:-1].tolist(),
        "actions": actions[:-1].tolist(),
        "next_states": states[1:].tolist(),
    }
