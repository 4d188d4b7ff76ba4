"""The rows of one home of a Dataport file, in order of time, as numbers."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from hemma.data.clock import Stamps, wall_clock
from hemma.data.gaps import counted
from hemma.data.pecan_street.circuits import CIRCUITS
from hemma.data.pecan_street.files import DataportFile, Piece
from hemma.data.pecan_street.stamps import NOT_A_TIME, moments
from hemma.errors import HemmaError


@dataclass(frozen=True)
class HomeRows:
    """Sorted, each moment once."""

    stamps: Stamps
    circuits: Mapping[str, Float[np.ndarray, "rows"]]
    """[kW], NaN where a cell is empty."""
    notes: tuple[str, ...]


def rows_of_home(file: DataportFile, home: int, stamp_zone: str, home_zone: str) -> HomeRows:
    """The rows of ``home``; ``stamp_zone`` is for stamps without offset, ``home_zone`` for its wall clock."""
    piece = _rows(file, home)
    read = moments(str(file.path), piece.time, piece.line, stamp_zone)
    valid = np.flatnonzero(read.seconds != NOT_A_TIME)
    seconds, first = np.unique(read.seconds[valid], return_index=True)
    rows = valid[first]
    doubles, notes = len(valid) - len(rows), read.notes
    if doubles:
        notes = (*notes, f"{counted(doubles, 'row')} left out whose moment was there before")
    places = [f"line {line}" for line in piece.line[rows].tolist()]
    return HomeRows(
        stamps=Stamps(seconds, wall_clock_offsets(seconds, home_zone), places),
        circuits={name: column[rows] for name, column in piece.circuits.items()},
        notes=notes,
    )


def between(stamps: Stamps, start: str | None, stop: str | None) -> Bool[np.ndarray, "rows"]:
    """Which rows lie in the period from ``start`` (included) to ``stop`` (excluded), wall clock times."""
    wall = wall_clock(stamps.seconds, stamps.offset).astype("datetime64[s]")
    inside = np.ones(len(wall), bool)
    for text, bound in ((start, np.greater_equal), (stop, np.less)):
        if text is None:
            continue
        try:
            inside &= bound(wall, np.datetime64(text, "s"))
        except ValueError as error:
            raise HemmaError(
                f"period: expected a day or time such as 2018-06-01, got {text!r}. Correct it"
            ) from error
    return inside


def _rows(file: DataportFile, home: int) -> Piece:
    """All rows of a home, as they stand in the file."""
    circuits, parts, homes = file.having(CIRCUITS), [], set()
    for piece in file.pieces(circuits):
        homes |= set(np.unique(piece.home).tolist())
        parts.append(piece.of_home(home))
    if home not in homes:
        known = ", ".join(map(str, sorted(homes)))
        raise HemmaError(f"{file.path}: expected one of its homes, got {home}. It holds {known}")
    return Piece(
        line=np.concatenate([part.line for part in parts]),
        home=np.concatenate([part.home for part in parts]),
        time=[time for part in parts for time in part.time],
        circuits={name: np.concatenate([part.circuits[name] for part in parts]) for name in circuits},
    )


def wall_clock_offsets(seconds: Int[np.ndarray, "rows"], zone: str) -> Float[np.ndarray, "rows"]:
    """Wall clock of ``zone`` minus UTC [h]."""
    import pandas as pd

    utc = pd.DatetimeIndex(seconds.astype("datetime64[s]"))
    try:
        wall = utc.tz_localize("UTC").tz_convert(zone).tz_localize(None)
    except KeyError as error:
        raise HemmaError(f"expected a time zone such as US/Central, got {zone!r}. Correct it") from error
    return np.array((wall - utc) / pd.Timedelta(hours=1), float)
