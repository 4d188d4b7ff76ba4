"""How much goes wrong under `hemma robustness`."""

from dataclasses import dataclass

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
