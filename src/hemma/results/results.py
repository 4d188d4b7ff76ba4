"""``results.json``: everything an experiment found, as it is written and as it is read."""

from pathlib import Path
from typing import Any, Literal

from pydantic import Field

from hemma.errors import HemmaError
from hemma.evaluation import RegretSplit
from hemma.record import Band, Finite, Record
from hemma.results.findings import Aggregate, ImprovementRecord, ParetoPoint
from hemma.results.reading import read_record
from hemma.results.records import (
    DemonstrationRuns,
    Identification,
    MethodRuns,
    OptimumRecord,
    Period,
    Recommendation,
)

RESULTS_FILE = "results.json"


class HomeResults(Record):
    """Everything about one home; grows stage by stage."""

    source: str = ""
    currency: str
    notes: tuple[str, ...] = ()
    traces_sha256: str = ""
    slot_length_h: float = Field(gt=0, le=24)
    training: Period | None = None
    test: Period
    comfort_c: Band
    """T^low and T^upp."""
    identification: Identification | None = None
    optimum: OptimumRecord | None = None
    recommendation: Recommendation | None = None
    demonstration_days: dict[str, Finite] = Field(default_factory=dict)
    """By method, of those that learn from demonstrations."""
    methods: dict[str, MethodRuns] = Field(default_factory=dict)
    """Empty while no method has finished."""
    data_efficiency: tuple[DemonstrationRuns, ...] = ()
    regret: dict[str, RegretSplit] = Field(default_factory=dict)
    """By method."""
    pareto: tuple[ParetoPoint, ...] = ()
    probability_of_improvement: tuple[ImprovementRecord, ...] = ()

    @property
    def test_days(self) -> float:
        """Length of the test period [days]."""
        return self.test.slots * self.slot_length_h / 24


class Results(Record):
    """The whole file."""

    version: Literal[1] = Field(default=1, alias="schema")
    hemma: str
    code: str = ""
    """SHA-256 of the source that the numbers come from."""
    command: str = "hemma reproduce --out results"
    """What was typed to get the folder."""
    settings: dict[str, Any] = Field(default_factory=dict)
    interval_kind: str = "Student's t"
    """How the 95 % intervals over seeds were computed, in words; folders that do not say used Student's t."""
    homes: dict[str, HomeResults]
    aggregate: Aggregate | None = None
    """Where two homes or more share a method."""

    @property
    def finished(self) -> dict[str, HomeResults]:
        """The homes of which at least one method has finished."""
        return {name: home for name, home in self.homes.items() if home.methods}

    @property
    def unfinished(self) -> list[str]:
        """The homes that have nothing to show yet."""
        return [name for name, home in self.homes.items() if not home.methods]


def load_results(folder: Path) -> Results:
    """Read ``results.json`` of a results folder; a ``HemmaError`` names the file and what is wrong in it."""
    path, expected = folder / RESULTS_FILE, "the results that `hemma reproduce` writes (schema 1)"
    results = read_record(path, Results, expected, "hemma reproduce")
    if not results.finished:
        raise HemmaError(
            f"{path}: expected {expected}, no method has finished in it yet. Let `hemma reproduce` go on"
        )
    return results
