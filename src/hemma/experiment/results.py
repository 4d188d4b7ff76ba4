"""``results.json``: everything an experiment found; docs/how-to-run.md explains each entry."""

import json
import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

import hemma
from hemma.checkpoint import write_atomically
from hemma.evaluation import Metrics, summarise
from hemma.experiment.fingerprint import code

SCHEMA = 1
RESULTS_FILE = "results.json"
CODE = code("home", "identification", "expert", "rl", "irl", "baselines", "evaluation")
"""Of all that numbers in the file come from."""


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
    methods: tuple[MethodResults, ...] = ()
    data_efficiency: tuple[MethodResults, ...] = ()
    regret: tuple[MethodRegret, ...] = ()
    pareto: tuple[ParetoPoint, ...] = ()


@dataclass(frozen=True)
class Head:
    """What all homes of a results file share: only results with the same head stand in one file."""

    command: str
    settings: dict[str, Any]


def document(head: Head, homes: dict[str, Any]) -> dict[str, Any]:
    """The whole file."""
    return {
        "schema": SCHEMA,
        "hemma": hemma.__version__,
        "code": CODE,
        "command": head.command,
        "settings": head.settings,
        "homes": homes,
    }


def home_document(home: HomeResults) -> dict[str, Any]:
    """The entry of one home."""
    content: dict[str, Any] = {
        "source": home.source,
        "currency": home.currency,
        "notes": list(home.notes),
        "traces_sha256": home.traces_sha256,
        "slot_length_h": home.slot_length,
        "training": asdict(home.training),
        "test": asdict(home.test),
        "comfort_c": list(home.comfort),
    }
    if home.identification is not None:
        content["identification"] = {
            "rmse_c": {e.horizon: _number(e.error) for e in home.identification.errors},
            "free_run": home.identification.free_run,
            "seconds": _number(home.identification.seconds),
        }
    if home.optimum is not None:
        content["optimum"] = _finite(asdict(home.optimum))
    content["demonstration_days"] = {m.method: m.days for m in home.methods if m.days is not None}
    content["methods"] = {m.method: _method_document(m.runs) for m in home.methods}
    content["data_efficiency"] = [
        {"days": m.days, "method": m.method, **_method_document(m.runs)} for m in home.data_efficiency
    ]
    content["regret"] = {r.method: _regret_document(r) for r in home.regret}
    content["pareto"] = [_finite(asdict(point)) for point in home.pareto]
    return content


def read_document(folder: Path) -> Any:
    """The results file of an earlier run, or None where there is none that can be read."""
    try:
        return json.loads((folder / RESULTS_FILE).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None


def write_document(folder: Path, content: dict[str, Any]) -> None:
    """Write the results file, whole or not at all; NaN is refused, null stands for what is undefined."""
    text = json.dumps(content, indent=1, allow_nan=False, ensure_ascii=False)
    write_atomically(folder / RESULTS_FILE, (text + "\n").encode())


def _method_document(runs: Sequence[Run]) -> dict[str, Any]:
    names = [field.name for field in fields(Metrics)]
    summaries = {name: summarise([getattr(run.metrics, name) for run in runs]) for name in names}
    intervals = {name: summary.interval for name, summary in summaries.items()}
    return {
        "runs": [_run_document(run) for run in runs],
        "mean": {name: summary.mean for name, summary in summaries.items()},
        "interval": {name: None if i is None else [i.low, i.high] for name, i in intervals.items()},
    }


def _run_document(run: Run) -> dict[str, Any]:
    return {
        "seed": run.seed,
        **_finite(asdict(run.metrics)),
        "schedule": run.schedule,
        "curve": run.curve,
    }


def _regret_document(regret: MethodRegret) -> dict[str, Any]:
    return _finite({name: value for name, value in asdict(regret).items() if name != "method"})


def _finite(record: dict[str, Any]) -> dict[str, Any]:
    """The record with null for every number that JSON does not know."""
    return {name: _number(value) if isinstance(value, float) else value for name, value in record.items()}


def _number(value: float | None) -> float | None:
    """JSON knows no NaN and no infinity."""
    return value if value is not None and math.isfinite(value) else None
