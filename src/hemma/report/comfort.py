"""What may be said of comfort: methods are compared at equal comfort only where comfort is within reach."""

from hemma.report.numbers import degrees
from hemma.results.results import HomeResults

REACHABLE = 0.5
"""Least mean deviation [degC] of any controller above which nobody can speak of comfort."""


def is_comfort_reachable(home: HomeResults) -> bool:
    """Whether some controller keeps this home comfortable; so too where the folder has no optimum."""
    least = home.optimum.mean_temperature_deviation if home.optimum else None
    return least is None or least <= REACHABLE


def at_equal_comfort(*homes: HomeResults) -> str:
    """How to call the condition under which costs are compared on these homes."""
    is_reachable = all(is_comfort_reachable(home) for home in homes)
    return "at equal comfort" if is_reachable else "at the same deviation from comfort"


def comfort_warning(home: HomeResults) -> str:
    """A sentence on a home that nobody can keep comfortable; empty of any other."""
    if is_comfort_reachable(home) or home.optimum is None:
        return ""
    least = degrees(home.optimum.mean_temperature_deviation)
    return (
        "Comfort is out of reach in this home: even with perfect information the rooms are outside the band "
        f"by {least} on average. Costs are compared at the same deviation, not in comfort. Check the comfort "
        "band, the HVAC's power, and whether it only cools or only heats."
    )
