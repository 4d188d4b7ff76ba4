"""A forecast that learns how a day goes on from how the last two went: one regression a time of day."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from hemma.forecasting.bent import assembled
from hemma.forecasting.outlook import DAY, Outlook, targets
from hemma.home.checks import require
from hemma.types import Exogenous


@dataclass(frozen=True)
class ShapeForecast:
    """Ridge regressions on the hours just past, each fitted to examples from about its time of day.

    With z as ``fitted`` has it (bent by asinh, counted from the mean at the time of day), and x_t the hourly
    means of z over the last ``history`` hours, slot t at the hour tau expects

        z_{t+k} = a_tau,k + w_tau,k' x_t.

    a and w minimise the mean over the training period's slots s of K(s) (z_{s+k} - a - w' x_s)^2, plus
    ``ridge`` times the mean square of each feature times its squared weight, K a Gaussian of the distance of
    the hour of s from tau, around the clock, with standard deviation ``closeness``. In the morning other
    hours tell how the day goes on than in the evening; examples from all hours would blur that.
    """

    history: float = 48.0
    """How far back one looks [h]."""
    closeness: float = 3.0
    """How near in time of day examples must be to count [h]."""
    ridge: float = 0.01
    """Penalty on the squared weight of a feature of unit mean square, beside the mean square error."""

    def __post_init__(self):
        """Refuse settings without meaning."""
        for name in ("history", "closeness", "ridge"):
            require("forecast", getattr(self, name) > 0, f"{name} > 0", getattr(self, name))

    def __call__(self, outlook: Outlook) -> Exogenous:
        """All quantities; raises ``HemmaError`` where the past is shorter than ``needed_past``."""
        outlook.require_past(self.needed_past(outlook), f"learn from the last {self.history:g} h")
        return assembled(outlook, lambda series: self._regression(outlook, series.z))

    def needed_past(self, outlook: Outlook) -> int:
        """The shortest past [slots] that it can be fitted to: its history, and two days of examples."""
        return self._first(outlook) + 2 * outlook.day + outlook.ahead

    def _first(self, outlook: Outlook) -> int:
        """The first slot that has all its features."""
        return round(self.history / outlook.slot_length)

    def _regression(
        self, outlook: Outlook, z: Float[np.ndarray, "joined"]
    ) -> Float[np.ndarray, "slots horizon"]:
        learned = targets(self._first(outlook), outlook.past.slots - outlook.ahead + 1, outlook.ahead)
        x, asked, clock = _hourly(z, outlook.slot_length, self.history), outlook.targets(), outlook.clock()
        middle = 0.5 * (1.0 - outlook.slot_length)  # of the slots that begin in an hour
        hours = np.floor(clock[asked[:, 0]])
        ahead = np.empty(asked.shape)
        for hour in np.unique(hours):
            rows, weights = hours == hour, _kernel(clock[learned[:, 0]] - hour - middle, self.closeness)
            ahead[rows] = _ridge(x[learned[:, 0]], z[learned], weights, x[asked[rows, 0]], self.ridge)
        return ahead


def _ridge(
    x: Float[np.ndarray, "rows features"],
    y: Float[np.ndarray, "rows targets"],
    weights: Float[np.ndarray, "rows"],
    asked: Float[np.ndarray, "slots features"],
    ridge: float,
) -> Float[np.ndarray, "slots targets"]:
    """The weighted ridge regression of ``y`` on ``x``, at the features ``asked``."""
    mean_x, mean_y = weights @ x, weights @ y
    square = np.mean(x**2, axis=0)
    penalty = ridge * np.where(square > 0, square, 1.0)
    centred = x - mean_x
    moments = (centred * weights[:, None]).T @ centred + np.diag(penalty)
    return mean_y + (asked - mean_x) @ np.linalg.solve(moments, (centred * weights[:, None]).T @ (y - mean_y))


def _kernel(distance: Float[np.ndarray, "rows"], closeness: float) -> Float[np.ndarray, "rows"]:
    """Weights of sum 1 that fall with the distance in time of day [h]."""
    around = np.abs((distance + DAY / 2) % DAY - DAY / 2)
    weights = np.exp(-0.5 * (around / closeness) ** 2)
    return weights / np.sum(weights)


def _hourly(
    z: Float[np.ndarray, "joined"], slot_length: float, history: float
) -> Float[np.ndarray, "joined hours"]:
    """Means of z over the hour that ends with each place, the hour before, and so on.

    Row t is right where ``history`` hours lie behind place t, itself included; slots longer than an hour
    count as one.
    """
    hour = max(round(1.0 / slot_length), 1)
    hours = max(round(history / (hour * slot_length)), 1)
    total = np.concatenate([[0.0], np.cumsum(z)])
    ends = np.maximum(np.arange(1, len(z) + 1)[:, None] - hour * np.arange(hours), hour)
    return (total[ends] - total[ends - hour]) / hour
