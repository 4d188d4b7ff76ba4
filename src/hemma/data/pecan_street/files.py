"""Dataport files as they lie on disk: plain, gzip, or in a tar archive; large, so they are read in pieces."""

import gzip
import math
import re
import tarfile
import zlib
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from io import BufferedIOBase
from pathlib import Path
from typing import TYPE_CHECKING, cast

import numpy as np
from jaxtyping import Float, Int

from hemma.data.csv_table import number
from hemma.data.source_file import GZIP
from hemma.errors import HemmaError, shortened

if TYPE_CHECKING:
    import pandas

TIME_COLUMNS = ("local_15min", "localhour", "localminute")
HOME_COLUMN = "dataid"
ROWS_AT_A_TIME = 200_000
LARGEST_HOME = 2.0**53
"""Numbers of homes are below this."""


@dataclass(frozen=True)
class Piece:
    """Some rows of a file."""

    line: Int[np.ndarray, "rows"]
    """Number of the line in the file, counted from 1."""
    home: Int[np.ndarray, "rows"]
    """dataid."""
    time: Sequence[str]
    """As it is written."""
    circuits: Mapping[str, Float[np.ndarray, "rows"]]
    """[kW], NaN where a cell is empty."""

    def of_home(self, home: int) -> "Piece":
        """The rows of one home."""
        rows = np.flatnonzero(self.home == home)
        circuits = {name: column[rows] for name, column in self.circuits.items()}
        return Piece(self.line[rows], self.home[rows], [self.time[row] for row in rows.tolist()], circuits)


@dataclass(frozen=True)
class DataportFile:
    """What the first line of a file says about it."""

    path: Path
    separator: str
    header: tuple[str, ...]
    time_column: str

    def having(self, columns: Sequence[str]) -> list[str]:
        """Those of ``columns`` that the file has."""
        return [column for column in columns if column in self.header]

    def pieces(self, circuits: Sequence[str]) -> Iterator[Piece]:
        """All rows with the named circuits, a piece at a time."""
        import pandas as pd

        wanted = [HOME_COLUMN, self.time_column, *circuits]
        with opened(self.path) as stream:
            try:
                with pd.read_csv(
                    stream,
                    sep=self.separator,
                    usecols=wanted,
                    dtype={self.time_column: str},
                    encoding="utf-8-sig",
                    skip_blank_lines=False,
                    low_memory=False,
                    chunksize=ROWS_AT_A_TIME,
                ) as frames:
                    for frame in frames:
                        yield self._piece(frame.dropna(how="all"), circuits)
            except HemmaError:
                raise
            except (ValueError, EOFError, OSError, zlib.error) as error:
                raise HemmaError(
                    f"{self.path}: expected rows of {len(self.header)} cells: {_reason(error)}. Correct the "
                    "file, or fetch it again"
                ) from error

    def _piece(self, frame: "pandas.DataFrame", circuits: Sequence[str]) -> Piece:
        line = np.array(frame.index, np.int64) + 2
        home = self._numbers(frame, HOME_COLUMN, line)
        whole = np.isfinite(home) & (np.abs(home) < LARGEST_HOME) & (home % 1 == 0)
        if not whole.all():
            row = int(np.argmin(whole))
            raise HemmaError(
                f"{self.path}, line {line[row]}: expected a whole number in {HOME_COLUMN}, got "
                f"{home[row]:g}. Correct it"
            )
        return Piece(
            line=line,
            home=home.astype(np.int64),
            time=["" if cell is None or cell != cell else cell for cell in frame[self.time_column].tolist()],
            circuits={circuit: self._numbers(frame, circuit, line) for circuit in circuits},
        )

    def _numbers(
        self, frame: "pandas.DataFrame", column: str, line: Int[np.ndarray, "rows"]
    ) -> Float[np.ndarray, "rows"]:
        """A column, NaN where it is empty; where semicolons part the cells, decimal commas are read."""
        values = np.asarray(frame[column])
        if values.dtype.kind in "iuf" and not np.isinf(values).any():
            return values.astype(float)
        cells = frame[column].tolist()
        if self.separator == ";":
            cells = [cell.replace(",", ".") if isinstance(cell, str) else cell for cell in cells]
        values = np.empty(len(cells))
        for row, cell in enumerate(cells):
            values[row] = _number(cell)
            if np.isinf(values[row]):
                raise HemmaError(
                    f"{self.path}, line {line[row]}: expected a number in {column}, got {shortened(cell)!r}. "
                    "Correct it, or empty the cell if the value is not known"
                )
        return values


def _number(cell: object) -> float:
    """The number in a cell; text counts as infinite, which nobody accepts, and so do true and false."""
    if isinstance(cell, str):
        return number(cell.strip())
    return float(cell) if isinstance(cell, int | float) and not isinstance(cell, bool) else math.inf


def _reason(error: Exception) -> str:
    """What was wrong with the rows; where a quote opens that is never closed, its line."""
    found = re.search(r"EOF inside string starting at row (\d+)", str(error))
    return (
        f"a quote that is never closed in line {int(found[1]) + 1}" if found else shortened(str(error), 200)
    )


def dataport_file(path: Path) -> DataportFile:
    """Recognise a Dataport file by its header."""
    with opened(path) as stream:
        try:
            line = stream.readline().decode("utf-8-sig").strip()
        except (UnicodeDecodeError, EOFError, OSError, zlib.error) as error:
            raise HemmaError(f"{path}: expected a Dataport CSV file: {error}. Fetch it again") from error
    separator = ";" if line.count(";") > line.count(",") else ","
    header = tuple(cell.strip().strip('"') for cell in line.split(separator))
    times = [column for column in TIME_COLUMNS if column in header]
    if HOME_COLUMN not in header or len(times) != 1:
        raise HemmaError(
            f"{path}: expected a Dataport file whose header has {HOME_COLUMN} and one of "
            f"{', '.join(TIME_COLUMNS)}, got {line[:80]!r}. Give the file with the power of the circuits"
        )
    return DataportFile(path, separator, header, times[0])


@contextmanager
def opened(path: Path) -> Iterator[BufferedIOBase]:
    """The CSV file in a ``.csv``, ``.csv.gz`` or ``.tar.gz``, unpacked while it is read."""
    try:
        if tarfile.is_tarfile(path):
            with tarfile.open(path) as archive, _member(path, archive) as stream:
                yield stream
            return
        with path.open("rb") as file, _unpacked(file) as stream:
            yield stream
    except (OSError, tarfile.TarError) as error:
        raise HemmaError(f"{path}: expected a readable file: {error}. Check the path") from error


@contextmanager
def _member(path: Path, archive: tarfile.TarFile) -> Iterator[BufferedIOBase]:
    names = [
        member.name
        for member in archive
        if member.isfile()
        and member.name.endswith((".csv", ".csv.gz"))
        and not Path(member.name).name.startswith(("metadata", "."))
    ]
    if len(names) != 1:
        raise HemmaError(
            f"{path}: expected one CSV file in the archive, got {shortened(str(names), 200)}. Unpack it and "
            "name one"
        )
    with _unpacked(cast(BufferedIOBase, archive.extractfile(names[0]))) as stream:
        yield stream


@contextmanager
def _unpacked(file: BufferedIOBase) -> Iterator[BufferedIOBase]:
    compressed = file.read(2) == GZIP
    file.seek(0)
    if not compressed:
        yield file
        return
    with gzip.open(file) as stream:
        yield stream
