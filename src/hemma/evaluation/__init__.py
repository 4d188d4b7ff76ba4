"""Replay a controller on a home, its metrics at equal comfort, and statistics over seeds."""

from hemma.evaluation.improvement import Improvement, Pair, Sample, probability_of_improvement
from hemma.evaluation.metrics import NEGLIGIBLE, EqualComfort, Intervals, Measures, Metrics, measure
from hemma.evaluation.regret import RegretSplit, regret, split_regret
from hemma.evaluation.replay import Outcome, evaluate, evaluate_stacked
from hemma.evaluation.statistics import (
    Interval,
    IntervalKind,
    Summary,
    interquartile_mean,
    interval_kind,
    summarise,
    summarise_homes,
)

__all__ = [
    "NEGLIGIBLE",
    "EqualComfort",
    "Improvement",
    "Interval",
    "IntervalKind",
    "Intervals",
    "Measures",
    "Metrics",
    "Outcome",
    "Pair",
    "RegretSplit",
    "Sample",
    "Summary",
    "evaluate",
    "evaluate_stacked",
    "interquartile_mean",
    "interval_kind",
    "measure",
    "probability_of_improvement",
    "regret",
    "split_regret",
    "summarise",
    "summarise_homes",
]
