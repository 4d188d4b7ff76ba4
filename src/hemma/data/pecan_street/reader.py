"""One home of a Dataport file, with weather and prices from elsewhere, as traces."""

import hashlib
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

from hemma.data.canonical import canonical_text
from hemma.data.clock import Clock, Stamps, regular_clock
from hemma.data.gaps import counted, fill_gaps
from hemma.data.pecan_street.circuits import Circuits, HomePower, home_power, instrumented
from hemma.data.pecan_street.files import dataport_file
from hemma.data.pecan_street.rows import HomeRows, between, rows_of_home, wall_clock_offsets
from hemma.data.plausibility import require_plausible
from hemma.data.surroundings import outdoor_temperature, price
from hemma.data.time_of_use import TimeOfUse
from hemma.data.traces import Traces
from hemma.data.validation import Columns, Log, Repairs, validated
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


@dataclass(frozen=True)
class _Power:
    """PV, load and perhaps HVAC power [kW] on a regular clock."""

    clock: Clock
    names: tuple[str, ...]
    series: tuple[Float[np.ndarray, "slots"], ...]
    notes: tuple[str, ...]


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
    clock = power.clock
    outdoor = outdoor_temperature(Path(weather), clock, options.latitude)
    tariff = _prices(prices, clock)
    log = Log(
        name=f"pecan-street-{home}",
        file=name,
        clock=clock,
        columns=Columns(
            **dict(zip(power.names, power.series, strict=True)),
            outdoor_c=outdoor.values,
            buy_per_kwh=tariff.buying,
            sell_per_kwh=tariff.selling,
        ),
        sha256="",
        source=_source(home, weather, prices),
        notes=(*rows.notes, *power.notes, *outdoor.notes, *tariff.notes),
    )
    traces = validated(log, Repairs(longest_gap=0.0))
    return replace(traces, sha256=hashlib.sha256(canonical_text(traces).encode()).hexdigest())


def _native(name: str, rows: HomeRows, options: PecanStreetOptions) -> _Power:
    """The power of the home in the period, on the clock of its file, with holes."""
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
    circuits = {key: column[inside] for key, column in instrumented(rows.circuits).items()}
    power = home_power(
        Circuits(name, circuits), exclude_cars=options.exclude_cars, exclude_battery=options.exclude_battery
    )
    present = _present(power)
    series = tuple(placement.placed(column) for column in present.values())
    require_plausible(name, clock, tuple(present), series)
    return _Power(clock, tuple(present), series, power.notes)


def _present(power: HomePower) -> dict[str, Float[np.ndarray, "rows"]]:
    columns = {"pv_kw": power.pv_kw, "load_kw": power.load_kw}
    return columns if power.hvac_kw is None else {**columns, "hvac_kw": power.hvac_kw}


def _whole(name: str, power: _Power, options: PecanStreetOptions) -> _Power:
    """The same between its first and last complete row, short holes filled."""
    complete = np.flatnonzero(np.all(np.isfinite(power.series), axis=0))
    if not len(complete):
        raise HemmaError(
            f"{name}: expected rows in which {', '.join(power.names)} are known, got none. Choose "
            "another home or period"
        )
    first, stop = int(complete[0]), int(complete[-1]) + 1
    clock, notes = power.clock.window(first, stop), power.notes
    cut = power.clock.slots - clock.slots
    if cut:
        notes = (*notes, f"{counted(cut, 'incomplete interval')} cut off at the ends")
    filled = fill_gaps(
        name, clock, power.names, [column[first:stop] for column in power.series], options.longest_gap
    )
    return _Power(clock, power.names, tuple(filled.columns), (*notes, *filled.notes))


def _resampled(name: str, power: _Power, slot_length: float) -> _Power:
    """Means over slots of ``slot_length`` [h] from its multiples on the wall clock on: energy is kept."""
    clock, step = power.clock, round(slot_length * 3600)
    if step <= 0 or step % clock.step:
        raise HemmaError(
            f"{name}: expected a slot length that is a multiple of the file's {clock.step / 60:g} minutes, "
            f"got {slot_length * 60:g} minutes. Choose another slot length or a finer file"
        )
    factor = step // clock.step
    wall = clock.seconds + np.round(clock.offset * 3600).astype(np.int64)
    begins = np.flatnonzero(wall % step == 0)
    slots = (clock.slots - int(begins[0])) // factor if len(begins) else 0
    if slots < 2:
        raise HemmaError(
            f"{name}: expected at least two whole slots of {slot_length:g} h, got {slots}. Take a "
            "longer period or shorter slots"
        )
    first = int(begins[0])
    stop = first + slots * factor
    series = tuple(column[first:stop].reshape(slots, factor).mean(axis=1) for column in power.series)
    coarse = Clock(int(clock.seconds[first]), step, clock.offset[first:stop:factor])
    return replace(power, clock=coarse, series=series)


@dataclass(frozen=True)
class _Prices:
    buying: Float[np.ndarray, "slots"]
    selling: Float[np.ndarray, "slots"] | None
    notes: tuple[str, ...]


def _prices(prices: str | Path | TimeOfUse, clock: Clock) -> _Prices:
    if isinstance(prices, TimeOfUse):
        return _Prices(prices.buying_price(clock), prices.selling_price(clock), ())
    buying = price(Path(prices), "buy_per_kwh", clock)
    selling = price(Path(prices), "sell_per_kwh", clock)
    assert buying is not None
    if selling is None:
        return _Prices(buying.values, None, buying.notes)
    return _Prices(buying.values, selling.values, (*buying.notes, *selling.notes))


def _source(home: int, weather: str | Path, prices: str | Path | TimeOfUse) -> str:
    tariff = (
        "an assumed time-of-use tariff" if isinstance(prices, TimeOfUse) else f"prices of {Path(prices).name}"
    )
    return (
        f"Pecan Street Dataport home {home} (measured; licensed, not to be passed on), weather of "
        f"{Path(weather).name}, {tariff}."
    )
