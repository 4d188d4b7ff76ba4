"""Weather and prices from files of their own, brought onto the clock of a home."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np

from hemma.data.clock import Clock, regular_clock
from hemma.data.columns import Columns
from hemma.data.csv_table import CsvTable, parse_table, read_header
from hemma.data.gaps import fill_gaps
from hemma.data.plausibility import require_plausible
from hemma.data.source_file import read_source
from hemma.errors import HemmaError

LONGEST_GAP = 3.0
"""Weather and prices are interpolated over holes of at most this [h]."""


def outdoor_temperature(path: Path, clock: Clock, latitude: float | None = None) -> Columns:
    """``outdoor_c`` [degC] on ``clock`` from a CSV file.

    The file has ``time,outdoor_c`` (other columns are left alone), or is Dataport's weather table with
    ``localhour,temperature`` in degF; of its places the one nearest to ``latitude`` is taken.
    Finer data are averaged over each slot, coarser ones interpolated between their time stamps.
    """
    file = read_source(path)
    header = read_header(file)
    if "localhour" in header:
        table = _nearest_place(parse_table(file, ("localhour", "temperature"), header), latitude)
        native = _native(table, "localhour", "temperature", clock)
        native = replace(native, series={"outdoor_c": (native.series["temperature"] - 32) / 1.8})
    else:
        native = _native(parse_table(file, ("time", "outdoor_c"), header), "time", "outdoor_c", clock)
    require_plausible(str(path), native)
    if native.clock.step <= clock.step:
        return _averaged(native, clock)
    values = np.interp(clock.seconds, native.clock.seconds, native.series["outdoor_c"])
    return Columns(clock, {"outdoor_c": values}, native.notes)


def price(path: Path, column: str, clock: Clock) -> Columns:
    """A price [currency/kWh] on ``clock`` from a CSV file with ``time`` and ``column``.

    Finer prices are averaged over each slot, coarser ones hold until the next. There is no column if the
    selling price is not in the file.
    """
    file = read_source(path)
    header = read_header(file)
    if column not in header and column == "sell_per_kwh":
        return Columns(clock, {})
    native = _native(parse_table(file, ("time", column), header), "time", column, clock)
    require_plausible(str(path), native)
    return _averaged(native, clock)


def _native(table: CsvTable, time: str, column: str, clock: Clock) -> Columns:
    """The part of a column that covers ``clock``, its short holes filled."""
    placement = regular_clock(table.stamps(time), str(table.path))
    whole, series = placement.clock, placement.placed(table.numbers(column))
    end = clock.start + clock.slots * clock.step
    if clock.start < whole.start or end > whole.start + whole.slots * whole.step:
        raise HemmaError(
            f"{table.path}: expected {column} from {clock.text(0)} to {clock.text(clock.slots)}, the period "
            f"of the home, got {whole.text(0)} to {whole.text(whole.slots)}. Give a longer file or a "
            "shorter period"
        )
    first, stop = (clock.start - whole.start) // whole.step, -((whole.start - end) // whole.step)
    stop = min(stop + 1, whole.slots) if whole.step > clock.step else stop
    while first > 0 and np.isnan(series[first]):
        first -= 1
    while stop < whole.slots and np.isnan(series[stop - 1]):
        stop += 1
    filled = fill_gaps(str(table.path), Columns(whole, {column: series}).window(first, stop), LONGEST_GAP)
    return replace(filled, notes=tuple(f"{note} of {table.path.name}" for note in filled.notes))


def _averaged(native: Columns, clock: Clock) -> Columns:
    """Means over each slot of series that are constant over their own slots: exact for any two lengths."""
    step = math.gcd(math.gcd(native.clock.step, clock.step), clock.start - native.clock.start)
    moments = clock.start + step * np.arange(clock.slots * (clock.step // step), dtype=np.int64)
    places = (moments - native.clock.start) // native.clock.step
    means = {name: fine[places].reshape(clock.slots, -1).mean(axis=1) for name, fine in native.series.items()}
    return Columns(clock, means, native.notes)


def _nearest_place(table: CsvTable, latitude: float | None) -> CsvTable:
    if "latitude" not in table.header:
        return table
    latitudes = table.numbers("latitude")
    places = np.unique(latitudes[np.isfinite(latitudes)])
    if len(places) > 1 and latitude is None:
        raise HemmaError(
            f"{table.path}: expected the weather of one place, got latitudes {', '.join(map(str, places))}. "
            "Say which (Austin is 30.292432)"
        )
    nearest = places[0] if latitude is None else places[np.argmin(np.abs(places - latitude))]
    stamps = table.cells("localhour")
    rows = sorted(np.flatnonzero(latitudes == nearest).tolist(), key=stamps.__getitem__)
    return replace(table, rows=[table.rows[row] for row in rows], lines=[table.lines[row] for row in rows])
