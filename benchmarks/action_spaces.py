"""What the choice of the action space is worth: learners taught on some days, measured on days after them.

    python benchmarks/action_spaces.py                            # embedded homes, June and July
    python benchmarks/action_spaces.py --method GAIL --seeds 3
    python benchmarks/action_spaces.py my-home.csv --from-day 180 --heats

The network of the building is taken to be perfect. Of each home the expert demonstrates 15 days from a day
on, and what was learned is measured on the 46 days that follow. Printed is the share of the savings of
perfect information over comfort held without a battery, at the run's own comfort, and the mean deviation
[degC].
The numbers stand in docs/stored-value.md.
"""

import argparse
from dataclasses import replace
from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np

from hemma.control.comfort import ComfortHold
from hemma.data import load_austin2021, read_canonical
from hemma.evaluation import Outcome, evaluate, evaluate_stacked
from hemma.home import Home
from hemma.methods.airl import GAIL, HA_1
from hemma.methods.bill import PPO
from hemma.methods.cloning import CLONING
from hemma.methods.maxent import MAXENT
from hemma.optimisation.demonstrations import demonstrate
from hemma.optimisation.optimum import optimum_problem
from hemma.rl import training
from hemma.rl.task import Demonstrated, Task, explicit_task, make_task, stack
from hemma.settings.experiment import Experiment
from hemma.types import Exogenous

LEARNED, MEASURED = 15, 46
METHODS = {method.name: method for method in (HA_1, GAIL, CLONING, MAXENT, PPO)}
COMFORT_PRICE = 4.0
"""beta_T of PPO in multiples of what the HVAC at full power costs in a slot of mean price."""


def main() -> None:
    """One line a home and an action space."""
    asked = arguments()
    spaces = asked.actions.split(",")
    means: dict[str, list[float]] = {space: [] for space in spaces}
    for name, exogenous, slot_length in homes(asked):
        for space in spaces:
            experiment = replace(Experiment(), actions=space)
            experiment = replace(experiment, hvac=replace(experiment.hvac, heats=asked.heats))
            shares = measured(asked, experiment, exogenous, slot_length)
            means[space].append(float(np.mean([share for share, _ in shares])))
            line = "  ".join(f"{share:6.3f} {deviation:.4f}" for share, deviation in shares)
            print(f"{name:24} {space:14} {line}   mean {means[space][-1]:.3f}", flush=True)
    for space in spaces:
        print(f"mean of homes            {space:14} {np.mean(means[space]):.3f}")


def arguments() -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("files", nargs="*", type=Path, help="canonical traces; none: the embedded homes")
    parser.add_argument("--homes", type=int, nargs="*", default=[1, 2, 5, 6], help="embedded homes")
    parser.add_argument("--from-day", type=int, default=0, help="first demonstrated day")
    parser.add_argument("--slots", type=int, default=1, help="cut each slot into so many")
    parser.add_argument("--heats", action="store_true", help="the HVAC heats")
    parser.add_argument("--method", default="HA-1", choices=METHODS)
    parser.add_argument("--actions", default="fractions,stored value", help="action spaces, by comma")
    parser.add_argument("--seeds", type=int, default=2)
    return parser.parse_args()


def homes(asked: argparse.Namespace):
    """Name, days and slot length of each home."""
    found = [read_canonical(path) for path in asked.files]
    for traces in found or [load_austin2021(number) for number in asked.homes]:
        day = round(24 / traces.slot_length)
        first = asked.from_day * day
        days = traces.exogenous.window(first, first + (LEARNED + MEASURED) * day)
        yield traces.name, finer(days, asked.slots), traces.slot_length / asked.slots


def finer(exogenous: Exogenous, parts: int) -> Exogenous:
    """The same days in slots of a part of the length; all but the clock is held."""
    held = jax.tree.map(lambda x: np.repeat(np.asarray(x, float), parts), exogenous)
    length = 24 / len(np.unique(np.asarray(exogenous.hour_of_day)))
    within = np.tile(np.arange(parts) * length / parts, exogenous.slots)
    return replace(held, hour_of_day=held.hour_of_day + within)


def measured(
    asked: argparse.Namespace, experiment: Experiment, exogenous: Exogenous, slot_length: float
) -> list[tuple[float, float]]:
    """Share of the savings and mean deviation of each run."""
    home, first = experiment.home(slot_length), round(LEARNED * 24 / slot_length)
    shown, test = exogenous.window(0, first), exogenous.window(first, exogenous.slots)
    task = stack(tasks(asked, experiment, home, shown))
    learner = METHODS[asked.method].algorithm(experiment)
    trained = training.controllers(training.train(task, learner), task, learner)
    outcomes = evaluate_stacked(home, test, trained, jax.random.split(jax.random.key(0), asked.seeds))
    idle, problem = evaluate(home, test, ComfortHold(home), jax.random.key(0)), optimum_problem(home, test)
    savings = float(np.sum(idle.cost)) - problem.solve(idle.total_deviation).cost

    def share(outcome: Outcome) -> float:
        return 1 - (float(np.sum(outcome.cost)) - problem.solve(outcome.total_deviation).cost) / savings

    return [(share(o), o.total_deviation / test.slots) for o in outcomes]


def tasks(asked: argparse.Namespace, experiment: Experiment, home: Home, days: Exogenous) -> list[Task]:
    """One a seed."""
    if asked.method == "PPO":
        usual = float(np.mean(np.abs(np.asarray(days.buying_price))))
        price = COMFORT_PRICE * usual * float(home.hvac.max_power) * float(home.slot_length)
        return [explicit_task(home, home, days, price, seed) for seed in range(asked.seeds)]
    shown = demonstrate(home, home, days, experiment.expert)
    taught = Demonstrated(*(jnp.asarray(x) for x in (shown.states, shown.actions, shown.next_states)))
    return [make_task(home, home, days, taught, seed, space=experiment.space) for seed in range(asked.seeds)]


if __name__ == "__main__":
    main()
