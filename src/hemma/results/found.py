"""The records of everything an experiment found."""

from dataclasses import dataclass
from typing import Any

from hemma.evaluation import Metrics

RESULTS_FILE = "results.json"
"""Where they are written; ``hemma.results.document`` says how."""


@dataclass(frozen=True)
class Period:
    """A period of the traces."""

    start: str
    """Start of the first slot, ISO 8601 with offset."""
    slots: int


@dataclass(frozen=True)
class FreeRunError:
    """Root mean square error of free-run predictions over one horizon."""

    horizon: str
    """Such as ``24 h``."""
    error: float
    """[degC]."""


@dataclass(frozen=True)
class Identified:
    """How well the identified network predicts, and how long it took to fit."""

    errors: tuple[FreeRunError, ...]
    free_run: str
    """Path of the free run inside the folder."""
    seconds: float


@dataclass(frozen=True)
class PlainOptimum:
    """Perfect information with the least reachable deviation."""

    energy_cost: float
    mean_temperature_deviation: float
    bound: float
    relative_gap: float


@dataclass(frozen=True)
class Run:
    """One run of a method."""

    seed: int | None
    """None for a method without randomness."""
    metrics: Metrics
    schedule: str
    """Path inside the folder."""
    curve: str | None = None
    """Path of the training curve inside the folder."""


@dataclass(frozen=True)
class MethodResults:
    """All runs of a method."""

    method: str
    runs: tuple[Run, ...]
    days: int | None = None
    """Length of the demonstrations, for methods that learn from some."""


@dataclass(frozen=True)
class MethodRegret:
    """The mean regret of a method over its runs, and where it comes from [currency].

    total = future + thermal_model + policy, as ``hemma.evaluation.regret.RegretSplit`` explains them.
    """

    method: str
    total: float
    future: float
    thermal_model: float
    policy: float


@dataclass(frozen=True)
class JudgedMethod:
    """What a method cost on training days that it had not been fitted to."""

    method: str
    daily_cost: float
    """X1 + X2 at equal comfort [currency/day]."""
    excess: float
    """How much more that is than the least of all methods [currency/day]."""
    standard_error: float
    """Of the excess, over days [currency/day]."""
    mean_temperature_deviation: float
    """[degC]."""


@dataclass(frozen=True)
class Recommendation:
    """The controller that a home should have, by its training days alone."""

    method: str
    days: int
    """How many days it was judged on."""
    judged: tuple[JudgedMethod, ...]
    """All methods that stood for it, the simplest first."""


@dataclass(frozen=True)
class ParetoPoint:
    """One point of a sweep that trades energy cost for comfort; a mean where there are several runs."""

    series: str
    """``optimum``, or the method that was swept."""
    parameter: str
    """What was swept."""
    value: float
    energy_cost: float
    """[currency] over the test period."""
    mean_temperature_deviation: float
    """[degC]."""
    runs: int
    schedules: tuple[str, ...] = ()
    """Paths of the runs' schedules inside the folder; none for a proven optimum."""


@dataclass(frozen=True)
class HomeResults:
    """All that was found about one home; grows stage by stage."""

    name: str
    source: str
    currency: str
    notes: tuple[str, ...]
    traces_sha256: str
    slot_length: float
    """[h]."""
    training: Period
    test: Period
    comfort: tuple[float, float]
    """T^low and T^upp [degC]."""
    identification: Identified | None = None
    optimum: PlainOptimum | None = None
    recommendation: Recommendation | None = None
    methods: tuple[MethodResults, ...] = ()
    data_efficiency: tuple[MethodResults, ...] = ()
    regret: tuple[MethodRegret, ...] = ()
    pareto: tuple[ParetoPoint, ...] = ()


@dataclass(frozen=True)
class Head:
    """What all homes of a results file share: only results with the same head stand in one file."""

    command: str
    settings: dict[str, Any]
