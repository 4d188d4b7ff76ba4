"""Does a column look like its unit? Wrong units are refused with the conversion, odd values are reported."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from hemma.data.clock import duration
from hemma.data.columns import Columns, Series
from hemma.data.outliers import absurd_cells, believable, stuck_cells, unusual_cells
from hemma.data.traces import Traces
from hemma.errors import HemmaError

LARGEST_MEDIAN_POWER = 40.0
"""A column of power [kW] whose median magnitude, zeros left out, is above this is in W."""
WARMEST_MEDIAN = 45.0
"""Medians [degC] above this are another unit: K if all values lie between the two below, else degF."""
KELVIN = (200.0, 335.0)
FAHRENHEIT = (60.0, 140.0)
FAHRENHEIT_SHARE = 0.01
"""More values than this in the range of a summer in degF are no failed sensor but another unit."""
LARGEST_MEDIAN_PRICE = 3.0
"""Prices whose median magnitude is above this [currency/kWh] are in cents, or in currency/MWh."""
SMALLEST_POWER = 0.05
"""A column of power that never exceeds this [kW] is perhaps in MW, or was divided twice."""
NIGHT_SHARE = 0.01
"""Share of the PV energy between 22:00 and 04:00 that hints at a wrong clock."""
NOON_RANGE = (9.5, 16.5)
"""Wall clock hours between which the centre of the PV generation lies, wherever the home is."""


def require_plausible(file: str, columns: Columns) -> None:
    """Refuse columns in another unit than that of their name, and cells that nothing measured; NaN pass."""
    problems = []
    for name, column in columns.series.items():
        problem = _unit_problem(name, column) or absurd_cells(name, columns.clock, column)
        if problem is not None:
            problems.append(problem)
    if problems:
        raise HemmaError(f"{file}: {'; '.join(problems)}")


def _unit_problem(name: str, column: Series) -> str | None:
    """What a whole column says about its unit; single cells that nothing measured do not count."""
    typical = believable(column[np.isfinite(column)])
    if not len(typical):
        return None
    if name.endswith("_kw"):
        return _power_problem(name, typical)
    if name.endswith("_c"):
        return _temperature_problem(name, typical)
    return _price_problem(name, typical)


def _power_problem(name: str, values: Float[np.ndarray, "known"]) -> str | None:
    sizes = np.abs(values[values != 0])
    median = float(np.median(sizes)) if len(sizes) else 0.0
    if median <= LARGEST_MEDIAN_POWER:
        return None
    return (
        f"{name} reaches {sizes.max():.4g} kW and its median is {median:.4g} kW, more than a home has: "
        "expected kW, this looks like W. Divide by 1000"
    )


def _temperature_problem(name: str, values: Float[np.ndarray, "known"]) -> str | None:
    median = float(np.median(values))
    found = f"{name} runs from {values.min():.4g} to {values.max():.4g} degC (median {median:.4g})"
    summer = np.mean((values > FAHRENHEIT[0]) & (values < FAHRENHEIT[1]))
    if KELVIN[0] < values.min() and values.max() < KELVIN[1]:
        return f"{found}: expected degrees Celsius, this looks like kelvin. Subtract 273.15"
    if WARMEST_MEDIAN < median < FAHRENHEIT[1] or (summer > FAHRENHEIT_SHARE and median < FAHRENHEIT[1]):
        return f"{found}: expected degrees Celsius, this looks like Fahrenheit. Convert: (F - 32) / 1.8"
    if median > WARMEST_MEDIAN:
        return (
            f"{found}: expected degrees Celsius, this is no unit known here. Convert it (divide tenths by 10)"
        )
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


def oddities(traces: Traces, columns: Columns) -> tuple[str, ...]:
    """What is allowed but worth knowing, one sentence each; ``columns`` are those of the file, filled."""
    e = traces.exogenous
    notes = []
    for name, column in columns.series.items():
        notes += unusual_cells(name, columns.clock, column)
        notes += stuck_cells(name, columns.clock, column)
        if name.endswith("_kw") and 0 < column.max() < SMALLEST_POWER:
            notes.append(f"{name} is at most {column.max():.3g} kW: is it in kW?")
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
    return tuple(notes)
