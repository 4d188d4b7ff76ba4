"""Ways to minimise the sum of X3 over h from h = 0, and what the hierarchy costs with each.

    python benchmarks/upper_level.py

The numbers stand in docs/expert.md. "Oracle" is the comfort law on the true model.
"""

import time
from collections.abc import Callable
from dataclasses import replace

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from hemma.control.comfort import ComfortHold
from hemma.data import AUSTIN2021_HOMES, load_austin2021, split
from hemma.home import ExplicitThermalModel, Home, benchmark_home, replay
from hemma.home.precision import in_double
from hemma.identification.excitation import Excitation, excite
from hemma.identification.fit import IdentificationSettings, fit
from hemma.optimisation.affine import affine_response
from hemma.optimisation.battery import schedule_battery
from hemma.optimisation.carry_out import carry_out
from hemma.optimisation.hierarchy import run_hierarchy
from hemma.optimisation.hvac import plan_hvac
from hemma.optimisation.optimum import optimum_problem
from hemma.types import Action, Array, Exogenous


@eqx.filter_jit
def descend(
    home: Home, exogenous: Exogenous, step: float, decay: float, energy: float, iterations: int
) -> Array:
    """h <- clip(h - step decay^k grad (sum X3 + energy sum h)), gradients through the thermal model."""

    def objective(h: Array) -> Array:
        def slot(state, inputs):
            now, power = inputs
            after = home.thermal_model(state, home.thermal_drivers(now, power, jnp.zeros(())))
            return after, home.comfort.deviation(after.indoor_temperature)

        deviation = jax.lax.scan(slot, home.reset().thermal, (exogenous, h))[1]
        return jnp.sum(deviation) + energy * jnp.sum(h)

    def iterate(k: Array, h: Array) -> Array:
        return jnp.clip(h - step * decay**k * jax.grad(objective)(h), 0.0, home.hvac.max_power)

    return jax.lax.fori_loop(0, iterations, iterate, jnp.zeros(exogenous.slots))


def oracle(home: Home, exogenous: Exogenous) -> np.ndarray:
    """HVAC power of the comfort law on the true model [kW]."""
    home, exogenous = in_double((home, exogenous))
    run = eqx.filter_jit(replay)
    path = run(home, exogenous, ComfortHold(home), home.reset(), jax.random.key(0))
    return np.asarray(path.steps.action.hvac_power)


def compare(home: Home, exogenous: Exogenous, ways: dict[str, Callable[[], Array]]) -> None:
    """One line each: cost of the hierarchy and energy over the oracle's, mean X3, seconds once compiled."""
    best = oracle(home, exogenous)
    cost = schedule_battery(home, exogenous, best, home.reset()).cost
    for name, way in ways.items():
        way()
        start = time.perf_counter()
        h = np.asarray(way())
        seconds = time.perf_counter() - start
        more = schedule_battery(home, exogenous, h, home.reset()).cost / cost - 1
        path = carry_out(home, exogenous, Action(np.zeros_like(h), h), home.reset())
        deviation = float(np.mean(path.steps.costs.temperature_deviation))
        energy = h.sum() / best.sum() - 1
        print(f"{name:44s} cost {more:+8.2%}  energy {energy:+8.2%}  X3 {deviation:.4f}  {seconds:6.3f} s")


def ways(home: Home, exogenous: Exogenous) -> dict[str, Callable[[], Array]]:
    """Plain descent, descent with a price on energy, and what Hemma does."""
    inputs = in_double((home, exogenous))
    b = abs(affine_response(home, exogenous, home.reset().thermal).gain[0, 0])

    def way(step: float, decay: float, energy: float, iterations: int) -> Callable[[], Array]:
        return lambda: descend(*inputs, step / b, decay, energy * b, iterations)

    return {
        "plain, constant step 0.03 kW": way(0.03, 1.0, 0.0, 2000),
        "plain, constant step 0.01 kW": way(0.01, 1.0, 0.0, 2000),
        "plain, falling step 0.3 * 0.99^k": way(0.3, 0.99, 0.0, 2000),
        "energy price 0.02 b, step 0.3 * 0.995^k": way(0.3, 0.995, 0.02, 5000),
        "energy price 0.2 b, step 0.3 * 0.995^k": way(0.3, 0.995, 0.2, 5000),
        "in the predicted temperatures (hemma)": lambda: (
            plan_hvac(home, exogenous, home.reset().thermal).hvac_power
        ),
    }


def in_quarters(exogenous: Exogenous) -> Exogenous:
    """Every hour as four quarters."""
    return jax.tree.map(lambda x: np.repeat(x, 4), exogenous)


def hierarchy(name: str, planning: Home, home: Home, exogenous: Exogenous, cost: float) -> None:
    """One line: the whole expert through ``planning``, against ``cost`` of the oracle's hierarchy."""
    start = time.perf_counter()
    run = run_hierarchy(planning, home, exogenous)
    seconds = time.perf_counter() - start
    deviation = float(np.mean(run.trajectory.steps.costs.temperature_deviation))
    loss = run.battery.cost / optimum_problem(home, exogenous).solve(deviation * exogenous.slots).cost - 1
    print(
        f"{name:28s} cost {run.battery.cost:9.4f}  over the oracle's {run.battery.cost / cost - 1:+9.4%}  "
        f"over the joint optimum {loss:+8.4%}  X3 {deviation:.5f}  {seconds:5.2f} s"
    )


def main() -> None:
    """Print all tables."""
    home = benchmark_home()
    august = split(load_austin2021(1)).test.exogenous
    print("home 1, August, benchmark building")
    compare(home, august, ways(home, august))
    slow = ExplicitThermalModel(inertia=0.97).at_slot_length(0.25)
    slow_home = Home(thermal_model=slow, slot_length=0.25)
    print("home 1, August in quarters of an hour, a building with a time constant of 33 h")
    compare(slow_home, in_quarters(august), ways(slow_home, in_quarters(august)))
    record = excite(home, split(load_austin2021(1)).training.exogenous, Excitation(), jax.random.key(0))
    network = fit(record, IdentificationSettings(), jax.random.key(0)).model
    for number in AUSTIN2021_HOMES:
        parts = split(load_austin2021(number))
        for period, exogenous in (("Jun-Jul", parts.training.exogenous), ("Aug", parts.test.exogenous)):
            cost = schedule_battery(home, exogenous, oracle(home, exogenous), home.reset()).cost
            planning = replace(home, thermal_model=network)
            hierarchy(f"home {number} {period} true model", home, home, exogenous, cost)
            hierarchy(f"home {number} {period} network", planning, home, exogenous, cost)


if __name__ == "__main__":
    with jax.enable_x64(True):
        main()
