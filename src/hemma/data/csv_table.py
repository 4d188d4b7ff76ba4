"""A small CSV file as cells with their line numbers, and its columns as numbers and moments."""

import csv
import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
from jaxtyping import Float

from hemma.data.clock import Stamps
from hemma.data.source_file import SourceFile
from hemma.errors import HemmaError, shortened

EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
EXAMPLE_STAMP = "2021-08-01T00:00:00-06:00"
LIST = 300
"""So many characters of a list of columns stand in a message."""
YEARS = range(1900, 2200)
"""Years in which a time stamp may lie."""
LINE_END = re.compile(r"\r\n|\n|\r")


@dataclass(frozen=True)
class CsvTable:
    """Rows of text cells without spaces around them. Empty lines are left out."""

    path: Path
    header: tuple[str, ...]
    rows: Sequence[Sequence[str]]
    lines: Sequence[int]
    """Number of the line in the file that each row stands on, counted from 1."""

    def cells(self, column: str) -> list[str]:
        """The cells of a column."""
        index = self.header.index(column)
        return [row[index] for row in self.rows]

    def numbers(self, column: str) -> Float[np.ndarray, "rows"]:
        """A column as float64, NaN where the cell is empty or ``nan``; other text is refused."""
        values = np.empty(len(self.rows))
        for row, cell in enumerate(self.cells(column)):
            values[row] = number(cell) if cell else math.nan
            if math.isinf(values[row]):
                raise HemmaError(
                    f"{self.path}, line {self.lines[row]}: expected a finite number (or an empty cell) in "
                    f"{column}, got {shortened(cell)!r}. Write it like 0.35 or 3.5e-1, or empty the cell if "
                    "the value is not known"
                )
        return values

    def stamps(self, column: str) -> Stamps:
        """A column of ISO 8601 time stamps with offsets."""
        moments = [self._moment(row, cell) for row, cell in enumerate(self.cells(column))]
        return Stamps(
            seconds=np.array([round((moment - EPOCH).total_seconds()) for moment in moments], np.int64),
            offset=np.array([_offset(moment) for moment in moments], float),
            places=[f"line {line}" for line in self.lines],
        )

    def _moment(self, row: int, cell: str) -> datetime:
        try:
            moment = datetime.fromisoformat(cell)
        except ValueError:
            moment = None
        if moment is None or moment.utcoffset() is None or moment.microsecond or moment.year not in YEARS:
            raise HemmaError(
                f"{self.path}, line {self.lines[row]}: expected a time stamp in whole seconds with its "
                f"offset from UTC, such as {EXAMPLE_STAMP}, got {shortened(cell)!r}. Write every "
                "time stamp so"
            )
        return moment


def read_header(file: SourceFile) -> tuple[str, ...]:
    """The column names in the first line of a file that is not empty."""
    return next((cells for _, cells in _lines(file)), ())


def parse_table(file: SourceFile, required: Sequence[str], optional: Sequence[str]) -> CsvTable:
    """The CSV table of a file that holds the ``required`` columns, and of others only ``optional`` ones."""
    numbered = list(_lines(file))
    if not numbered:
        raise HemmaError(f"{file.path}: expected a header and rows, the file is empty. Check the path")
    line, header = numbered[0]
    _check_header(f"{file.path}, line {line}", header, required, optional)
    for line, row in numbered[1:]:
        if len(row) != len(header):
            surplus = len(row) > len(header) and not any(row[len(header) :])
            raise HemmaError(
                f"{file.path}, line {line}: expected {len(header)} cells as in the header, got {len(row)}. "
                + (
                    "Take the commas at its end out"
                    if surplus
                    else "Separate cells by commas, write numbers with a decimal point"
                )
            )
    return CsvTable(file.path, header, [row for _, row in numbered[1:]], [line for line, _ in numbered[1:]])


def _lines(file: SourceFile) -> Iterator[tuple[int, tuple[str, ...]]]:
    """The number and the cells of each line that is not empty."""
    for line, text in enumerate(LINE_END.split(file.text), 1):
        if text.strip(", \t"):
            yield line, _cells(file.path, line, text)


def _cells(path: Path, line: int, text: str) -> tuple[str, ...]:
    """The cells of a line without the spaces around them; a quoted cell ends in its line."""
    if '"' not in text:
        return tuple(cell.strip() for cell in text.split(","))
    try:
        return tuple(cell.strip() for cell in next(csv.reader([text], strict=True)))
    except csv.Error as error:
        raise HemmaError(
            f"{path}, line {line}: expected quotes in pairs, each cell within its line, got a quote that is "
            f"never closed or stands inside a cell ({error}): {shortened(text)!r}. Take the quotes out"
        ) from error


def _check_header(
    place: str, header: Sequence[str], required: Sequence[str], optional: Sequence[str]
) -> None:
    wanted = f"{place}: expected the columns {','.join(required)}"
    others = [column for column in optional if column and column not in required]
    wanted += f" and perhaps {shortened(','.join(others), LIST)}" if others else ""
    if len(header) == 1 and (";" in header[0] or "\t" in header[0]):
        raise HemmaError(f"{wanted}, separated by commas, got {shortened(header[0])!r}. Save it with commas")
    missing = [column for column in required if column not in header]
    if missing:
        raise HemmaError(
            f"{wanted}; missing: {','.join(missing)}, found: {shortened(','.join(header), LIST)}. Name the "
            "columns so in the first line"
        )
    _check_names(wanted, header, {*required, *optional})
    twice = sorted({column for column in header if column and header.count(column) > 1})
    if twice:
        raise HemmaError(
            f"{wanted} once each; {shortened(','.join(twice), LIST)} stands there twice. Take one out"
        )


def _check_names(wanted: str, header: Sequence[str], known: set[str]) -> None:
    unnamed = [position for position, column in enumerate(header, 1) if not column]
    if unnamed and "" not in known:
        cause = {
            1: " (the row numbers of the program that wrote it?)",
            len(header): " (a comma too many at the end of each line?)",
        }.get(unnamed[0], "")
        raise HemmaError(f"{wanted}; column {unnamed[0]} has no name{cause}. Take it out of every line")
    strange = [column for column in header if column not in known]
    if strange:
        raise HemmaError(
            f"{wanted}; got also {shortened(','.join(strange), LIST)}. Rename them or take them out"
        )


def number(cell: str) -> float:
    """The number in a cell; text counts as infinite, which nobody accepts.

    Python reads more than files hold: 1_0 as ten, and the digits of every script.
    """
    try:
        return float(cell) if cell.isascii() and "_" not in cell else math.inf
    except ValueError:
        return math.inf


def _offset(moment: datetime) -> float:
    offset = moment.utcoffset()
    assert offset is not None
    return offset.total_seconds() / 3600
