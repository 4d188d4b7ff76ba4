"""A small CSV file as cells with their line numbers, and its columns as numbers and moments."""

import csv
import math
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
from jaxtyping import Float

from hemma.data.clock import Stamps
from hemma.data.source_file import SourceFile
from hemma.errors import HemmaError

EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
EXAMPLE_STAMP = "2021-08-01T00:00:00-06:00"


@dataclass(frozen=True)
class CsvTable:
    """Rows of text cells. Empty lines are left out."""

    path: Path
    header: tuple[str, ...]
    rows: Sequence[Sequence[str]]
    lines: Sequence[int]
    """Number of the line in the file that each row ends on, counted from 1."""

    def cells(self, column: str) -> list[str]:
        """The cells of a column, without spaces around them."""
        index = self.header.index(column)
        return [row[index].strip() for row in self.rows]

    def numbers(self, column: str) -> Float[np.ndarray, "rows"]:
        """A column as float64, NaN where the cell is empty or ``nan``; other text is refused."""
        values = np.empty(len(self.rows))
        for row, cell in enumerate(self.cells(column)):
            values[row] = _number(cell) if cell else math.nan
            if math.isinf(values[row]):
                raise HemmaError(
                    f"{self.path}, line {self.lines[row]}: expected a finite number (or an empty cell) in "
                    f"{column}, got {cell!r}. Correct the cell, or empty it if the value is not known"
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
        if moment is None or moment.utcoffset() is None or moment.microsecond:
            raise HemmaError(
                f"{self.path}, line {self.lines[row]}: expected a time stamp in whole seconds with its "
                f"offset from UTC, such as {EXAMPLE_STAMP}, got {cell!r}. Write every time stamp so"
            )
        return moment


def read_header(file: SourceFile) -> tuple[str, ...]:
    """The column names in the first line of a file."""
    first = next(csv.reader(file.text.splitlines()[:1]), [])
    return tuple(cell.strip() for cell in first)


def parse_table(file: SourceFile, required: Sequence[str], optional: Sequence[str]) -> CsvTable:
    """The CSV table of a file that holds the ``required`` columns, and of others only ``optional`` ones."""
    reader = csv.reader(file.text.splitlines(keepends=True))
    numbered = [(reader.line_num, row) for row in reader if any(cell.strip() for cell in row)]
    if not numbered:
        raise HemmaError(f"{file.path}: expected a header and rows, the file is empty")
    header = tuple(cell.strip() for cell in numbered[0][1])
    _check_header(file.path, header, required, optional)
    for line, row in numbered[1:]:
        if len(row) != len(header):
            raise HemmaError(
                f"{file.path}, line {line}: expected {len(header)} cells as in the header, got {len(row)}. "
                "Separate cells by commas, write numbers with a decimal point"
            )
    return CsvTable(file.path, header, [row for _, row in numbered[1:]], [line for line, _ in numbered[1:]])


def _check_header(
    path: Path, header: Sequence[str], required: Sequence[str], optional: Sequence[str]
) -> None:
    wanted = f"{path}, line 1: expected the columns {','.join(required)}"
    wanted += f" and perhaps {','.join(optional)}" if optional else ""
    if len(header) == 1 and (";" in header[0] or "\t" in header[0]):
        raise HemmaError(f"{wanted}, separated by commas, got {header[0]!r}. Save it with commas")
    missing = [column for column in required if column not in header]
    if missing:
        raise HemmaError(f"{wanted}; missing: {','.join(missing)}, found: {','.join(header)}")
    strange = [column for column in header if column not in {*required, *optional}]
    if strange:
        raise HemmaError(f"{wanted}; got also {','.join(strange)}. Rename them or take them out")
    if len(set(header)) < len(header):
        twice = sorted({column for column in header if header.count(column) > 1})
        raise HemmaError(f"{wanted} once each; {','.join(twice)} stands there twice")


def _number(cell: str) -> float:
    """The number in a cell; text counts as infinite, which nobody accepts."""
    try:
        return float(cell)
    except ValueError:
        return math.inf


def _offset(moment: datetime) -> float:
    offset = moment.utcoffset()
    assert offset is not None
    return offset.total_seconds() / 3600
