"""The plain records of ``results.json``: runs, methods, periods, and what is known about a home."""

from datetime import datetime
from typing import Annotated

from pydantic import AfterValidator, Field, model_validator

from hemma.evaluation import IntervalKind, Intervals, Measures, Metrics
from hemma.record import Finite, Number, Record

LONGEST = 10_000_000
"""Slots of a period; a century of five minutes."""


class Run(Measures[Number]):
    """One run; a deterministic method has one, without a seed."""

    seed: int | None = None
    schedule: str | None = None
    """Path of its schedule inside the folder."""
    curve: str | None = None
    """Path of its training curve inside the folder; None without training."""


class MethodRuns(Record):
    """All runs of a method on a home."""

    runs: tuple[Run, ...] = Field(min_length=1)
    mean: Metrics
    interval: Intervals = Intervals()
    interval_kind: IntervalKind | None = None
    """How the intervals were found; None where there is a single run."""
    interquartile_mean: Metrics = Metrics()
    """Means of the middle half of the runs, which one run gone astray does not move."""
    worst_seed: int | None = None

    @property
    def is_learned(self) -> bool:
        """Whether it has seeds: whoever trained it might have drawn another one."""
        return self.runs[0].seed is not None

    @property
    def typical_run(self) -> Run:
        """The run of median energy cost (the lower one of two): what the time plots show."""
        priced = [run for run in self.runs if run.energy_cost is not None] or list(self.runs)
        return sorted(priced, key=lambda run: run.energy_cost or 0.0)[(len(priced) - 1) // 2]

    @property
    def worst_run(self) -> Run | None:
        """The run of ``worst_seed``, else the one farthest from the optimum at equal comfort (by cost where
        no gap is defined); None of a single run."""
        if len(self.runs) < 2:
            return None
        named = [run for run in self.runs if run.seed is not None and run.seed == self.worst_seed]
        if named:
            return named[0]
        gaps = [run for run in self.runs if run.gap_to_optimum is not None]
        if gaps:
            return max(gaps, key=lambda run: run.gap_to_optimum or 0.0)
        costs = [run for run in self.runs if run.energy_cost is not None]
        return max(costs, key=lambda run: run.energy_cost or 0.0) if costs else None


class DemonstrationRuns(MethodRuns):
    """A method trained on demonstrations of a certain length."""

    days: Finite = Field(gt=0)
    method: str


def _stamp(text: str) -> str:
    datetime.fromisoformat(text)
    return text


class Period(Record):
    """A period of the traces."""

    start: Annotated[str, AfterValidator(_stamp)]
    """Of the first slot, ISO 8601 with offset."""
    slots: int = Field(ge=1, le=LONGEST)


class Identification(Record):
    """How well the identified network predicts the indoor temperature without correction."""

    rmse_c: dict[str, Number] = Field(default_factory=dict)
    """Root mean square error [degC] by prediction horizon."""
    free_run: str | None = None
    """Path of the free run inside the folder."""
    seconds: Number = None


class OptimumRecord(Record):
    """Perfect information with the least reachable deviation."""

    energy_cost: Number = None
    mean_temperature_deviation: Number = None
    bound: Number = None
    """Proven lower bound of the cost [currency]."""
    relative_gap: Number = None


class JudgedMethod(Record):
    """What a method cost on training days that it had not been fitted to."""

    method: str
    daily_cost: Number = None
    """X1 + X2 at equal comfort [currency/day]."""
    excess: Number = None
    """How much more that is than the least of all methods [currency/day]."""
    standard_error: Number = None
    """Of the excess, over days [currency/day]."""
    mean_temperature_deviation: Number = None
    """[degC]."""


class Recommendation(Record):
    """The controller that a home should have, by its training days alone."""

    method: str
    days: int
    """How many days it was judged on."""
    judged: tuple[JudgedMethod, ...] = Field(min_length=1)
    """All methods that stood for it, the simplest first."""

    @model_validator(mode="after")
    def _require_judged(self) -> "Recommendation":
        if self.method not in [one.method for one in self.judged]:
            raise ValueError("the recommended method should be one of those judged")
        return self
