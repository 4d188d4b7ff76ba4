"""``results.json`` as typed values: the border between a results folder and everything drawn from it."""

from pathlib import Path
from typing import Any, Literal

from pydantic import Field

from hemma.errors import HemmaError
from hemma.results.findings import Aggregate, Improvement, ParetoPoint, RegretSplit
from hemma.results.reading import read_record
from hemma.results.records import (
    DemonstrationRuns,
    Identification,
    Method,
    Optimum,
    Period,
    Recommendation,
    Record,
)

RESULTS_FILE = "results.json"


class HomeResults(Record):
    """Everything about one home."""

    currency: str
    slot_length_h: float = Field(gt=0)
    comfort_c: tuple[float, float]
    test: Period
    methods: dict[str, Method]
    """Empty while no method has finished."""
    training: Period | None = None
    source: str = ""
    notes: tuple[str, ...] = ()
    traces_sha256: str = ""
    identification: Identification | None = None
    optimum: Optimum | None = None
    recommendation: Recommendation | None = None
    demonstration_days: dict[str, float] = Field(default_factory=dict)
    data_efficiency: tuple[DemonstrationRuns, ...] = ()
    probability_of_improvement: tuple[Improvement, ...] = ()
    regret: dict[str, RegretSplit] = Field(default_factory=dict)
    """By method."""
    pareto: tuple[ParetoPoint, ...] = ()

    @property
    def test_days(self) -> float:
        """Length of the test period [days]."""
        return self.test.slots * self.slot_length_h / 24


class Results(Record):
    """The whole file."""

    version: Literal[1] = Field(alias="schema")
    hemma: str
    command: str = "hemma reproduce --out results"
    """What was typed to get the folder."""
    settings: dict[str, Any] = Field(default_factory=dict)
    homes: dict[str, HomeResults]
    interval_kind: str = "Student's t"
    """How the 95 % intervals over seeds were computed, in words; folders that do not say used Student's t."""
    aggregate: Aggregate | None = None

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
