"""``robustness.json``: what the faults do to each method, as it is written and as it is read."""

from pathlib import Path
from typing import Generic, TypeVar

from pydantic import Field

from hemma.evaluation import Measures
from hemma.record import Number, Range, Record
from hemma.results.reading import read_record
from hemma.results.records import Period
from hemma.studies.study_file import StudyFile

ROBUSTNESS_FILE = "robustness.json"


Value = TypeVar("Value")


class FaultMeasures(Measures[Value], Generic[Value]):
    """The metrics of the results table, and the largest deviation."""

    max_temperature_deviation: Value | None = None
    """[degC]."""


class FaultRun(FaultMeasures[Number]):
    """One run of a method under one fault; perfect information is that of the same changed home."""

    seed: int | None = None
    limited: int | None = None
    """Slots in which the safety layer limited an action; None for planners, which it does not watch."""
    comfort_overrides: int | None = None
    """Slots in which it took the HVAC over."""


class FaultMethod(Record):
    """A method under one fault."""

    runs: tuple[FaultRun, ...] = Field(min_length=1)
    mean: FaultMeasures[Number]
    interval: FaultMeasures[Range] = FaultMeasures[Range]()

    @property
    def interventions(self) -> float | None:
        """Slots in which the safety layer changed something, mean of the runs; None if it did not watch."""
        if any(run.limited is None or run.comfort_overrides is None for run in self.runs):
            return None
        counts = [(run.limited or 0) + (run.comfort_overrides or 0) for run in self.runs]
        return sum(counts) / len(counts)


class MetFault(Record):
    """All methods under one fault."""

    fault: str
    meaning: str
    repaired_readings: int
    """Slots in which a reading was missing and the last one was taken."""
    methods: dict[str, FaultMethod]


class RobustHome(Record):
    """All faults in one home."""

    traces_sha256: str = ""
    currency: str
    test: Period
    faults: tuple[MetFault, ...] = Field(min_length=1)


class Robustness(StudyFile):
    """The whole file."""

    command: str = "hemma robustness"
    seed_of_faults: int = 0
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
