"""A forecast fitted to the training period: ridge regression on yesterday and on what today differs by."""

import numpy as np
from jaxtyping import Float, Int

from hemma.forecasting.bent import assembled
from hemma.forecasting.outlook import Outlook, last_known, targets
from hemma.types import Exogenous

RIDGE = 0.01
"""Penalty on the squared weight of a feature of unit mean square, beside the mean square error."""


def fitted(outlook: Outlook) -> Exogenous:
    """Ridge regressions fitted to ``outlook.past`` alone, one for each quantity and step ahead.

    With y bent to asinh((y - median) / width), so that price spikes do not rule the fit, and z its distance
    from the mean at its time of day, z_{t+k} is a weighted sum of z at five known places: yesterday at the
    same time, an hour earlier and an hour later, now, and now a day ago. Large penalties would leave the
    mean at the time of day, a weight of 1 on the first place yesterday's profile.

    No forecast leaves the range seen so far; PV stays below what its time of day has seen, so nights are
    dark; the selling price lies on the training period's line over the buying price. A past too short to
    learn from raises ``HemmaError``.
    """
    outlook.require_past(needed_past(outlook), f"fit a forecast of {outlook.ahead}")
    return assembled(outlook, lambda series: _regression(outlook, series.z))


def needed_past(outlook: Outlook) -> int:
    """The shortest past [slots] that a forecast can be fitted to: history, and a day of examples."""
    return _history(outlook) + outlook.day + outlook.ahead


def _history(outlook: Outlook) -> int:
    """Slots that the features look back: a day and an hour."""
    return outlook.day + outlook.hour


def _regression(outlook: Outlook, z: Float[np.ndarray, "joined"]) -> Float[np.ndarray, "slots horizon"]:
    asked, day, hour = outlook.targets(), outlook.day, outlook.hour
    learned = targets(_history(outlook), outlook.past.slots - outlook.ahead + 1, outlook.ahead)
    weights = _ridge(_features(z, learned, day, hour), z[learned])
    return np.einsum("tkf,kf->tk", _features(z, asked, day, hour), weights)


def _features(
    z: Float[np.ndarray, "joined"], targets: Int[np.ndarray, "rows horizon"], day: int, hour: int
) -> Float[np.ndarray, "rows horizon features"]:
    """What slot t (column 0) knows about each of its targets."""
    now = np.broadcast_to(targets[:, :1], targets.shape)
    same = last_known(targets, day)
    places = (same, same - hour, np.minimum(same + hour, now), now, now - day)
    return np.stack([z[place] for place in places], axis=-1)


def _ridge(
    x: Float[np.ndarray, "rows horizon features"], y: Float[np.ndarray, "rows horizon"]
) -> Float[np.ndarray, "horizon features"]:
    """w_k = argmin mean (y_k - w'x_k)^2 + RIDGE sum_j w_j^2 mean x_kj^2; 0 for a feature that is always 0."""
    rows, features = len(x), x.shape[-1]
    moments = np.einsum("tki,tkj->kij", x, x) / rows
    size = np.sqrt(np.einsum("kii->ki", moments))
    size = np.where(size > 0, size, 1.0)
    scaled = moments / (size[:, :, None] * size[:, None, :]) + RIDGE * np.eye(features)
    return np.linalg.solve(scaled, (np.einsum("tki,tk->ki", x, y) / rows / size)[..., None])[..., 0] / size
