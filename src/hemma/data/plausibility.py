"""Does a column look like its unit? Wrong units are refused with the conversion, odd values are reported."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from hemma.data.gaps import duration
from hemma.data.traces import Traces

LARGEST_HOME = 200.0
"""No home generates or uses more than this [kW]."""
LARGEST_MEDIAN_POWER = 40.0
"""A column of power [kW] whose median over its positive slots is above this is in W."""
WARMEST = 60.0
"""No weather station has measured more than this [degC]."""
COLDEST = -90.0
WARMEST_MEDIAN_OUTDOORS = 45.0
WARMEST_MEDIAN_INDOORS = 45.0
"""Medians [degC] above these are degF; above ``COLDEST_KELVIN`` they are K."""
COLDEST_KELVIN = 180.0
FAHRENHEIT_SHARE = 0.01
"""More values than this above ``WARMEST`` are no failed sensor but another unit."""
LARGEST_MEDIAN_PRICE = 3.0
"""Prices whose median magnitude is above this [currency/kWh] are in cents, or in currency/MWh."""
NIGHT_SHARE = 0.01
"""Share of the PV energy between 22:00 and 04:00 that hints at a wrong clock."""
NOON_RANGE = (9.5, 16.5)
"""Wall clock hours between which the centre of the PV generation lies, wherever the home is."""


def unit_problems(names: Sequence[str], columns: Sequence[Float[np.ndarray, "slots"]]) -> list[str]:
    """One sentence for each column that cannot be in the unit of its name; NaN are left out."""
    problems = []
    for name, column in zip(names, columns, strict=True):
        known = column[np.isfinite(column)]
        problem = _unit_problem(name, known) if len(known) else None
        if problem is not None:
            problems.append(problem)
    return problems


def _unit_problem(name: str, values: Float[np.ndarray, "known"]) -> str | None:
    if name.endswith("_kw"):
        return _power_problem(name, values)
    if name.endswith("_c"):
        return _temperature_problem(name, values)
    return _price_problem(name, values)


def _power_problem(name: str, values: Float[np.ndarray, "known"]) -> str | None:
    positive = values[values > 0]
    median = float(np.median(positive)) if len(positive) else 0.0
    if values.max() <= LARGEST_HOME and median <= LARGEST_MEDIAN_POWER:
        return None
    return (
        f"{name} reaches {values.max():.4g} kW and its median is {median:.4g} kW, more than a home has: "
        "expected kW, this looks like W. Divide by 1000"
    )


def _temperature_problem(name: str, values: Float[np.ndarray, "known"]) -> str | None:
    median, low, high = float(np.median(values)), values.min(), values.max()
    limit = WARMEST_MEDIAN_INDOORS if name == "indoor_c" else WARMEST_MEDIAN_OUTDOORS
    found = f"{name} runs from {low:.4g} to {high:.4g} degC (median {median:.4g})"
    if median > COLDEST_KELVIN:
        return f"{found}: expected degrees Celsius, this looks like kelvin. Subtract 273.15"
    if median > limit or np.mean(values > WARMEST) > FAHRENHEIT_SHARE:
        return f"{found}: expected degrees Celsius, this looks like Fahrenheit. Convert: (F - 32) / 1.8"
    if high > WARMEST or low < COLDEST:
        return f"{found}: expected temperatures that occur. Empty the cells of the failed sensor"
    return None


def _price_problem(name: str, values: Float[np.ndarray, "known"]) -> str | None:
    median = float(np.median(np.abs(values)))
    if median <= LARGEST_MEDIAN_PRICE:
        return None
    return (
        f"{name} has a median of {median:.4g} per kWh: expected currency/kWh, this looks like cents/kWh "
        "(divide by 100) or currency/MWh (divide by 1000). If it is right, count in a larger unit: 100 yen"
    )


@dataclass(frozen=True)
class SolarClock:
    """When the sun shines by the wall clock."""

    centre: float
    """Hour around which the generation lies."""
    night_share: float
    """Share of the energy between 22:00 and 04:00."""


def solar_clock(traces: Traces) -> SolarClock | None:
    """When PV generates; None without PV. The centre is a mean on the circle of 24 h."""
    generation, hour = traces.exogenous.pv_generation, traces.exogenous.hour_of_day
    if generation.sum() <= 0:
        return None
    angle = 2 * np.pi * (hour + traces.slot_length / 2) / 24
    mean = np.sum(generation * np.exp(1j * angle))
    night = (hour >= 22) | (hour < 4)
    return SolarClock(
        centre=float(np.angle(mean) * 24 / (2 * np.pi) % 24),
        night_share=float(generation[night].sum() / generation.sum()),
    )


def oddities(traces: Traces) -> tuple[str, ...]:
    """What is allowed but worth knowing, one sentence each."""
    e = traces.exogenous
    notes = []
    sun = solar_clock(traces)
    if sun is None:
        notes.append("pv_kw is zero throughout: a home without PV")
    elif not NOON_RANGE[0] < sun.centre < NOON_RANGE[1]:
        notes.append(
            f"pv_kw is centred at {sun.centre:.1f} h of the wall clock: are the time stamps in the "
            "home's time zone?"
        )
    elif sun.night_share > NIGHT_SHARE:
        notes.append(f"{100 * sun.night_share:.3g} % of the energy of pv_kw falls between 22:00 and 04:00")
    for what, mask in (
        ("sell_per_kwh is above buy_per_kwh", e.selling_price > e.buying_price),
        ("buy_per_kwh is negative", e.buying_price < 0),
    ):
        if mask.any():
            notes.append(f"{what} in {duration(int(mask.sum()) * traces.slot_length)}")
    if (e.load == e.load[0]).all():
        notes.append(f"load_kw is {e.load[0]:.4g} kW throughout")
    return tuple(notes)
