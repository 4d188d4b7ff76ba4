"""Time stamps of Dataport files: with offsets, naive local time of old dumps, or resaved by Excel."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Int

from hemma.data.gaps import counted
from hemma.errors import HemmaError, shortened

if TYPE_CHECKING:
    import pandas

OFFSET = re.compile(r":\d\d(\.\d+)?\s*([+-]\d\d(:?\d\d)?|Z)$")
NOT_A_TIME = np.iinfo(np.int64).min


@dataclass(frozen=True)
class Moments:
    """When each row begins."""

    seconds: Int[np.ndarray, "rows"]
    """[s since 1970-01-01T00:00:00Z]; ``NOT_A_TIME`` for a wall clock time that never was."""
    notes: tuple[str, ...]


def moments(name: str, cells: Sequence[str], lines: Int[np.ndarray, "rows"], zone: str) -> Moments:
    """The moments of the cells of a time column; ``name`` and ``lines`` say in messages where they stand.

    Stamps without an offset are wall clock times of ``zone``. Where that clock is turned back, the first row
    of a doubled time is taken as summer time and the second as standard time.
    """
    stripped = [cell.strip() for cell in cells]
    form = _form(name, stripped, lines)
    if form == "offset":
        return Moments(_seconds(_parsed(name, stripped, lines, "ISO8601")), ())
    layout = _excel_layout(name, stripped) if form == "excel" else "ISO8601"
    return _localised(_parsed(name, stripped, lines, layout), zone)


def _form(name: str, cells: Sequence[str], lines: Int[np.ndarray, "rows"]) -> str:
    forms = ["excel" if "/" in cell else "offset" if OFFSET.search(cell) else "naive" for cell in cells]
    for form, cell, line in zip(forms, cells, lines.tolist(), strict=True):
        if form != forms[0]:
            raise HemmaError(
                f"{name}, line {line}: expected a time stamp written like {shortened(cells[0])!r}, got "
                f"{shortened(cell)!r}. Write all of them in one way"
            )
    return forms[0]


def _excel_layout(name: str, cells: Sequence[str]) -> str:
    """Day first (as spreadsheets outside the USA write) unless a second number is no month."""
    seconds = [cell.split("/")[1] for cell in cells]
    month_first = any(number.isdigit() and int(number) > 12 for number in seconds)
    clocks = {cell.count(":") for cell in cells}
    if len(clocks) > 1:
        raise HemmaError(
            f"{name}: expected either minutes or seconds in every time stamp. Write them in one way"
        )
    clock = {0: "", 1: " %H:%M"}.get(clocks.pop(), " %H:%M:%S")
    return ("%m/%d/%Y" if month_first else "%d/%m/%Y") + clock


def _parsed(
    name: str, cells: Sequence[str], lines: Int[np.ndarray, "rows"], layout: str
) -> "pandas.DatetimeIndex":
    """In UTC if the stamps have offsets, else naive."""
    import pandas as pd

    has_offset = bool(OFFSET.search(cells[0]))
    parsed = pd.DatetimeIndex(pd.to_datetime(list(cells), format=layout, errors="coerce", utc=has_offset))
    bad = np.flatnonzero(np.asarray(parsed.isna()))
    if len(bad):
        raise HemmaError(
            f"{name}, line {lines[bad[0]]}: expected a time stamp such as 2018-06-01 00:00:00-05, got "
            f"{shortened(cells[int(bad[0])])!r} ({counted(len(bad), 'such row')}). Correct it"
        )
    return parsed


def _localised(local: "pandas.DatetimeIndex", zone: str) -> Moments:
    first = ~np.asarray(local.duplicated())
    try:
        aware = local.tz_localize(zone, ambiguous=first, nonexistent="NaT")
    except KeyError as error:
        raise HemmaError(f"expected a time zone such as US/Central, got {zone!r}. Correct it") from error
    notes = [f"time stamps have no offset and are taken as wall clock times of {zone}"]
    lost = int(np.sum(np.asarray(aware.isna())))
    if lost:
        notes.append(
            f"{counted(lost, 'row')} left out whose wall clock time is skipped when summer time begins"
        )
    return Moments(_seconds(aware), tuple(notes))


def _seconds(moments: "pandas.DatetimeIndex") -> Int[np.ndarray, "rows"]:
    return moments.tz_convert(None).to_numpy().astype("datetime64[s]").astype(np.int64)
