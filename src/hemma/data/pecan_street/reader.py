"""One home of a Dataport file, with weather and prices from elsewhere, as traces."""

import hashlib
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from hemma.data.canonical import canonical_text
from hemma.data.clock import Clock, Stamps, regular_clock
from hemma.data.columns import Columns
from hemma.data.gaps import counted, fill_gaps
from hemma.data.pecan_street.circuits import Circuits, home_power, instrumented
from hemma.data.pecan_street.files import dataport_file
from hemma.data.pecan_street.rows import HomeRows, between, rows_of_home, wall_clock_offsets
from hemma.data.plausibility import require_plausible
from hemma.data.surroundings import outdoor_temperature, price
from hemma.data.time_of_use import TimeOfUse
from hemma.data.traces import Traces
from hemma.data.validation import Log, Repairs, validated
from hemma.errors import HemmaError


@dataclass(frozen=True)
class PecanStreetOptions:
    """How a Dataport file becomes traces."""

    slot_length: float = 1.0
    """dt [h], a multiple of the file's interval; powers are averaged."""
    start: str | None = None
    """First day (or wall clock time) that is read, such as ``2018-06-01``."""
    stop: str | None = None
    """First day (or wall clock time) that is not read any more."""
    exclude_cars: bool = False
    """Take car1 and car2 out of the load."""
    exclude_battery: bool = False
    """Take the home's own battery out of the load."""
    longest_gap: float = 1.0
    """Holes of at most this [h] are interpolated."""
    latitude: float | None = None
    """Place in a weather table that has several; Austin is 30.292432."""
    stamp_zone: str = "US/Central"
    """Of time stamps without an offset."""
    home_zone: str = "US/Central"
    """Of the home's wall clock. Dataport stamps homes in California with Central time: give US/Pacific."""


DEFAULT_OPTIONS = PecanStreetOptions()


def read_pecan_street(
    path: str | Path,
    home: int,
    *,
    weather: str | Path,
    prices: str | Path | TimeOfUse,
    options: PecanStreetOptions = DEFAULT_OPTIONS,
) -> Traces:
    """One home of a Dataport file (1 minute, 15 minutes or 1 hour; schema ``use,gen`` or ``grid,solar``).

    ``weather`` is a CSV file ``time,outdoor_c`` or Dataport's weather table, ``prices`` a CSV file
    ``time,buy_per_kwh[,sell_per_kwh]`` or a time-of-use tariff: the files of the homes have neither. There is
    no indoor temperature. ``sha256`` is that of the canonical file that the traces export to, for they come
    from several files. Errors: HemmaError for whatever cannot be repaired, with file, place and cure.
    """
    name = f"{path}, home {home}"
    rows = rows_of_home(dataport_file(Path(path)), home, options.stamp_zone, options.home_zone)
    power = _resampled(name, _whole(name, _native(name, rows, options), options), options.slot_length)
    outdoor = outdoor_temperature(Path(weather), power.clock, options.latitude)
    columns = _beside(power, outdoor, *_prices(prices, power.clock))
    log = Log(f"pecan-street-{home}", name, columns, sha256="", source=_source(home, weather, prices))
    traces = validated(log, Repairs(longest_gap=0.0))
    return replace(traces, sha256=hashlib.sha256(canonical_text(traces).encode()).hexdigest())


def _native(name: str, rows: HomeRows, options: PecanStreetOptions) -> Columns:
    """PV, load and perhaps HVAC power [kW] in the period, on the clock of the file, with holes."""
    inside = between(rows.stamps, options.start, options.stop)
    if not inside.any():
        raise HemmaError(
            f"{name}: expected rows between {options.start} and {options.stop}, got only "
            f"{rows.stamps.text(0)} to {rows.stamps.text(-1)}. Choose a period in which the home was measured"
        )
    stamps = rows.stamps
    places = [place for place, kept in zip(stamps.places, inside, strict=True) if kept]
    placement = regular_clock(Stamps(stamps.seconds[inside], stamps.offset[inside], places), name)
    clock = replace(placement.clock, offset=wall_clock_offsets(placement.clock.seconds, options.home_zone))
    circuits = Circuits(name, {key: column[inside] for key, column in instrumented(rows.circuits).items()})
    power = home_power(circuits, exclude_cars=options.exclude_cars, exclude_battery=options.exclude_battery)
    series = {key: placement.placed(column) for key, column in power.items()}
    columns = Columns(clock, series, (*rows.notes, *circuits.notes))
    require_plausible(name, columns)
    return columns


def _whole(name: str, power: Columns, options: PecanStreetOptions) -> Columns:
    """The same between its first and last complete row, short holes filled."""
    complete = np.flatnonzero(np.all(np.isfinite([*power.series.values()]), axis=0))
    if not len(complete):
        raise HemmaError(
            f"{name}: expected rows in which {', '.join(power.series)} are known, got none. Choose "
            "another home or period"
        )
    whole = power.window(int(complete[0]), int(complete[-1]) + 1)
    cut = power.clock.slots - whole.clock.slots
    if cut:
        note = f"{counted(cut, 'incomplete interval')} cut off at the ends"
        whole = replace(whole, notes=(*whole.notes, note))
    return fill_gaps(name, whole, options.longest_gap)


def _resampled(name: str, power: Columns, slot_length: float) -> Columns:
    """Means over slots of ``slot_length`` [h] from its multiples on the wall clock on: energy is kept."""
    clock, step = power.clock, round(slot_length * 3600)
    if step <= 0 or step % clock.step:
        raise HemmaError(
            f"{name}: expected a slot length that is a multiple of the file's {clock.step / 60:g} minutes, "
            f"got {slot_length * 60:g} minutes. Choose another slot length or a finer file"
        )
    factor = step // clock.step
    begins = np.flatnonzero(clock.wall % step == 0)
    slots = (clock.slots - int(begins[0])) // factor if len(begins) else 0
    if slots < 2:
        raise HemmaError(
            f"{name}: expected at least two whole slots of {slot_length:g} h, got {slots}. Take a "
            "longer period or shorter slots"
        )
    whole = power.window(int(begins[0]), int(begins[0]) + slots * factor)
    means = {key: column.reshape(slots, factor).mean(axis=1) for key, column in whole.series.items()}
    return Columns(Clock(whole.clock.start, step, whole.clock.offset[::factor]), means, power.notes)


def _prices(prices: str | Path | TimeOfUse, clock: Clock) -> list[Columns]:
    if isinstance(prices, TimeOfUse):
        series = {"buy_per_kwh": prices.buying_price(clock), "sell_per_kwh": prices.selling_price(clock)}
        return [Columns(clock, series)]
    return [price(Path(prices), column, clock) for column in ("buy_per_kwh", "sell_per_kwh")]


def _beside(*parts: Columns) -> Columns:
    """Columns of one clock from several sources."""
    series = {name: column for part in parts for name, column in part.series.items()}
    return Columns(parts[0].clock, series, tuple(note for part in parts for note in part.notes))


def _source(home: int, weather: str | Path, prices: str | Path | TimeOfUse) -> str:
    tariff = (
        "an assumed time-of-use tariff" if isinstance(prices, TimeOfUse) else f"prices of {Path(prices).name}"
    )
    return (
        f"Pecan Street Dataport home {home} (measured; licensed, not to be passed on), weather of "
        f"{Path(weather).name}, {tariff}."
    )
