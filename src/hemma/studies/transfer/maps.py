"""Stage: draw what the learned rewards want in the home that they were learned in."""

from pathlib import Path

import numpy as np

from hemma.evaluation.reward_maps import (
    Grid,
    Varied,
    answers,
    outdoor_and_indoor,
    price_and_energy,
)
from hemma.studies.transfer.report import write_maps
from hemma.studies.transfer.reward_figure import BatteryMap, ComfortMap
from hemma.studies.transfer.training_jobs import Origin

HOURS = (3.0, 9.0, 15.0, 20.0)
"""Hours of the day of the battery's maps."""
HOT = 15.0
"""Hour of the day of the comfort map."""
COLUMNS, ROWS = 33, 25
PRICES = (0.02, 0.98)
"""Quantiles of the prices learned from between which a map is drawn: beyond them nothing was learned."""
BEYOND = 2.0
"""How far the comfort map goes beyond the edge of comfort, and three times that inside it [degC]."""


def draw_maps(origin: Origin, folder: Path) -> None:
    """Write the figures of the rewards of all runs."""
    write_maps(folder, tuple(_battery_map(origin, hour) for hour in HOURS), _comfort_map(origin))


def _battery_map(origin: Origin, hour: float) -> BatteryMap:
    home, days = origin.settled.planning_home, _days(origin)
    low, high = np.quantile(np.asarray(days.buying_price, float), PRICES)
    energies = np.linspace(float(home.battery.min_energy), float(home.battery.max_energy), ROWS)
    grid = Grid(np.linspace(low, high, COLUMNS), energies)
    moment = price_and_energy(days, hour, grid, home)
    return BatteryMap(hour, grid, answers(origin.rewards, home, moment, Varied.BATTERY))


def _comfort_map(origin: Origin) -> ComfortMap:
    home, days = origin.settled.planning_home, _days(origin)
    outdoor = np.asarray(days.outdoor_temperature, float)
    edge = float(home.comfort.low if home.hvac.heats else home.comfort.high)
    inside = -1.0 if not home.hvac.heats else 1.0
    low, high = sorted([edge - inside * BEYOND, edge + 3 * inside * BEYOND])
    grid = Grid(np.linspace(outdoor.min(), outdoor.max(), COLUMNS), np.linspace(low, high, ROWS))
    moment = outdoor_and_indoor(days, HOT, grid, home)
    tried = 3 * origin.settled.experiment.airl.exploration.first_deviation[Varied.HVAC]
    return ComfortMap(HOT, edge, tried, grid, answers(origin.rewards, home, moment, Varied.HVAC))


def _days(origin: Origin):
    case = origin.settled.changed.case
    return case.first_days(case.experiment.demonstration_days)
