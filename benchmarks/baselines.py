"""Share of savings of the optimisation baselines: fitted on 1 June to 15 July, measured on 16 to 31 July.

    python benchmarks/baselines.py

The numbers stand in docs/baselines.md. August, the test month, is not looked at.
"""

import time
from collections.abc import Callable
from dataclasses import replace

import equinox as eqx
import jax

from hemma.control.rolling import RollingPlanner
from hemma.control.thresholds import fit_thresholds
from hemma.data import load_austin2021
from hemma.evaluation import evaluate, measure
from hemma.forecasting.outlook import Forecaster, Outlook, hourly_means, perfect, yesterday
from hemma.forecasting.ridge import fitted
from hemma.home import AbstractController, Schedule, benchmark_home
from hemma.identification import Excitation, IdentificationSettings, excite, fit
from hemma.optimisation.joint import joint_hmpc
from hemma.optimisation.optimum import optimum_problem
from hemma.stages.evaluate import at_equal_comfort
from hemma.types import Exogenous

HOMES = (1, 4)
FIT, MEASURE = (0, 45), (45, 61)
"""Days of June and July, from 1 June on."""
REAL = benchmark_home()


def main() -> None:
    """Print one line a home and method."""
    print("home method                         share   cost [$]  mean X3 [degC]  seconds")
    for number in HOMES:
        exogenous = load_austin2021(number).exogenous
        past, period = (exogenous.window(24 * first, 24 * stop) for first, stop in (FIT, MEASURE))
        measured(number, past, period)


def measured(number: int, past: Exogenous, period: Exogenous) -> None:
    """All methods on one home."""
    keys = jax.random.split(jax.random.key(0))
    network = fit(excite(REAL, past, Excitation(), keys[0]), IdentificationSettings(), keys[1]).model
    believed = eqx.tree_at(lambda home: home.thermal_model, REAL, network)
    problem = optimum_problem(REAL, period)

    def line(name: str, make: Callable[[], AbstractController]) -> None:
        begun = time.monotonic()
        controller = make()
        seconds = time.monotonic() - begun
        outcome = evaluate(REAL, period, controller, jax.random.key(0))
        deviation = max(outcome.total_deviation, problem.least_deviation)
        reference = at_equal_comfort(problem, deviation)
        found = measure(outcome, reference)
        share = float("nan") if found.share_of_savings is None else 100 * found.share_of_savings
        print(
            f"{number:4} {name:27} {share:8.2f} % {found.energy_cost:9.3f} "
            f"{found.mean_temperature_deviation:15.5f} {seconds:8.1f}",
            flush=True,
        )

    def mpc(forecaster: Forecaster, horizon: float = 36.0) -> Callable[[], AbstractController]:
        outlook = Outlook(past, period, float(REAL.slot_length), horizon)
        return lambda: RollingPlanner(believed, forecaster(outlook))

    line("thresholds", lambda: fit_thresholds(believed, past))
    line("thresholds, hindsight", lambda: fit_thresholds(believed, period))
    line("MPC hourly means", mpc(hourly_means))
    line("MPC yesterday", mpc(yesterday))
    line("MPC forecast", mpc(fitted))
    line("MPC forecast, 24 h", mpc(fitted, 24.0))
    line("MPC forecast, prices known", mpc(_prices_known))
    line("MPC perfect", mpc(perfect))
    line("MPC perfect, 24 h", mpc(perfect, 24.0))
    line("HMPC joint", lambda: Schedule(joint_hmpc(believed, REAL, period).steps.action))


def _prices_known(outlook: Outlook) -> Exogenous:
    """As in a day-ahead market, the rest fitted."""
    known = perfect(outlook)
    return replace(fitted(outlook), buying_price=known.buying_price, selling_price=known.selling_price)


if __name__ == "__main__":
    main()
