"""What may go wrong in a home that was trained under better conditions."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from hemma.experiment.scenes import (
    Scene,
    another_household,
    disturbed,
    late,
    noisy,
    rebuilt,
    spiked,
    without_battery_level,
    without_price,
    without_thermometer,
    worn,
)
from hemma.home.checks import require


@dataclass(frozen=True)
class FaultSettings:
    """How much goes wrong."""

    disturbance: float = 0.3
    """Standard deviation of the thermal disturbance [degC]."""
    temperature_noise: float = 0.3
    """Standard deviation of the thermometer's error [degC]."""
    energy_noise: float = 0.03
    """Standard deviation of the error of the battery's level, as a share of its usable capacity."""
    demand_noise: float = 0.1
    """Standard deviation of the error of load and PV, as a share of them."""
    building: float = 0.3
    """Share by which the building's constants differ from those that were identified."""
    efficiency: float = 0.85
    """eta_c and eta_d of a worn battery."""
    spikes: float = 0.02
    """Share of the hours that have a price spike."""
    spike_factor: float = 10.0
    """What prices are multiplied by in such an hour."""
    household: float = 1.5
    """What the load of another household is multiplied by; its PV is divided by the same."""
    runs: int = 3
    """How many runs of a learned method are measured, the first ones."""
    margin: float = 1.0
    """How far beyond the band the safety layer lets the temperature go [degC]."""
    adapts: bool = True
    """Whether all methods correct the identified building by what they measure while they run."""

    def __post_init__(self):
        """Refuse magnitudes without meaning."""
        for name in ("disturbance", "temperature_noise", "energy_noise", "demand_noise", "margin"):
            require("faults", getattr(self, name) >= 0, f"{name} >= 0", getattr(self, name))
        require("faults", self.runs >= 1, "runs >= 1", self.runs)
        require("faults", 0 <= self.building < 1, "0 <= building < 1", self.building)
        require("faults", 0 < self.efficiency <= 1, "0 < efficiency <= 1", self.efficiency)
        require("faults", 0 <= self.spikes <= 1, "0 <= spikes <= 1", self.spikes)
        for name in ("spike_factor", "household"):
            require("faults", getattr(self, name) > 0, f"{name} > 0", getattr(self, name))


@dataclass(frozen=True)
class Fault:
    """One thing that goes wrong."""

    name: str
    meaning: str
    happen: Callable[[Scene, np.random.Generator], Scene]


def faults(s: FaultSettings) -> tuple[Fault, ...]:
    """All of them; first nothing at all."""
    more, less, share = 1 + s.building, 1 - s.building, f"{100 * s.building:g} %"
    errors = (s.temperature_noise, s.energy_noise, s.demand_noise)
    said = (
        f"thermometer ± {s.temperature_noise:g} °C, battery level ± {100 * s.energy_noise:g} %, "
        f"load and PV ± {100 * s.demand_noise:g} %"
    )
    spikes = f"{100 * s.spikes:g} % of the hours cost and pay {s.spike_factor:g} times as much"
    kicks = f"its temperature is off by ± {s.disturbance:g} °C after each slot"
    household = f"{s.household:g} times the load, PV divided by that"
    missing = "no reading for an hour a day"
    return (
        Fault("nothing", "as in the main table", lambda scene, _: scene),
        Fault("disturbed building", kicks, partial(disturbed, s.disturbance)),
        Fault("noisy sensors", said, partial(noisy, errors)),
        Fault("late sensors", "load, PV and temperatures are those of the slot before", late),
        Fault("leaky building", f"{share} more conductance than identified", partial(rebuilt, (more, 1.0))),
        Fault("tight building", f"{share} less conductance than identified", partial(rebuilt, (less, 1.0))),
        Fault("light building", f"a time constant {share} shorter", partial(rebuilt, (1.0, less))),
        Fault("worn battery", f"efficiencies of {s.efficiency:g} each way", partial(worn, s.efficiency)),
        Fault("no thermometer", missing, without_thermometer),
        Fault("no battery level", missing, without_battery_level),
        Fault("no price", missing, without_price),
        Fault("price spikes", spikes, partial(spiked, (s.spikes, s.spike_factor))),
        Fault("another household", household, partial(another_household, s.household)),
    )
