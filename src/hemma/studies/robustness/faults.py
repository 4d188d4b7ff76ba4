"""What may go wrong in a home that was trained under better conditions."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from hemma.settings.faults import FaultSettings
from hemma.studies.robustness.scenes import (
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
