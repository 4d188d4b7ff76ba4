"""How much of each causal controller's regret comes from the future, the building, and its policy."""

from collections.abc import Mapping, Sequence

import numpy as np

from hemma.evaluation import RegretSplit, split_regret
from hemma.methods import DEFAULT, controls, method_of
from hemma.methods.measured import measured_with_true_model, runnable
from hemma.methods.method import Known
from hemma.methods.planners import AbstractPlanner
from hemma.results.records import MethodRuns, Run
from hemma.stages.evaluate import Evaluator


def split_regrets(
    evaluator: Evaluator, known: Known, methods: Mapping[str, MethodRuns]
) -> dict[str, RegretSplit]:
    """The split of every causal method, of the means over its runs.

    A planner is compared with itself on the true building, every other method with the default controller,
    which has the best causal forecast.
    """
    planners = {
        method.name: method
        for method in runnable(controls(), known)
        if isinstance(method, AbstractPlanner) and method.is_causal
    }
    truths = {
        name: _regret(measured_with_true_model(one, evaluator, known)) for name, one in planners.items()
    }
    splits = {}
    for name, found in methods.items():
        method = method_of(name)
        if method is None or method.is_causal:
            planner = name if name in truths else DEFAULT.name
            splits[name] = split_regret(_regret(found.runs), _regret(methods[planner].runs), truths[planner])
    return splits


def _regret(runs: Sequence[Run]) -> float:
    """Mean [currency]; NaN where a run has none."""
    return float(np.mean(np.asarray([run.regret for run in runs], float)))
