"""How long perfect information and a rolling planner take at odd prices, and what is proved.

    python benchmarks/odd_prices.py

The numbers stand in docs/expert.md. Home 1, August, hourly, benchmark building; processor time of one thread.
"""

import time
from dataclasses import replace

import jax
import numpy as np

from hemma.control.rolling import RollingPlanner
from hemma.data import load_austin2021
from hemma.home import benchmark_home, replay_in_double
from hemma.optimisation.optimum import optimum_problem
from hemma.types import Exogenous

HOME = benchmark_home()
HORIZON = 36


def main() -> None:
    """Print one line a tariff."""
    august = load_austin2021(1).exogenous.window(24 * 61, 24 * 92)
    print("prices                           optimum   relative gap  seconds   rolling  seconds")
    for name, exogenous in tariffs(august).items():
        measured(name, exogenous)


def tariffs(x: Exogenous) -> dict[str, Exogenous]:
    """The month with prices that are odd throughout, in several ways."""
    u, flat = np.asarray(x.buying_price), np.ones(x.slots)
    prices = {
        "ordinary, u- = 0.9 u+": (u, 0.9 * u),
        "flat, 0.20 and 0.40": (0.2 * flat, 0.4 * flat),
        "u- = 1.5 u+": (u, 1.5 * u),
        "u- = 0.40": (u, 0.4 * flat),
        "negative, u- = 0.9 u+": (-u, -0.9 * u),
        "every third slot negative": (np.where(np.arange(x.slots) % 3 == 0, -u, u),) * 2,
        "negative, u- = 1.1 u+": (-u, -1.1 * u),
        "flat, -0.10 and -0.12": (-0.1 * flat, -0.12 * flat),
    }
    return {name: replace(x, buying_price=b, selling_price=s) for name, (b, s) in prices.items()}


def measured(name: str, exogenous: Exogenous) -> None:
    """Solve the month, and plan it slot by slot with the next hours known."""
    problem = optimum_problem(HOME, exogenous)
    begun = time.process_time()
    best = problem.solve()
    solved = time.process_time() - begun
    ahead = np.arange(exogenous.slots)[:, None] + np.arange(HORIZON)[None, :]
    known = jax.tree.map(lambda v: np.asarray(v)[np.minimum(ahead, exogenous.slots - 1)], exogenous)
    begun = time.process_time()
    path = replay_in_double(HOME, exogenous, RollingPlanner(HOME, known))
    seconds = time.process_time() - begun
    print(
        f"{name:28} {best.cost:11.4f} {best.gap:14.1e} {solved:8.1f} "
        f"{float(path.energy_cost):9.4f} {seconds:8.1f}",
        flush=True,
    )


if __name__ == "__main__":
    main()
