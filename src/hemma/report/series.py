"""The CSV files of a results folder as arrays: schedules, exogenous series, training curves, free runs."""

from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float, Shaped

from hemma.errors import HemmaError

WHOLE = slice(None)


@dataclass(frozen=True)
class LocalTime:
    """Local time at a fixed offset from UTC, that of the first time stamp: it never jumps back."""

    start: Shaped[np.ndarray, "slots"]
    """Start of each slot, datetime64 in local time."""
    offset: str
    """Such as ``UTC-06:00``."""

    def fence_posts(self, slots: int, first: int = 0) -> Shaped[np.ndarray, "posts"]:
        """The starts of ``slots`` slots from the ``first`` on, and the end of the last of them."""
        begin = self.start[first : first + slots + 1]
        if len(begin) > slots:
            return begin
        return np.append(begin, begin[-1] + (begin[-1] - begin[-2] if len(begin) > 1 else 0))


@dataclass(frozen=True)
class ExogenousSeries:
    """What the home did not decide in some slots of the test period."""

    clock: LocalTime
    """Of the whole period."""
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

    clock: LocalTime
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

    def exogenous(self, home: str, slots: int, part: slice = WHOLE) -> ExogenousSeries:
        """A part of the exogenous series of a home's test period of ``slots`` slots."""
        columns = ("pv_kw", "load_kw", "buy_per_kwh")
        table = self._table(f"schedules/{home}/exogenous.csv", "time", *columns)
        return ExogenousSeries(table.clock(), *table.of_slots(slots, part, *columns))

    def schedule(self, name: str, slots: int, part: slice = WHOLE) -> ScheduleSeries:
        """A part of a schedule of ``slots`` slots."""
        columns = ("battery_kwh", "indoor_c", "grid_kw")
        return ScheduleSeries(*self._table(name, "time", *columns).of_slots(slots, part, *columns))

    def free_run(self, name: str) -> FreeRun:
        """A free run of the identified network."""
        table = self._table(name, "time", "measured_c", "predicted_c")
        return FreeRun(table.clock(), table.numbers("measured_c"), table.numbers("predicted_c"))

    def curve(self, name: str) -> TrainingCurve:
        """The training curve of one run."""
        table = self._table(name, "iteration")
        if table.content.empty:
            raise HemmaError(
                f"{table.path}: expected a row a chunk of iterations, found none. Run the training again"
            )
        others = [str(column) for column in table.content.columns if column != "iteration"]
        quantities = {column: table.numbers(column) for column in others}
        return TrainingCurve(table.numbers("iteration"), quantities)

    def _table(self, name: str, *columns: str) -> "_Table":
        path = self.located(name)
        try:
            content = pd.read_csv(path)
        except (OSError, ValueError) as error:
            raise HemmaError(f"{path}: expected a CSV file with {','.join(columns)}: {error}") from error
        missing = [column for column in columns if column not in content.columns]
        if missing:
            found = ",".join(str(column) for column in content.columns)
            raise HemmaError(
                f"{path}: expected the columns {','.join(columns)}, {','.join(missing)} is missing from "
                f"{found}. Run `hemma reproduce` again"
            )
        return _Table(path, content)


@dataclass(frozen=True)
class _Table:
    path: Path
    content: pd.DataFrame

    def numbers(self, column: str) -> np.ndarray:
        try:
            return self.content[column].to_numpy(float)
        except ValueError as error:
            raise HemmaError(f"{self.path}: expected numbers in the column {column}: {error}") from error

    def of_slots(self, slots: int, part: slice, *columns: str) -> list[np.ndarray]:
        if len(self.content) != slots:
            raise HemmaError(
                f"{self.path}: expected {slots} rows, one a slot of the test period, found "
                f"{len(self.content)}. The folder mixes two experiments: run `hemma reproduce` again"
            )
        return [self.numbers(column)[part] for column in columns]

    def clock(self) -> LocalTime:
        path, column = self.path, self.content["time"]
        try:
            moments = pd.to_datetime(column, format="ISO8601", utc=True)
            first = datetime.fromisoformat(str(column.iloc[0]))
        except (ValueError, IndexError) as error:
            raise HemmaError(f"{path}: expected ISO 8601 time stamps in the column time: {error}") from error
        if first.tzinfo is None:
            raise HemmaError(
                f"{path}: expected time stamps with an offset such as 2021-08-01T00:00:00-06:00, "
                f"found {column.iloc[0]}"
            )
        offset = first.isoformat(timespec="minutes").removeprefix(f"{first:%Y-%m-%dT%H:%M}")
        local = (moments + first.utcoffset()).dt.tz_localize(None)
        return LocalTime(local.to_numpy(), f"UTC{offset.replace('-', '−')}")
