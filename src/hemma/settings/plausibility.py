"""Settings that no home, tariff or machine has: mostly a unit that was taken for another.

The limits lie far beyond what exists (a battery of 500 kWh, a heat pump of 200 kW). They catch watts,
Fahrenheit, kelvin, cents and per cent, and counts that would never end. They hold for settings that come from
outside, files and options; in Python any value goes that the classes themselves accept.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

from hemma.data import Tariff
from hemma.errors import shortened
from hemma.forecasting.shape import ShapeForecast
from hemma.home import Battery, ComfortBand, ExplicitThermalModel, Hvac
from hemma.identification.excitation import Excitation
from hemma.identification.settings import IdentificationSettings
from hemma.irl.cloning import CloningSettings
from hemma.irl.maxent import MaxEntSettings
from hemma.optimisation.exact.programme import SolverSettings
from hemma.optimisation.hierarchy import HierarchySettings
from hemma.optimisation.horizon import Horizon
from hemma.optimisation.hvac import DescentSettings
from hemma.settings.experiment import (
    ComfortPrices,
    DataEfficiency,
    DefaultController,
    Experiment,
    ParetoSettings,
)
from hemma.settings.faults import FaultSettings

LONGEST_WORD = 40
"""Characters of a setting that is a word."""
LONGEST_LIST = 100
"""Entries of a setting that is a list."""


@dataclass(frozen=True)
class Limits:
    """What a setting may be."""

    low: int | float
    high: int | float
    what: str = "a number"
    """With its unit, for the message."""
    likely: Callable[[int | float], str] = field(default=lambda value: "")
    """What a value outside is probably meant in, and how to convert it."""

    def check(self, value: int | float) -> None:
        """Raise ``ValueError`` with the whole message for a value outside, NaN among them."""
        if self.low <= value <= self.high:
            return
        likely = self.likely(value) if value <= 1000 * self.high else ""
        raise ValueError(
            f"expected {self.what} from {self.low:g} to {self.high:g}, got {shortened(value)}"
            + (f"; this looks like {likely}" if likely else ". Correct it")
        )


def limits_of(target: type, name: str) -> Limits:
    """Of a parameter of a class; what has none of its own is at least not negative."""
    return LIMITS.get(target, {}).get(name) or BY_NAME.get(name) or ANY


def _degrees(value: int | float) -> str:
    if 200 < value < 400:
        return "kelvin: subtract 273.15"
    return "Fahrenheit: take (F - 32) / 1.8" if 35 < value <= 200 else ""


def _above(unit: str) -> Callable[[int | float], str]:
    return lambda value: unit if value > 0 else ""


def _percent(value: int | float) -> str:
    return "per cent: divide by 100" if 1 < value <= 100 else ""


def _performance(value: int | float) -> str:
    if value > 50:
        return "per cent: divide by 100"
    return "an EER or SEER in BTU/Wh: divide by 3.412" if value > 1 else ""


ANY = Limits(0, 1e9)
POWER = Limits(0, 200, "a power in kW", _above("W: divide by 1000"))
ENERGY = Limits(0, 500, "an energy in kWh", _above("Wh: divide by 1000"))
PRICE = Limits(
    0,
    3,
    "a price per kWh",
    _above("cents: divide by 100, or by 1000 what is per MWh. If it is right, count in a larger unit"),
)
COMFORT = Limits(5, 35, "a temperature in degC", _degrees)
DIFFERENCE = Limits(0, 10, "a difference in degC")
EFFICIENCY = Limits(0.3, 1, "an efficiency as a fraction", _percent)
SHARE = Limits(0, 1, "a fraction", _percent)
HOURS = Limits(0.25, 744, "a time in h", _above("minutes: divide by 60"))
DAYS = Limits(1, 3660, "days")
RUNS = Limits(1, 1000, "a number of runs")
FACTOR = Limits(0.01, 1000, "a factor")
WEIGHT = Limits(0, 10_000, "a weight")
RATE = Limits(0, 1, "a step of learning")
SIGMA = Limits(0, 10, "a standard deviation of fractions")
UNITS = Limits(1, 4096, "units of a layer")

LIMITS: dict[type, dict[str, Limits]] = {
    Battery: {
        "max_energy": ENERGY,
        "min_energy": ENERGY,
        "initial_energy": ENERGY,
        "max_charging_power": POWER,
        "max_discharging_power": POWER,
        "charging_efficiency": EFFICIENCY,
        "discharging_efficiency": EFFICIENCY,
        "ageing_cost": PRICE,
    },
    ExplicitThermalModel: {
        "inertia": SHARE,
        "efficiency": Limits(0.5, 10, "a coefficient of performance", _performance),
        "conductance": Limits(0.005, 20, "a conductance in kW/degC", _above("W/degC: divide by 1000")),
    },
    Hvac: {"max_power": POWER},
    ComfortBand: {"low": COMFORT, "high": COMFORT},
    Tariff: {"adder_per_kwh": PRICE, "selling_ratio": SHARE},
    Excitation: {
        "mean_hold": Limits(0.01, 168, "a time in h", _above("minutes: divide by 60")),
        "extreme_share": SHARE,
        "margin": DIFFERENCE,
    },
    IdentificationSettings: {"window": HOURS},
    Horizon: {"planned": HOURS, "carried_out": HOURS},
    DescentSettings: {"tolerance": Limits(0, 0.1, "a power in kW", _above("W: divide by 1000"))},
    SolverSettings: {
        "relative_gap": Limits(0, 0.1, "a fraction", _percent),
        "max_nodes": Limits(1, 10**6, "a number of nodes"),
        "rounds": Limits(1, 100, "a number of rounds"),
        "most_branched": Limits(0, 10**6, "a number of slots"),
    },
    HierarchySettings: {"seed": Limits(0, 2**31 - 1, "a seed")},
    MaxEntSettings: {"windows": Limits(1, 10_000, "windows")},
    CloningSettings: {"held_out": DAYS},
    ComfortPrices: {"multiples": WEIGHT, "seeds": RUNS, "held_out": SHARE, "tolerance": DIFFERENCE},
    ParetoSettings: {"relaxations": Limits(-10, 10, "a difference in degC"), "seeds": RUNS},
    ShapeForecast: {
        "history": HOURS,
        "closeness": Limits(0.01, 24, "a time in h", _above("minutes: divide by 60")),
        "ridge": WEIGHT,
    },
    DefaultController: {
        "refitted": DAYS,
        "margin": SHARE,
        "judged": SHARE,
        "folds": Limits(1, 100, "a number of parts"),
        "published_at": Limits(0, 24, "an hour of the day"),
    },
    FaultSettings: {
        "disturbance": DIFFERENCE,
        "temperature_noise": DIFFERENCE,
        "energy_noise": SHARE,
        "demand_noise": SHARE,
        "building": SHARE,
        "efficiency": EFFICIENCY,
        "spikes": SHARE,
        "spike_factor": FACTOR,
        "household": FACTOR,
        "runs": RUNS,
        "margin": DIFFERENCE,
    },
    DataEfficiency: {"days": DAYS, "seeds": RUNS},
    Experiment: {
        "initial_temperature": Limits(-20, 45, "a temperature in degC", _degrees),
        "disturbance_deviation": DIFFERENCE,
        "pv_scale": Limits(0, 50, "a factor", _above("per cent: divide by 100")),
        "forecast_horizon": HOURS,
        "seeds": RUNS,
        "demonstration_days": DAYS,
        "long_demonstration_days": DAYS,
    },
}
"""Of what is a quantity of the world, or named like one of another class."""

BY_NAME: dict[str, Limits] = {
    **dict.fromkeys(("hidden", "width"), UNITS),
    "depth": Limits(1, 16, "a number of layers"),
    **dict.fromkeys(("iterations", "updates"), Limits(1, 1_000_000, "a number of iterations")),
    "max_iterations": Limits(1, 100_000, "a number of iterations"),
    **dict.fromkeys(("chunk", "patience", "replayed"), Limits(1, 100_000, "a count")),
    **dict.fromkeys(("steps", "epochs", "minibatches"), Limits(1, 10_000, "a count")),
    **dict.fromkeys(("rollouts", "agent_rollouts"), Limits(1, 10_000, "a number of rollouts")),
    "slots": Limits(1, 10_000, "a number of slots"),
    "batch": Limits(1, 100_000, "a number of samples"),
    "capacity": Limits(1, 10_000_000, "a number of transitions"),
    "members": Limits(1, 100, "a number of agents"),
    **dict.fromkeys(("learning_rate", "value_learning_rate", "actor_rate", "critic_rate", "rate"), RATE),
    **dict.fromkeys(("validation_share", "least_improvement", "relaxing", "shrinking", "averaging"), SHARE),
    **dict.fromkeys(("discount", "trace", "following"), SHARE),
    **dict.fromkeys(("gain_penalty", "penalty", "entropy", "shrinkage", "weight_decay"), WEIGHT),
    **dict.fromkeys(("first_deviation", "last_deviation"), SIGMA),
    **dict.fromkeys(("clip", "least_scale"), Limits(0, 100)),
    "log_density_bound": Limits(0, 1000),
    "max_gradient_norm": Limits(0, 1e6),
}
"""Of the sizes and rates of learning, in whatever class."""
