"""The canonical trace file: CSV, one row a slot, start of slot, ISO 8601 with offset."""

import gzip
from pathlib import Path

import numpy as np
from jaxtyping import Float

from hemma.checkpoint import write_atomically
from hemma.data.clock import regular_clock
from hemma.data.columns import OPTIONAL, REQUIRED, Columns
from hemma.data.csv_table import CsvTable, parse_table
from hemma.data.source_file import read_source, stem
from hemma.data.traces import Traces
from hemma.data.validation import Log, Repairs, validated
from hemma.errors import HemmaError


def read_canonical(
    path: str | Path, *, selling_ratio: float = 0.9, name: str | None = None, longest_gap: float = 1.0
) -> Traces:
    """Read a canonical trace file, ``.csv`` or ``.csv.gz``.

    ``selling_ratio`` stands in for a missing ``sell_per_kwh``. Holes of at most ``longest_gap`` [h] are
    interpolated (prices hold the value before); that and every other repair stands in the ``notes`` of the
    traces. Any slot length that divides a day; two offsets (daylight saving) are accepted. Errors: HemmaError
    with file, line, column, time and cure.
    """
    file = read_source(Path(path))
    table = parse_table(file, ("time", *REQUIRED), OPTIONAL)
    placement = regular_clock(table.stamps("time"), str(path))
    series = {column: placement.placed(_known(table, column)) for column in table.header if column != "time"}
    log = Log(
        name=name or stem(file.path),
        file=str(path),
        columns=Columns(placement.clock, series),
        sha256=file.sha256,
        source=f"Traces of the file {file.path.name}, as its owner recorded them.",
    )
    return validated(log, Repairs(longest_gap=longest_gap, selling_ratio=selling_ratio))


def _known(table: CsvTable, column: str) -> Float[np.ndarray, "rows"]:
    """A column of numbers, at least one."""
    values = table.numbers(column)
    if not np.isfinite(values).any():
        cure = "take the column out" if column in OPTIONAL else "fill it (a home without PV has 0 in pv_kw)"
        raise HemmaError(
            f"{table.path}, line {table.lines[0]}: expected numbers in {column}, got none in any of the "
            f"{len(values)} rows: {column} is empty: {cure}"
        )
    return values


def write_canonical(traces: Traces, path: str | Path) -> None:
    """Write a canonical trace file, ``.csv`` or ``.csv.gz``; ``read_canonical`` reads the same back."""
    path, content = Path(path), canonical_text(traces).encode()
    if not path.name.endswith((".csv", ".csv.gz")):
        raise HemmaError(f"{path}: expected a file name that ends in .csv or .csv.gz. Rename it")
    write_atomically(path, gzip.compress(content, mtime=0) if path.suffix == ".gz" else content)


def canonical_text(traces: Traces) -> str:
    """The canonical CSV text of traces; numbers in the shortest form that reads back to the same float64."""
    exogenous = traces.exogenous
    columns = {
        "pv_kw": exogenous.pv_generation,
        "load_kw": exogenous.load,
        "outdoor_c": exogenous.outdoor_temperature,
        "buy_per_kwh": exogenous.buying_price,
        "sell_per_kwh": exogenous.selling_price,
        "indoor_c": traces.indoor_temperature,
        "hvac_kw": traces.hvac_power,
    }
    present = {name: np.asarray(series) for name, series in columns.items() if series is not None}
    cells = [traces.time_stamps(), *([repr(x) for x in series.tolist()] for series in present.values())]
    header = ",".join(["time", *present])
    return "\n".join([header, *(",".join(row) for row in zip(*cells, strict=True))]) + "\n"
