"""How near to comfort a home can be held at all, and why no nearer, said before any work is done on it."""

import numpy as np

from hemma.optimisation.optimum import optimum_problem
from hemma.stages.case import Case
from hemma.types import Exogenous

OUT_OF_REACH = 0.5
"""Mean deviation [degC] from which on comfort is out of reach: no method is at fault for it."""


def unreachable(case: Case) -> list[str]:
    """What to tell of periods in which even perfect information deviates by more than ``OUT_OF_REACH``."""
    periods = (("training", case.training), ("test", case.test))
    return [said for name, period in periods if (said := _unreachable(case, name, period)) is not None]


def _unreachable(case: Case, name: str, period: Exogenous) -> str | None:
    mean = optimum_problem(case.home, period).least_deviation / period.slots
    if mean <= OUT_OF_REACH:
        return None
    low, high = float(case.home.comfort.low), float(case.home.comfort.high)
    return (
        f"{case.name}: comfort is out of reach in the {name} period: from {low:g} to {high:g} °C no "
        f"controller comes nearer than {mean:.2g} °C on average. {_cause(case, period)}"
    )


def _cause(case: Case, period: Exogenous) -> str:
    """The likeliest cause and its cure."""
    hvac, comfort = case.home.hvac, case.home.comfort
    outdoor = float(np.mean(np.asarray(period.outdoor_temperature, float)))
    if not hvac.heats and outdoor < float(comfort.low):
        return f"The HVAC only cools and it is {outdoor:.1f} °C outside on average: set hvac.heats to yes"
    if hvac.heats and outdoor > float(comfort.high):
        return f"The HVAC only heats and it is {outdoor:.1f} °C outside on average: set hvac.heats to no"
    return (
        f"The HVAC may be too weak ({float(hvac.max_power):g} kW), the building not yours, or a "
        "temperature in another unit: see hvac, building and comfort in the settings, outdoor_c in the traces"
    )
