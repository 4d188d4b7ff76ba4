"""What a controller that knows the past alone believes of the hours to come, for every slot of a period."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import jax
import numpy as np
from jaxtyping import Float, Int

from hemma.errors import HemmaError
from hemma.home.precision import in_numpy
from hemma.types import Exogenous

DAY = 24.0
"""Hours after which demand, sun and prices are alike."""


@dataclass(frozen=True)
class Outlook:
    """A period that is lived through slot by slot, and the past that comes before it."""

    past: Exogenous
    """The training period: it ends where ``period`` begins, and holds a day at least."""
    period: Exogenous
    """What will happen. A forecast made in slot t may look at the slots up to t."""
    slot_length: float
    """dt [h]; a day must be a whole number of slots."""
    horizon: float = 36.0
    """How far ahead one looks, the present slot included [h]; rounded to whole slots, at least one."""

    def __post_init__(self):
        """Refuse days that are no whole number of slots, no horizon, and a past of less than a day."""
        slots = DAY / self.slot_length
        if abs(slots - round(slots)) > 1e-6:
            raise HemmaError(
                f"forecast: expected slots that divide a day, got {self.slot_length:g} h; resample the traces"
            )
        if not self.horizon > 0:
            raise HemmaError(
                f"forecast: expected horizon > 0 hours, got {self.horizon}; correct this setting"
            )
        if self.past.slots < self.day:
            raise HemmaError(
                f"forecast: expected a past of at least one day ({self.day} slots) before the period, "
                f"got {self.past.slots} slots; give longer training traces"
            )

    @property
    def day(self) -> int:
        """Slots a day."""
        return round(DAY / self.slot_length)

    @property
    def ahead(self) -> int:
        """Slots of the horizon H, the present one included."""
        return max(round(self.horizon / self.slot_length), 1)

    @property
    def hour(self) -> int:
        """Slots an hour, at least one."""
        return max(round(1.0 / self.slot_length), 1)

    def require_past(self, needed: int, purpose: str) -> None:
        """Refuse a past of less than ``needed`` slots; ``purpose`` says what they are needed for."""
        if self.past.slots < needed:
            raise HemmaError(
                f"forecast: expected a past of at least {needed} slots to {purpose}, got {self.past.slots}; "
                "give longer training traces or a shorter horizon"
            )

    def joined(self) -> Exogenous:
        """Past and period as one series, NumPy float64; slot t of the period is ``past.slots`` + t."""
        past, period = in_numpy((self.past, self.period))
        return jax.tree.map(lambda before, now: np.concatenate([before, now]), past, period)

    def targets(self) -> Int[np.ndarray, "slots horizon"]:
        """Place t + k in ``joined`` of the slot that row t, column k is about; it may lie beyond the end."""
        return targets(self.past.slots, self.past.slots + self.period.slots, self.ahead)

    def clock(self) -> Float[np.ndarray, "places"]:
        """Hour of day of every place of ``joined`` and of a horizon beyond: nobody needs to forecast that."""
        clock = np.concatenate([np.asarray(part.hour_of_day, float) for part in (self.past, self.period)])
        beyond = clock[-1] + self.slot_length * np.arange(1, self.ahead + 1)
        return np.concatenate([clock, beyond % DAY])

    def times(self) -> Int[np.ndarray, "places"]:
        """Slot of the day, 0 to ``day`` - 1, of every place of ``clock``."""
        return np.floor(self.clock() / self.slot_length + 1e-6).astype(int) % self.day

    def with_present(self, ahead: Exogenous) -> Exogenous:
        """``ahead`` (slots, horizon) with what is known for certain: the present slot, and the clock."""

        def present(forecast: np.ndarray, truth: np.ndarray) -> np.ndarray:
            return np.concatenate([np.asarray(truth, float)[:, None], forecast[:, 1:]], axis=1)

        known = jax.tree.map(present, ahead, self.period)
        return replace(known, hour_of_day=self.clock()[self.targets()])


Forecaster = Callable[[Outlook], Exogenous]
"""``forecaster(outlook)``: arrays (slots, horizon); row t is believed in slot t, column k about slot t + k.

Column 0 is the present slot and exact. What is said of slots beyond the end of the period is never used.
"""


def perfect(outlook: Outlook) -> Exogenous:
    """What will happen; beyond the end of the period the last slot goes on."""
    joined, places = outlook.joined(), outlook.targets()
    return outlook.with_present(jax.tree.map(lambda x: x[np.minimum(places, len(x) - 1)], joined))


def yesterday(outlook: Outlook) -> Exogenous:
    """The last known value at the same time of day: y_{t+k-m} with the fewest whole days m >= k."""
    joined = outlook.joined()
    places = last_known(outlook.targets(), outlook.day)
    return outlook.with_present(jax.tree.map(lambda x: x[places], joined))


def hourly_means(outlook: Outlook) -> Exogenous:
    """The mean over the training period at the same time of day."""
    times = outlook.times()
    past, asked = times[: outlook.past.slots], times[outlook.targets()]
    means = jax.tree.map(lambda x: profile(x, past, outlook.day)[asked], in_numpy(outlook.past))
    return outlook.with_present(means)


def targets(first: int, stop: int, ahead: int) -> Int[np.ndarray, "slots horizon"]:
    """t + k for the slots t from ``first`` to ``stop`` (excluded) and k = 0 to ``ahead`` - 1."""
    return np.arange(first, stop)[:, None] + np.arange(ahead)


def last_known(targets: Int[np.ndarray, "slots horizon"], day: int) -> Int[np.ndarray, "slots horizon"]:
    """The latest place at the time of day of each target that column 0, the present slot, knows."""
    days = -(-np.arange(targets.shape[1]) // day)
    return targets - day * days


def profile(
    values: Float[np.ndarray, "slots"], times: Int[np.ndarray, "slots"], day: int
) -> Float[np.ndarray, "day"]:
    """Mean of ``values`` at each of the ``times`` of day; a time that never came gets the mean of all."""
    count = np.bincount(times, minlength=day)
    total = np.bincount(times, weights=values, minlength=day)
    return np.where(count > 0, total / np.maximum(count, 1), np.mean(values))
