"""What selling pays when buying costs this or that, as seen in the training period."""

import equinox as eqx
import numpy as np

from hemma.home.precision import in_numpy
from hemma.types import Array, Exogenous, Scalar


class SellingLine(eqx.Module):
    """u- = slope u+ + constant: a share of the buying price, a fixed price, or a fixed difference."""

    slope: Scalar
    constant: Scalar
    """[currency/kWh]."""

    def __call__(self, buying_price: Array) -> Array:
        """u- [currency/kWh] beside a ``buying_price`` [currency/kWh]."""
        return self.slope * buying_price + self.constant


def fit_selling(exogenous: Exogenous) -> SellingLine:
    """The line of least squares, exact where the tariff is one; flat where the buying price never moves."""
    prices = in_numpy(exogenous)
    u, v = prices.buying_price, prices.selling_price
    difference = u - np.mean(u)
    square = float(np.sum(difference**2))
    moves = np.ptp(u) > 1e-9 * np.max(np.abs(u))
    slope = float(np.sum(difference * v)) / square if moves else 0.0
    return SellingLine(slope=slope, constant=float(np.mean(v)) - slope * float(np.mean(u)))
