"""Schedules on disk: enough for anyone to recompute every metric with a spreadsheet."""

import csv
import io
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from hemma.checkpoint import write_atomically
from hemma.evaluation.replay import Outcome
from hemma.types import Exogenous

SCHEDULE_COLUMNS = ("time", "battery_kw", "hvac_kw", "battery_kwh", "indoor_c", "grid_kw", "cost")
EXOGENOUS_COLUMNS = ("time", "pv_kw", "load_kw", "outdoor_c", "buy_per_kwh", "sell_per_kwh")


def write_schedule(path: Path, time: Sequence[str], outcome: Outcome) -> None:
    """Write one row a slot, every number with all its digits; ``time`` holds the start of each slot."""
    columns = (
        outcome.battery_power,
        outcome.hvac_power,
        outcome.battery_energy,
        outcome.indoor_temperature,
        outcome.grid_power,
        outcome.cost,
    )
    _write(path, SCHEDULE_COLUMNS, time, columns)


def write_exogenous(path: Path, time: Sequence[str], exogenous: Exogenous) -> None:
    """Write what the home did not decide, in the columns of the canonical trace file."""
    columns = (
        exogenous.pv_generation,
        exogenous.load,
        exogenous.outdoor_temperature,
        exogenous.buying_price,
        exogenous.selling_price,
    )
    _write(path, EXOGENOUS_COLUMNS, time, columns)


def _write(path: Path, header: Sequence[str], time: Sequence[str], columns: Sequence) -> None:
    if any(len(column) != len(time) for column in columns):
        raise ValueError(f"{path}: {len(time)} time stamps, columns of {[len(column) for column in columns]}")
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(header)
    numbers = np.column_stack([np.asarray(column, float) for column in columns]).tolist()
    writer.writerows([stamp, *row] for stamp, row in zip(time, numbers, strict=True))
    write_atomically(path, text.getvalue().encode())
