"""What running seeds side by side is worth: time of one iteration of Algorithm 1 a run, alone and stacked.

    python benchmarks/training.py

One table; compilation is left out. All are measured in turn within one process, machines being noisy.
"""

import statistics
import time

import jax

from hemma.data import load_austin2021
from hemma.home import benchmark_home
from hemma.irl.airl import AdversarialImitation
from hemma.optimisation.demonstrations import demonstrate
from hemma.rl import training
from hemma.rl.task import Demonstrated, Task, make_task, stack

RUNS = (1, 2, 4, 5, 8)
ROUNDS = 4
DAYS = 15


def tasks() -> list[Task]:
    """The same days, other seeds."""
    home = benchmark_home()
    days = load_austin2021(1).window(0, 24 * DAYS).exogenous
    shown = demonstrate(home, home, days)
    demonstrated = Demonstrated(shown.states, shown.actions, shown.next_states)
    return [make_task(home, home, days, demonstrated, seed) for seed in range(max(RUNS))]


def seconds(run: training.Training, task: Task, learner: AdversarialImitation) -> float:
    """Wall-clock time of one chunk of iterations."""
    start = time.perf_counter()
    jax.block_until_ready(training.advance(run, task, learner))
    return time.perf_counter() - start


def main() -> None:
    """Print the table."""
    learner = AdversarialImitation()
    stacked = {runs: stack(tasks()[:runs]) for runs in RUNS}
    begun = {runs: training.begin(task, learner) for runs, task in stacked.items()}
    for runs in RUNS:
        seconds(begun[runs], stacked[runs], learner)
    rounds = [{runs: seconds(begun[runs], stacked[runs], learner) for runs in RUNS} for _ in range(ROUNDS)]
    print("runs  ms an iteration and run  of one alone")
    for runs in RUNS:
        each = [1e3 * r[runs] / runs / training.CHUNK for r in rounds]
        share = statistics.median(r[runs] / runs / r[1] for r in rounds)
        print(f"{runs:4d}  {statistics.median(each):23.1f}  {share:12.2f}")


if __name__ == "__main__":
    main()
