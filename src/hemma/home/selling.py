"""What selling pays when buying costs this or that, where the one follows from the other."""

import equinox as eqx
import numpy as np

from hemma.home.precision import in_numpy
from hemma.types import Array, Exogenous, Scalar

ROUNDING = 0.02
"""How far from its line a selling price may lie, as a share of the mean buying price: prices are rounded, and
a battery loses more than that between two hours."""


class SellingLine(eqx.Module):
    """u- = slope u+ + constant: a share of the buying price, a fixed price, or a fixed difference."""

    slope: Scalar
    constant: Scalar
    """[currency/kWh]."""

    def __call__(self, buying_price: Array) -> Array:
        """u- [currency/kWh] beside a ``buying_price`` [currency/kWh]."""
        return self.slope * buying_price + self.constant


def fit_selling(exogenous: Exogenous) -> SellingLine | None:
    """The line of least squares; None where the selling price is no line but has a shape of its own.

    Exact where the tariff is a line; flat where the buying price never moves.
    """
    prices = in_numpy(exogenous)
    u, v = prices.buying_price, prices.selling_price
    difference = u - np.mean(u)
    square = float(np.sum(difference**2))
    moves = np.ptp(u) > 1e-9 * np.max(np.abs(u))
    slope = float(np.sum(difference * v)) / square if moves else 0.0
    line = SellingLine(slope=slope, constant=float(np.mean(v)) - slope * float(np.mean(u)))
    allowed = ROUNDING * np.mean(np.abs(u)) + 1e-9 * np.max(np.abs(v))
    return line if np.max(np.abs(v - line(u))) <= allowed else None
