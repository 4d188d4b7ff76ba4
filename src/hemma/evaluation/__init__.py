"""Replay a controller on a home, its metrics at equal comfort, and statistics over seeds."""

from hemma.evaluation.metrics import EqualComfort, Metrics, measure
from hemma.evaluation.replay import Outcome, evaluate, evaluate_stacked
from hemma.evaluation.schedules import (
    EXOGENOUS_COLUMNS,
    SCHEDULE_COLUMNS,
    SavedSchedule,
    read_schedule,
    write_exogenous,
    write_schedule,
)
from hemma.evaluation.statistics import Interval, Summary, summarise

__all__ = [
    "EXOGENOUS_COLUMNS",
    "SCHEDULE_COLUMNS",
    "EqualComfort",
    "Interval",
    "Metrics",
    "Outcome",
    "SavedSchedule",
    "Summary",
    "evaluate",
    "evaluate_stacked",
    "measure",
    "read_schedule",
    "summarise",
    "write_exogenous",
    "write_schedule",
]
