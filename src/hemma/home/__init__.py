"""The home: battery, thermal model, costs and the loop that runs them."""

from hemma.home.battery import Battery
from hemma.home.home import (
    ComfortBand,
    Home,
    HomeState,
    Hvac,
    Step,
    benchmark_home,
    observe,
    paper_state,
    transaction_cost,
)
from hemma.home.replay import Controller, Schedule, Trajectory, replay
from hemma.home.thermal import AbstractThermalModel, ExplicitThermalModel, ThermalDrivers, ThermalState

__all__ = [
    "AbstractThermalModel",
    "Battery",
    "ComfortBand",
    "Controller",
    "ExplicitThermalModel",
    "Home",
    "HomeState",
    "Hvac",
    "Schedule",
    "Step",
    "ThermalDrivers",
    "ThermalState",
    "Trajectory",
    "benchmark_home",
    "observe",
    "paper_state",
    "replay",
    "transaction_cost",
]
