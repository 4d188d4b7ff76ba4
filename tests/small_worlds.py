"""Small periods for the optimisation baselines, periodic or random."""

from dataclasses import replace

import jax
import numpy as np

from hemma.types import Exogenous


def periodic(days: int, slot_length: float = 1.0, price: float | None = None) -> Exogenous:
    """Every day like every other; ``price`` makes the buying price constant."""
    hour = np.arange(round(days * 24 / slot_length)) * slot_length % 24
    u = 0.1 + 0.05 * np.sin((hour - 12) * np.pi / 12) if price is None else np.full(hour.shape, price)
    return Exogenous(
        pv_generation=np.clip(2 * np.sin((hour - 6) * np.pi / 12), 0, None),
        load=0.5 + 0.3 * np.cos((hour - 19) * np.pi / 12),
        outdoor_temperature=29 + 6 * np.sin((hour - 9) * np.pi / 12),
        buying_price=u,
        selling_price=0.9 * u,
        hour_of_day=hour,
    )


def noisy(
    days: int, seed: int, slot_length: float = 1.0, mean: float = 31.0, negative_share: float = 0.0
) -> Exogenous:
    """Random sun, load and price spikes around the periodic days; the outdoor temperature around ``mean``."""
    random, base = np.random.default_rng(seed), periodic(days, slot_length)
    n = base.slots
    price = base.buying_price + random.gamma(0.3, 0.1, n)
    price = np.where(random.uniform(size=n) < negative_share, -price, price)
    return Exogenous(
        pv_generation=base.pv_generation * random.uniform(0.2, 1, n),
        load=base.load + random.gamma(0.5, 0.4, n),
        outdoor_temperature=base.outdoor_temperature - 29 + mean + random.normal(0, 1, n),
        buying_price=price,
        selling_price=0.9 * price,
        hour_of_day=base.hour_of_day,
    )


def cut(exogenous: Exogenous, at: int) -> tuple[Exogenous, Exogenous]:
    """Past and period."""
    return exogenous.window(0, at), exogenous.window(at, exogenous.slots)


def changed_after(exogenous: Exogenous, slot: int) -> Exogenous:
    """The same up to and including ``slot``, another future but the same clock."""

    def other(x: np.ndarray) -> np.ndarray:
        return np.where(np.arange(len(x)) > slot, 3.0 * x + 0.7, x)

    return replace(jax.tree.map(other, exogenous), hour_of_day=exogenous.hour_of_day)


def hourly_export(days: int) -> Exogenous:
    """Import at one price, export dear in the evening and nearly worthless at noon; the same every day."""
    random, n = np.random.default_rng(1), 24 * days
    hour, day = np.arange(n) % 24, np.arange(n) // 24
    sun = 4 * np.clip(np.sin((hour - 6) / 12 * np.pi), 0, None) * (0.7 + 0.3 * random.random(days + 1))[day]
    load = 0.3 + 0.8 * np.exp(-(((hour - 19) / 2.5) ** 2)) + 0.15 * random.random(n)
    outdoor = 29 + 6 * np.sin((hour - 9) / 12 * np.pi) + random.normal(0, 0.4, n)
    evening, noon = (hour >= 16) & (hour < 20), (hour >= 10) & (hour < 15)
    return Exogenous(
        pv_generation=sun.round(4),
        load=load.round(4),
        outdoor_temperature=outdoor.round(3),
        buying_price=np.full(n, 0.30),
        selling_price=np.where(evening, 0.28, np.where(noon, 0.02, 0.08)),
        hour_of_day=hour.astype(float),
    )
