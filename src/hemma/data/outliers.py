"""Single cells that do not fit their column: marks for no value, counters that were reset, stuck sensors."""

import math

import numpy as np
from jaxtyping import Bool, Float

from hemma.data.clock import Clock, Series, duration, runs

NO_HOME = 200.0
"""No home generates or uses more than this [kW]."""
WARMEST = 60.0
"""No weather station has measured more than this [degC]."""
COLDEST = -90.0
DEAREST = 30.0
DEAREST_RATIO = 100.0
"""No market has had prices [currency/kWh] above both the first and this multiple of the median magnitude."""
HIGHEST_BELIEVED = 1e10
"""Larger magnitudes do not count when a column is judged as a whole."""
COUNTERS = (2**15 - 1, 2**15, 2**16 - 1, 2**31 - 1, 2**31, 2**32 - 1)
NINES = (99, 999, 9999, 99999, 999999)
THERMOMETER = (85.0, 127.0)
"""What the common digital thermometers [degC] say after a reset, and (negative) without a contact."""
MARKS = np.array(
    [nines + part for nines in NINES for part in (0.0, 0.9, 0.99)]
    + [value / scale for value in COUNTERS for scale in (1, 10, 100)]
    + list(THERMOMETER)
)
"""Magnitudes that loggers and drivers write where they have no value; marks only where they do not fit."""
USUAL_RATIO = {"pv_kw": 8.0, "load_kw": 30.0, "hvac_kw": 30.0}
"""Powers above this multiple of the upper quartile of the positive ones are told."""
USUAL_POWER = {"pv_kw": 1.0, "load_kw": 10.0, "hvac_kw": 10.0}
"""Powers [kW] up to this are not."""
USUAL_PRICE_RATIO = 25.0
USUAL_PRICE = 0.5
"""Prices [currency/kWh] above both this and that multiple of the median magnitude are told."""
LARGEST_JUMP = 15.0
LARGEST_DISTANCE = 45.0
"""A temperature so far [degC] from both its neighbours, or (the second) from the median, is told."""
PART = 0.1
"""More absurd cells than this share of a column are a part of it in another unit, or a long failure."""
LONGEST_STILL = {"pv_kw": 24.0, "load_kw": 36.0, "hvac_kw": 48.0, "outdoor_c": 36.0, "indoor_c": 72.0}
"""A sensor whose value stays the same to the last digit for this long [h] is perhaps stuck."""


def believable(values: Float[np.ndarray, "known"]) -> Float[np.ndarray, "believed"]:
    """The values without those that are marks for no value or beyond every unit."""
    return values[~_is_mark(values) & (np.abs(values) < HIGHEST_BELIEVED)]


def absurd_cells(name: str, clock: Clock, column: Series) -> str | None:
    """Cells that nobody can have measured (NaN do not count): how many, which and the cure, or None."""
    known = np.isfinite(column)
    wrong = np.zeros(len(column), bool)
    wrong[known] = _absurd(name, column[known])
    if not wrong.any():
        return None
    return (
        f"{_slots(wrong)} of {name} {'is' if wrong.sum() == 1 else 'are'} not to be believed, "
        f"{_named(name, clock, column, wrong)}: expected {_expected(name)}. "
        f"{_cause(name, column[wrong], float(wrong.mean()))}"
    )


def unusual_cells(name: str, clock: Clock, column: Series) -> list[str]:
    """A note on cells that stand out but may be right."""
    far = _far(name, column)
    if not far.any():
        return []
    doubt = "scarcity, or a slip of the decimal point?" if _is_price(name) else "is it right?"
    return [
        f"{_slots(far)} of {name} {'stands' if far.sum() == 1 else 'stand'} out, "
        f"{_named(name, clock, column, far)}: {doubt} If not, empty it"
    ]


def stuck_cells(name: str, clock: Clock, column: Series) -> list[str]:
    """A note on the longest time for which a sensor gives one value, if that is very long."""
    if name not in LONGEST_STILL:
        return []
    off = (column[1:] == 0) & (name in ("pv_kw", "hvac_kw"))
    still = runs((np.diff(column) == 0) & ~off)
    start, stop = max(still, key=lambda run: run[1] - run[0], default=(0, -1))
    length = (stop - start + 1) * clock.slot_length
    if length < LONGEST_STILL[name]:
        return []
    return [
        f"{name} is exactly {column[start]:.6g} {_unit(name)} for {duration(length)} from "
        f"{clock.text(start)}: is the sensor stuck?"
    ]


def _absurd(name: str, values: Float[np.ndarray, "known"]) -> Bool[np.ndarray, "known"]:
    marks = _is_mark(values)
    if name.endswith("_kw"):
        return (np.abs(values) > NO_HOME) | (marks & ((values < 0) | _far(name, values)))
    if name.endswith("_c"):
        return (values > WARMEST) | (values < COLDEST)
    rest = np.abs(believable(values))
    dearest = max(DEAREST, DEAREST_RATIO * np.median(rest)) if len(rest) else DEAREST
    return (np.abs(values) > dearest) | (marks & _far(name, values))


def _far(name: str, values: Series) -> Bool[np.ndarray, "slots"]:
    """What stands out of a column: far from most of what can be believed."""
    size, rest = np.abs(values), believable(values)
    if name.endswith("_c"):
        steps = np.diff(values)
        jump = (np.abs(steps[:-1]) > LARGEST_JUMP) & (np.abs(steps[1:]) > LARGEST_JUMP)
        alone = np.concatenate([[False], jump & (steps[:-1] * steps[1:] < 0), [False]])
        return alone | (np.abs(values - np.median(rest)) > LARGEST_DISTANCE) if len(rest) else alone
    if _is_price(name):
        usual = np.median(np.abs(rest)) if len(rest) else 0.0
        return size > max(USUAL_PRICE, USUAL_PRICE_RATIO * usual)
    positive = rest[rest > 0]
    usual = np.quantile(positive, 0.75) if len(positive) else 0.0
    return (values > 0) & (size > max(USUAL_POWER[name], USUAL_RATIO[name] * usual))


def _is_mark(values: Float[np.ndarray, "known"]) -> Bool[np.ndarray, "known"]:
    return np.isin(np.abs(values), MARKS)


def _is_price(name: str) -> bool:
    return name.endswith("_per_kwh")


def _unit(name: str) -> str:
    return "kW" if name.endswith("_kw") else "degC" if name.endswith("_c") else "per kWh"


def _expected(name: str) -> str:
    if name.endswith("_kw"):
        return f"0 to {NO_HOME:g} kW"
    if name.endswith("_c"):
        return f"{COLDEST:g} to {WARMEST:g} degC"
    return f"at most {DEAREST:g} per kWh, or {DEAREST_RATIO:g} times the median"


def _cause(name: str, wrong: Float[np.ndarray, "wrong"], share: float) -> str:
    """What may have happened, and the cure."""
    cells = "the cell" if len(wrong) == 1 else "these cells"
    marks = np.unique(wrong[_is_mark(wrong)])
    if len(marks):
        cause = f"A sentinel: loggers write {marks[0]:g} where they have no value. "
    elif share > PART:
        return "A part of the column in another unit? Convert it, or empty these cells"
    elif name.endswith("_kw"):
        cause = "A counter that was reset, or the energy of many slots in one? "
    else:
        cause = "A slip of the decimal point? " if _is_price(name) else ""
    return f"{cause}Empty {'the cells of the failed sensor' if name.endswith('_c') else cells}"


def _slots(mask: Bool[np.ndarray, "slots"]) -> str:
    count = int(mask.sum())
    return "one slot" if count == 1 else f"{count} slots"


def _named(name: str, clock: Clock, column: Series, cells: Bool[np.ndarray, "slots"]) -> str:
    """The largest of the cells, when it stands, and when the first of them stands."""
    worst, first = int(np.argmax(np.where(cells, np.abs(column), -1.0))), int(np.argmax(cells))
    positive = believable(column[column > 0])
    ratio = float(column[worst]) / float(np.median(positive)) if len(positive) else 0.0
    times = f"{ratio:.0f}" if ratio < 1e6 else f"{ratio:.3g}"
    return (
        f"{column[worst]:.6g} {_unit(name)} at {clock.text(worst)}"
        + (f", {times} times the median" if 1 < ratio < math.inf and not name.endswith("_c") else "")
        + (f" (the first at {clock.text(first)})" if first != worst else "")
    )
