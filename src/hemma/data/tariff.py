"""From a wholesale price to what a home pays and gets."""

import math
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from hemma.errors import HemmaError


@dataclass(frozen=True)
class Tariff:
    """u+ = wholesale + adder, u- = ratio u+ (where u+ < 0 as well: then exporting costs, too)."""

    adder_per_kwh: float = 0.05
    """What the retailer and the grid add to the wholesale price [currency/kWh], at least 0."""
    selling_ratio: float = 0.9
    """Selling price as a fraction of the buying price, in [0, 1]; the papers use 0.9."""

    def __post_init__(self):
        """Refuse what no tariff can be."""
        require_at_least_zero("tariff: adder_per_kwh", self.adder_per_kwh)
        require_ratio("tariff: selling_ratio", self.selling_ratio)

    def buying_price(self, wholesale: Float[np.ndarray, "slots"]) -> Float[np.ndarray, "slots"]:
        """u+ [currency/kWh] for a wholesale price [currency/kWh]."""
        return wholesale + self.adder_per_kwh

    def selling_price(self, wholesale: Float[np.ndarray, "slots"]) -> Float[np.ndarray, "slots"]:
        """u- [currency/kWh] for a wholesale price [currency/kWh]."""
        return self.selling_ratio * self.buying_price(wholesale)


def require_at_least_zero(name: str, value: float) -> None:
    """Refuse a parameter that is negative, infinite or not a number."""
    if not (math.isfinite(value) and value >= 0):
        raise HemmaError(f"{name}: expected a number of at least 0, got {value}. Correct it")


def require_ratio(name: str, value: float) -> None:
    """Refuse a parameter outside [0, 1]."""
    if not 0 <= value <= 1:
        raise HemmaError(f"{name}: expected a fraction between 0 and 1, got {value} (90 % is 0.9)")
