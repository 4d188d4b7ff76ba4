"""The home: battery, thermal model, costs and the loop that runs them."""

from hemma.home.battery import Battery
from hemma.home.controller import AbstractController, Memory, Schedule, WrapperMemory
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
from hemma.home.replay import Trajectory, replay, replay_in_double
from hemma.home.thermal import AbstractThermalModel, ExplicitThermalModel, ThermalDrivers, ThermalState

__all__ = [
    "AbstractController",
    "AbstractThermalModel",
    "Battery",
    "ComfortBand",
    "ExplicitThermalModel",
    "Home",
    "HomeState",
    "Hvac",
    "Memory",
    "Schedule",
    "Step",
    "ThermalDrivers",
    "ThermalState",
    "Trajectory",
    "WrapperMemory",
    "benchmark_home",
    "observe",
    "paper_state",
    "replay",
    "replay_in_double",
    "transaction_cost",
]
