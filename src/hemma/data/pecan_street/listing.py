"""Which homes a Dataport file holds, and what is instrumented in them."""

import csv
from collections.abc import Mapping
from dataclasses import dataclass, replace
from io import StringIO
from pathlib import Path

import numpy as np

from hemma.data.clock import iso_text
from hemma.data.pecan_street.circuits import BATTERY, CARS, CIRCUITS, HVAC, OLD, SOLAR, instrumented
from hemma.data.pecan_street.files import HOME_COLUMN, DataportFile, Piece, dataport_file, opened
from hemma.data.pecan_street.stamps import NOT_A_TIME, moments
from hemma.errors import HemmaError


@dataclass(frozen=True)
class PecanStreetHome:
    """What a file says about a home before its series are read."""

    home: int
    """dataid."""
    rows: int
    first: str
    """Start of the first row, ISO 8601 in UTC."""
    last: str
    """Start of the last row, ISO 8601 in UTC."""
    circuits: tuple[str, ...]
    """Instrumented circuits among those that Hemma uses."""
    city: str | None = None
    """From metadata.csv, as are the next two."""
    state: str | None = None
    pv_peak_power: float | None = None
    """[kW peak]."""

    @property
    def has_pv(self) -> bool:
        """Whether PV is instrumented."""
        return bool({*SOLAR, OLD[1]} & set(self.circuits))

    @property
    def has_hvac(self) -> bool:
        """Whether an HVAC circuit is instrumented."""
        return bool(set(HVAC) & set(self.circuits))

    @property
    def has_car(self) -> bool:
        """Whether a car charger is instrumented."""
        return bool(set(CARS) & set(self.circuits))

    @property
    def has_battery(self) -> bool:
        """Whether the home has a battery of its own."""
        return BATTERY in self.circuits


def list_pecan_street_homes(
    path: str | Path, metadata: str | Path | None = None, zone: str = "US/Central"
) -> list[PecanStreetHome]:
    """The homes of a Dataport file in the order of their numbers.

    ``metadata`` is Dataport's metadata.csv, which knows cities and PV sizes. ``zone`` is that of time stamps
    without an offset. Errors: HemmaError if a file is not what it should be.
    """
    file = dataport_file(Path(path))
    found: dict[int, PecanStreetHome] = {}
    for piece in file.pieces(file.having(CIRCUITS)):
        for home in np.unique(piece.home).tolist():
            part = _described(file, piece, home, zone)
            found[home] = _joined(found[home], part) if home in found else part
    homes = [found[home] for home in sorted(found)]
    return homes if metadata is None else _with_metadata(homes, Path(metadata))


def _described(file: DataportFile, piece: Piece, home: int, zone: str) -> PecanStreetHome:
    rows = piece.of_home(home)
    seconds = moments(str(file.path), rows.time, rows.line, zone).seconds
    seconds = seconds[seconds != NOT_A_TIME]
    return PecanStreetHome(
        home=home,
        rows=len(seconds),
        first=iso_text(int(seconds.min()), 0.0),
        last=iso_text(int(seconds.max()), 0.0),
        circuits=tuple(instrumented(rows.circuits)),
    )


def _joined(one: PecanStreetHome, other: PecanStreetHome) -> PecanStreetHome:
    both = {*one.circuits, *other.circuits}
    return replace(
        one,
        rows=one.rows + other.rows,
        first=min(one.first, other.first),
        last=max(one.last, other.last),
        circuits=tuple(circuit for circuit in CIRCUITS if circuit in both),
    )


def _with_metadata(homes: list[PecanStreetHome], path: Path) -> list[PecanStreetHome]:
    """Cities and PV sizes from metadata.csv, which is in ISO 8859-1; its second row holds descriptions."""
    with opened(path) as stream:
        rows = list(csv.DictReader(StringIO(stream.read().decode("latin-1"))))
    wanted = {HOME_COLUMN, "city", "state", "total_amount_of_pv"}
    if not rows or not wanted <= set(rows[0]):
        raise HemmaError(f"{path}: expected Dataport's metadata.csv with {', '.join(sorted(wanted))}")
    described = {row[HOME_COLUMN].strip(): row for row in rows}
    return [_named(home, described.get(str(home.home))) for home in homes]


def _named(home: PecanStreetHome, row: Mapping[str, str] | None) -> PecanStreetHome:
    if row is None:
        return home
    try:
        size = float(row["total_amount_of_pv"])
    except ValueError:
        size = None
    return replace(home, city=row["city"] or None, state=row["state"] or None, pv_peak_power=size)
