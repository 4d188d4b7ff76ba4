"""Weather and prices from files of their own, brought onto the clock of a home."""

import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

from hemma.data.clock import Clock, regular_clock
from hemma.data.csv_table import CsvTable, parse_table, read_header
from hemma.data.gaps import fill_gaps
from hemma.data.plausibility import require_plausible
from hemma.data.source_file import read_source
from hemma.errors import HemmaError

Series = Float[np.ndarray, "slots"]
LONGEST_GAP = 3.0
"""Weather and prices are interpolated over holes of at most this [h]."""


@dataclass(frozen=True)
class Native:
    """A series on the clock of its own file, without holes."""

    clock: Clock
    values: Float[np.ndarray, "native"]
    notes: tuple[str, ...]


@dataclass(frozen=True)
class Surrounding:
    """A series on the clock of a home."""

    values: Series
    notes: tuple[str, ...]


def outdoor_temperature(path: Path, clock: Clock, latitude: float | None = None) -> Surrounding:
    """T_out [degC] on ``clock`` from a CSV file.

    The file has ``time,outdoor_c`` (other columns are left alone), or is Dataport's weather table with
    ``localhour,temperature`` in degF; of its places the one nearest to ``latitude`` is taken.
    Finer data are averaged over each slot, coarser ones interpolated between their time stamps.
    """
    file = read_source(path)
    if "localhour" in read_header(file):
        table = _nearest_place(parse_table(file, ("localhour", "temperature"), read_header(file)), latitude)
        native = _native(table, "localhour", "temperature", clock)
        native = replace(native, values=(native.values - 32) / 1.8)
    else:
        table = parse_table(file, ("time", "outdoor_c"), read_header(file))
        native = _native(table, "time", "outdoor_c", clock)
    require_plausible(str(path), native.clock, ["outdoor_c"], [native.values])
    return Surrounding(_interpolated(native, clock), native.notes)


def price(path: Path, column: str, clock: Clock) -> Surrounding | None:
    """A price [currency/kWh] on ``clock`` from a CSV file with ``time`` and ``column``.

    Finer prices are averaged over each slot, coarser ones hold until the next. None if the selling price is
    not in the file.
    """
    file = read_source(path)
    header = read_header(file)
    if column not in header and column == "sell_per_kwh":
        return None
    native = _native(parse_table(file, ("time", column), header), "time", column, clock)
    require_plausible(str(path), native.clock, [column], [native.values])
    return Surrounding(_averaged(native, clock), native.notes)


def _native(table: CsvTable, time: str, column: str, clock: Clock) -> Native:
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
    cut = whole.window(first, stop)
    filled = fill_gaps(str(table.path), cut, [column], [series[first:stop]], LONGEST_GAP)
    notes = tuple(f"{note} of {table.path.name}" for note in filled.notes)
    return Native(cut, filled.columns[0], notes)


def _interpolated(native: Native, clock: Clock) -> Series:
    if native.clock.step <= clock.step:
        return _averaged(native, clock)
    return np.interp(clock.seconds, native.clock.seconds, native.values)


def _averaged(native: Native, clock: Clock) -> Series:
    """Mean over each slot of a series that is constant over its own slots: exact for any two lengths."""
    step = math.gcd(math.gcd(native.clock.step, clock.step), clock.start - native.clock.start)
    moments = clock.start + step * np.arange(clock.slots * (clock.step // step), dtype=np.int64)
    fine = native.values[(moments - native.clock.start) // native.clock.step]
    return fine.reshape(clock.slots, -1).mean(axis=1)


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
    return CsvTable(
        table.path, table.header, [table.rows[row] for row in rows], [table.lines[row] for row in rows]
    )
