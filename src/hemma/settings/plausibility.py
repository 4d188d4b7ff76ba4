"""Settings that no home, tariff or machine has: mostly a unit that was taken for another.

The limits are far beyond what exists (a battery of 500 kWh, a heat pump of 200 kW); they are there to catch
watts, Fahrenheit, kelvin and per cent, and counts that would never end.
"""

from collections.abc import Callable
from dataclasses import dataclass

from hemma.data import Tariff
from hemma.forecasting.shape import ShapeForecast
from hemma.home import Battery, ComfortBand, ExplicitThermalModel, Hvac
from hemma.identification.excitation import Excitation
from hemma.identification.settings import IdentificationSettings
from hemma.irl.airl import AIRLSettings
from hemma.optimisation.horizon import Horizon
from hemma.settings.experiment import ComfortPrices, DataEfficiency, Experiment, ParetoSettings
from hemma.settings.faults import FaultSettings

MOST = 1e6
"""Of any count that has no limit of its own."""
LARGEST = 1e9
"""Of any number that has no limit of its own, as a magnitude."""
WIDEST = 4096.0
"""Of a hidden layer [units]."""


@dataclass(frozen=True)
class Limits:
    """What a setting may be."""

    low: float
    high: float
    what: str
    """With its unit, for the message."""
    hint: Callable[[float | int], str] = lambda value: ""
    """What a value outside is probably meant to be."""

    def complaint(self, value: float | int) -> str | None:
        """What is wrong with a value; None if nothing is."""
        if self.low <= value <= self.high:
            return None
        hint = self.hint(value)
        return f"{self.what} from {self.low:g} to {self.high:g}" + (
            f"; this looks like {hint}" if hint else ""
        )


def _temperature(value: float | int) -> str:
    if value > 200:
        return "kelvin, subtract 273.15"
    return "Fahrenheit, take (F − 32) · 5/9" if value > 35 else ""


def _thousandfold(unit: str) -> Callable[[float | int], str]:
    return lambda value: f"{unit}, divide by 1000" if value > 0 else ""


def _percent(value: float | int) -> str:
    return "per cent, divide by 100" if 1 < value <= 100 else ""


POWER = Limits(0.0, 200.0, "a power in kW", _thousandfold("W"))
ENERGY = Limits(0.0, 500.0, "an energy in kWh", _thousandfold("Wh"))
COMFORT = Limits(5.0, 35.0, "a temperature in °C", _temperature)
SHARE = Limits(0.0, 1.0, "a fraction", _percent)
DEGREES = Limits(0.0, 20.0, "a difference in °C")
HOURS = Limits(0.0, 24.0 * 366, "hours")
DAYS = Limits(1.0, 3660.0, "days")
RUNS = Limits(1.0, 1000.0, "runs")

LIMITS: dict[tuple[type, str], Limits] = {
    (Battery, "max_energy"): ENERGY,
    (Battery, "min_energy"): ENERGY,
    (Battery, "initial_energy"): ENERGY,
    (Battery, "max_charging_power"): POWER,
    (Battery, "max_discharging_power"): POWER,
    (Battery, "charging_efficiency"): SHARE,
    (Battery, "discharging_efficiency"): SHARE,
    (Battery, "ageing_cost"): Limits(0.0, 1000.0, "a price per kWh"),
    (ExplicitThermalModel, "inertia"): SHARE,
    (ExplicitThermalModel, "efficiency"): Limits(0.0, 20.0, "a coefficient of performance", _percent),
    (ExplicitThermalModel, "conductance"): Limits(0.0, 50.0, "a conductance in kW/°C", _thousandfold("W/°C")),
    (Hvac, "max_power"): POWER,
    (ComfortBand, "low"): COMFORT,
    (ComfortBand, "high"): COMFORT,
    (Tariff, "adder_per_kwh"): Limits(0.0, 1000.0, "a price per kWh"),
    (Tariff, "selling_ratio"): SHARE,
    (Excitation, "mean_hold"): HOURS,
    (Excitation, "margin"): DEGREES,
    (IdentificationSettings, "window"): HOURS,
    (Horizon, "planned"): HOURS,
    (Horizon, "carried_out"): HOURS,
    (ShapeForecast, "history"): HOURS,
    (DataEfficiency, "days"): DAYS,
    (DataEfficiency, "seeds"): RUNS,
    (ComfortPrices, "seeds"): RUNS,
    (ComfortPrices, "held_out"): SHARE,
    (ComfortPrices, "tolerance"): DEGREES,
    (ParetoSettings, "relaxations"): Limits(-10.0, 10.0, "a difference in °C"),
    (ParetoSettings, "seeds"): RUNS,
    (AIRLSettings, "members"): Limits(1.0, 100.0, "agents"),
    (FaultSettings, "runs"): RUNS,
    (FaultSettings, "disturbance"): DEGREES,
    (FaultSettings, "temperature_noise"): DEGREES,
    (FaultSettings, "margin"): DEGREES,
    (FaultSettings, "energy_noise"): SHARE,
    (FaultSettings, "demand_noise"): SHARE,
    (Experiment, "initial_temperature"): Limits(-20.0, 45.0, "a temperature in °C", _temperature),
    (Experiment, "disturbance_deviation"): DEGREES,
    (Experiment, "pv_scale"): Limits(0.0, 1000.0, "a factor"),
    (Experiment, "forecast_horizon"): Limits(0.0, 24.0 * 31, "hours"),
    (Experiment, "seeds"): RUNS,
    (Experiment, "demonstration_days"): DAYS,
    (Experiment, "long_demonstration_days"): DAYS,
}


def complaint(target: type, name: str, value: object) -> str | None:
    """What is wrong with the value of a parameter, or with one of several; None if nothing is."""
    if isinstance(value, tuple):
        return next((said for item in value if (said := complaint(target, name, item))), None)
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    return _limits(target, name, value).complaint(value)


def _limits(target: type, name: str, value: float | int) -> Limits:
    if name == "hidden":
        return Limits(1.0, WIDEST, "units of a layer")
    general = (
        Limits(0.0, MOST, "a count") if isinstance(value, int) else Limits(-LARGEST, LARGEST, "a number")
    )
    return LIMITS.get((target, name), general)
