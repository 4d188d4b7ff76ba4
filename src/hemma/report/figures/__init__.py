"""Every figure of the report: a new one is a module and a line in one of the tuples."""

from typing import Any

from hemma.report.figures.cost_and_comfort import COST_AND_COMFORT
from hemma.report.figures.figure import ReportFigure
from hemma.report.figures.free_run import FREE_RUN
from hemma.report.figures.panels.demonstrations import COST_BY_DEMONSTRATIONS, DEVIATION_BY_DEMONSTRATIONS
from hemma.report.figures.panels.methods import ENERGY_COST, TEMPERATURE_DEVIATION
from hemma.report.figures.panels.results import RESULTS
from hemma.report.figures.panels.week import BATTERY_LEVEL, INDOOR_TEMPERATURE, POWERS_WEEK
from hemma.report.figures.probability_of_improvement import IMPROVEMENT_OVER_HOMES, PROBABILITY_OF_IMPROVEMENT
from hemma.report.figures.regret import REGRET
from hemma.report.figures.share_of_savings import SHARE_OF_SAVINGS
from hemma.report.figures.traces_week import TRACES_WEEK
from hemma.report.figures.training import TRAINING_CURVES, TRAINING_DIAGNOSTICS
from hemma.report.subject import HomeSubject
from hemma.results.results import Results

FIGURES: tuple[ReportFigure[HomeSubject, Any], ...] = (
    RESULTS,
    COST_BY_DEMONSTRATIONS,
    DEVIATION_BY_DEMONSTRATIONS,
    ENERGY_COST,
    TEMPERATURE_DEVIATION,
    INDOOR_TEMPERATURE,
    BATTERY_LEVEL,
    POWERS_WEEK,
    TRACES_WEEK,
    COST_AND_COMFORT,
    REGRET,
    PROBABILITY_OF_IMPROVEMENT,
    TRAINING_CURVES,
    TRAINING_DIAGNOSTICS,
    FREE_RUN,
)
"""Of a home, in the order of the report."""

FIGURES_OVER_HOMES: tuple[ReportFigure[Results, Any], ...] = (SHARE_OF_SAVINGS, IMPROVEMENT_OVER_HOMES)
"""Of several homes at once."""
