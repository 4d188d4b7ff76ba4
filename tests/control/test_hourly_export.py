"""Import at one price, export at another one every hour: what planners and thresholds make of it."""

import numpy as np
import pytest

from hemma.control.comfort import ComfortHold
from hemma.control.rolling import RollingPlanner
from hemma.control.thresholds import fit_thresholds
from hemma.forecasting.combined import MeanForecast, RefittedForecast
from hemma.forecasting.outlook import Outlook, hourly_means, yesterday
from hemma.forecasting.ridge import fitted
from hemma.forecasting.shape import ShapeForecast
from hemma.home import Home, replay_in_double
from hemma.optimisation.battery import schedule_battery
from hemma.optimisation.optimum import optimum_problem
from small_worlds import cut, hourly_export

HOME = Home()
PAST, PERIOD = cut(hourly_export(14), 10 * 24)
OPTIMUM = 5.345
BOTH = RefittedForecast(MeanForecast((ShapeForecast(), fitted)))


def cost(path) -> float:
    """Sum of X1 + X2 [currency]."""
    return float(np.sum(path.steps.costs.transaction) + np.sum(path.steps.costs.ageing))


def run(controller):
    return replay_in_double(HOME, PERIOD, controller)


def test_perfect_information():
    assert optimum_problem(HOME, PERIOD).solve().cost == pytest.approx(OPTIMUM, abs=1e-3)


@pytest.mark.parametrize(
    ("forecaster", "expected"),
    [
        (yesterday, 5.405),
        (hourly_means, 5.366),
        (fitted, 5.351),
        (ShapeForecast(history=24.0), 5.352),
        (BOTH, 5.352),
    ],
    ids=["yesterday", "hourly means", "five places", "shape", "mean of both"],
)
def test_a_planner_with_any_forecast_comes_near_it(forecaster, expected):
    path = run(RollingPlanner(HOME, forecaster(Outlook(PAST, PERIOD, 1.0, 36.0))))
    assert cost(path) == pytest.approx(expected, abs=2e-3)


def test_two_thresholds_are_the_best_that_a_battery_alone_can_do_here():
    """They store the surplus of noon alone, and keep it for the demand."""
    rule = (fitted := fit_thresholds(HOME, PAST)).rule
    assert rule.selling is None
    assert 0.02 < rule.charge_below < 0.08
    assert 0.28 < rule.discharge_above < 0.30
    held = run(ComfortHold(HOME))
    best = schedule_battery(HOME, PERIOD, np.asarray(held.steps.action.hvac_power), HOME.reset())
    assert cost(run(fitted)) == pytest.approx(best.bound, rel=1e-4)
    assert best.bound == pytest.approx(6.318, abs=1e-3)
