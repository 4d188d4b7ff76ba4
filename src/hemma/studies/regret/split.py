"""Stage: how much of each causal controller's regret comes from the future, the building, and its policy."""

from collections.abc import Mapping, Sequence

import numpy as np

from hemma.evaluation import RegretSplit, split_regret
from hemma.results.records import MethodRuns, Run
from hemma.stages.demonstrate import Expert
from hemma.stages.judge import Judge
from hemma.stages.planners import planners, played_with_true_model

HINDSIGHT = ("MPC perfect", "optimum", "DNLP", "HMPC", "HMPC joint")
"""They know the future: no part of their regret comes from not knowing it."""


def split_regrets(judge: Judge, expert: Expert, methods: Mapping[str, MethodRuns]) -> dict[str, RegretSplit]:
    """The split of every causal method, of the means over its runs.

    A planner is compared with itself on the true building, every other method with the planner that has the
    best causal forecast.
    """
    causal = [planner for planner in planners(expert, judge.store) if planner.is_causal]
    regrets = {name: _mean(method.runs) for name, method in methods.items()}
    truths = {one.method: _mean(played_with_true_model(one, judge)) for one in causal}
    splits = {}
    for method in regrets:
        if method in HINDSIGHT:
            continue
        planner = method if method in truths else causal[0].method
        splits[method] = split_regret(regrets[method], regrets[planner], truths[planner])
    return splits


def _mean(runs: Sequence[Run]) -> float:
    return float(np.mean(np.asarray([run.regret for run in runs], float)))
