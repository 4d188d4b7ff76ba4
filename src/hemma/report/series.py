"""The CSV files of a results folder as arrays: schedules, exogenous series, training curves, free runs."""

from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float, Shaped

from hemma.errors import HemmaError


@dataclass(frozen=True)
class Clock:
    """Local time at a fixed offset from UTC, that of the first time stamp: it never jumps back."""

    start: Shaped[np.ndarray, "slots"]
    """Start of each slot, datetime64 in local time."""
    offset: str
    """Such as ``UTC-06:00``."""

    def fence_posts(self, slots: int) -> Shaped[np.ndarray, "posts"]:
        """The first ``slots`` starts and the end of the last of them."""
        begin = self.start[: slots + 1]
        if len(begin) > slots:
            return begin
        return np.append(begin, begin[-1] + (begin[-1] - begin[-2] if len(begin) > 1 else 0))


@dataclass(frozen=True)
class ExogenousSeries:
    """What the home did not decide in the test period."""

    clock: Clock
    pv_generation: Float[np.ndarray, "slots"]
    """[kW]."""
    load: Float[np.ndarray, "slots"]
    """[kW]."""
    buying_price: Float[np.ndarray, "slots"]
    """[currency/kWh]."""


@dataclass(frozen=True)
class ScheduleSeries:
    """What a controller did; energy and temperature at the end of each slot."""

    battery_energy: Float[np.ndarray, "slots"]
    """[kWh]."""
    indoor_temperature: Float[np.ndarray, "slots"]
    """[degC]."""
    grid_power: Float[np.ndarray, "slots"]
    """[kW], buying positive."""


@dataclass(frozen=True)
class FreeRun:
    """The network predicting on its own, beside what was measured, at the start of each slot."""

    clock: Clock
    measured: Float[np.ndarray, "slots"]
    """[degC]."""
    predicted: Float[np.ndarray, "slots"]
    """[degC]."""


@dataclass(frozen=True)
class TrainingCurve:
    """One training run; which quantities it has depends on the method."""

    iteration: Float[np.ndarray, "rows"]
    quantities: dict[str, Float[np.ndarray, "rows"]]
    """All other columns of the file, by their names."""

    @property
    def share(self) -> Float[np.ndarray, "rows"]:
        """How much of the training was over, as a fraction."""
        return self.iteration / max(1.0, float(self.iteration[-1]))


class SeriesReader:
    """Reads the CSV files of one results folder, and nothing outside it."""

    def __init__(self, folder: Path):
        """``folder`` is the results folder."""
        self.folder = folder

    def located(self, name: str) -> Path:
        """The file that ``results.json`` calls ``name``; it must lie in the folder and exist."""
        path = self.folder / name
        if not path.resolve().is_relative_to(self.folder.resolve()):
            raise HemmaError(f"{path}: expected a file inside {self.folder}; results.json names one outside")
        if not path.is_file():
            raise HemmaError(
                f"{path}: results.json names this file, it is missing. Run `hemma reproduce` again"
            )
        return path

    def exogenous(self, home: str, slots: int) -> ExogenousSeries:
        """The exogenous series of a home's test period of ``slots`` slots."""
        path = self.located(f"schedules/{home}/exogenous.csv")
        table = _table(path, ("time", "pv_kw", "load_kw", "buy_per_kwh"))
        _require_rows(path, table, slots)
        return ExogenousSeries(
            clock=_clock(path, table),
            pv_generation=_numbers(path, table, "pv_kw"),
            load=_numbers(path, table, "load_kw"),
            buying_price=_numbers(path, table, "buy_per_kwh"),
        )

    def schedule(self, name: str, slots: int) -> ScheduleSeries:
        """A schedule of ``slots`` slots."""
        path = self.located(name)
        table = _table(path, ("time", "battery_kwh", "indoor_c", "grid_kw"))
        _require_rows(path, table, slots)
        return ScheduleSeries(
            battery_energy=_numbers(path, table, "battery_kwh"),
            indoor_temperature=_numbers(path, table, "indoor_c"),
            grid_power=_numbers(path, table, "grid_kw"),
        )

    def free_run(self, name: str) -> FreeRun:
        """A free run of the identified network."""
        path = self.located(name)
        table = _table(path, ("time", "measured_c", "predicted_c"))
        return FreeRun(
            clock=_clock(path, table),
            measured=_numbers(path, table, "measured_c"),
            predicted=_numbers(path, table, "predicted_c"),
        )

    def curve(self, name: str) -> TrainingCurve:
        """The training curve of one run."""
        path = self.located(name)
        table = _table(path, ("iteration",))
        if table.empty:
            raise HemmaError(
                f"{path}: expected a row a chunk of iterations, found none. Run the training again"
            )
        return TrainingCurve(
            iteration=_numbers(path, table, "iteration"),
            quantities={
                str(column): _numbers(path, table, str(column))
                for column in table.columns
                if column != "iteration"
            },
        )


def _table(path: Path, columns: tuple[str, ...]) -> pd.DataFrame:
    try:
        table = pd.read_csv(path)
    except (OSError, ValueError) as error:
        raise HemmaError(f"{path}: expected a CSV file with {','.join(columns)}: {error}") from error
    missing = [column for column in columns if column not in table.columns]
    if missing:
        found = ",".join(str(column) for column in table.columns)
        raise HemmaError(
            f"{path}: expected the columns {','.join(columns)}, {','.join(missing)} is missing from {found}. "
            "Run `hemma reproduce` again"
        )
    return table


def _require_rows(path: Path, table: pd.DataFrame, slots: int) -> None:
    if len(table) != slots:
        raise HemmaError(
            f"{path}: expected {slots} rows, one a slot of the test period, found {len(table)}. "
            "The folder mixes two experiments: run `hemma reproduce` again"
        )


def _numbers(path: Path, table: pd.DataFrame, column: str) -> np.ndarray:
    try:
        return table[column].to_numpy(float)
    except ValueError as error:
        raise HemmaError(f"{path}: expected numbers in the column {column}: {error}") from error


def _clock(path: Path, table: pd.DataFrame) -> Clock:
    try:
        moments = pd.to_datetime(table["time"], format="ISO8601", utc=True)
        offset = datetime.fromisoformat(str(table["time"].iloc[0])).utcoffset()
    except (ValueError, IndexError) as error:
        raise HemmaError(f"{path}: expected ISO 8601 time stamps in the column time: {error}") from error
    if offset is None:
        raise HemmaError(
            f"{path}: expected time stamps with an offset such as 2021-08-01T00:00:00-06:00, "
            f"found {table['time'].iloc[0]}"
        )
    minutes = round(offset.total_seconds() / 60)
    sign = "−" if minutes < 0 else "+"
    name = f"UTC{sign}{abs(minutes) // 60:02d}:{abs(minutes) % 60:02d}"
    return Clock((moments + offset).dt.tz_localize(None).to_numpy(), name)
