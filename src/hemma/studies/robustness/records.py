"""``robustness.json`` as typed values."""

from pathlib import Path
from typing import Literal

from pydantic import Field

from hemma.results.reading import read_record
from hemma.results.records import Number, Period, Range, Record

ROBUSTNESS_FILE = "robustness.json"


class FaultRun(Record):
    """One run of a method under one fault."""

    seed: int | None = None
    share_of_savings: Number = None
    mean_temperature_deviation: Number = None
    max_temperature_deviation: Number = None
    limited: int | None = None
    comfort_overrides: int | None = None


class Means(Record):
    """Over the runs of a method."""

    energy_cost: Number = None
    mean_temperature_deviation: Number = None
    max_temperature_deviation: Number = None
    share_of_savings: Number = None
    regret: Number = None


class Ranges(Record):
    """The 95 % intervals of the means."""

    share_of_savings: Range = None
    mean_temperature_deviation: Range = None


class FaultMethod(Record):
    """A method under one fault."""

    runs: tuple[FaultRun, ...] = Field(min_length=1)
    mean: Means
    interval: Ranges = Ranges()

    @property
    def interventions(self) -> float | None:
        """Slots in which the safety layer changed something, mean of the runs; None if it did not watch."""
        if any(run.limited is None or run.comfort_overrides is None for run in self.runs):
            return None
        counts = [(run.limited or 0) + (run.comfort_overrides or 0) for run in self.runs]
        return sum(counts) / len(counts)


class FaultTable(Record):
    """All methods under one fault."""

    fault: str
    meaning: str
    repaired_readings: int
    methods: dict[str, FaultMethod]


class RobustHome(Record):
    """All faults in one home."""

    currency: str
    test: Period
    faults: tuple[FaultTable, ...] = Field(min_length=1)


class Robustness(Record):
    """The whole file."""

    version: Literal[1] = Field(alias="schema")
    homes: dict[str, RobustHome] = Field(min_length=1)

    @property
    def methods(self) -> list[str]:
        """All methods, in the order in which they came."""
        tables = [table for home in self.homes.values() for table in home.faults]
        return list(dict.fromkeys(name for table in tables for name in table.methods))

    @property
    def faults(self) -> list[str]:
        """All faults, in their order."""
        return list(dict.fromkeys(table.fault for home in self.homes.values() for table in home.faults))


def load_robustness(folder: Path) -> Robustness:
    """Read the file of a folder; a ``HemmaError`` names what is wrong in it."""
    expected = "what `hemma robustness` writes (schema 1)"
    return read_record(folder / ROBUSTNESS_FILE, Robustness, expected, "hemma robustness")
