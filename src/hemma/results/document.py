"""``results.json``: everything an experiment found; docs/how-to-run.md explains each entry."""

import json
import math
from collections.abc import Sequence
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any

import hemma
from hemma.evaluation import Interval, Metrics, interval_kind, summarise
from hemma.results.comparisons import COMPARED, aggregate, improvements
from hemma.results.fingerprint import code
from hemma.results.found import RESULTS_FILE, Head, HomeResults, Identified, MethodRegret, Run

SCHEMA = 1
CODE = code("home", "identification", "optimisation", "rl", "irl", "forecasting", "control", "evaluation")
"""Of all that numbers in the file come from."""
INTERVAL_KIND = "Student's t below 10 runs, bootstrap from 10 runs on"
"""In words, for readers; each method says which of the two it has."""


def document(head: Head, homes: dict[str, Any]) -> dict[str, Any]:
    """The whole file: the homes' entries, and what their runs say about each other.

    Top-level keys: ``schema``, ``hemma`` (version), ``code``, ``command``, ``settings``, ``interval_kind``
    (words), ``homes``, and ``aggregate`` where two homes or more share a method. Every home has
    ``probability_of_improvement``: for each pair of its methods ``method``, ``over``, ``probability`` and
    ``interval``, by regret. ``aggregate`` has

    - ``homes``: their names;
    - ``methods``: by name, ``interval_kind`` and, for ``share_of_savings``, ``gap_to_optimum``,
      ``mean_temperature_deviation`` and ``regret`` each, ``mean``, ``interval`` (other seeds, the same
      homes), ``interval_over_homes`` (other homes and seeds), ``interquartile_mean`` and ``worst`` (run);
    - ``probability_of_improvement``: the mean of that of the homes;
    - ``paired``: for each pair of methods, ``differences`` of ``metric`` by home, their ``mean``, and its
      ``interval`` over homes.
    """
    compared = {
        name: {**home, "probability_of_improvement": improvements([home])} for name, home in homes.items()
    }
    content = {
        "schema": SCHEMA,
        "hemma": hemma.__version__,
        "code": CODE,
        "command": head.command,
        "settings": head.settings,
        "interval_kind": INTERVAL_KIND,
        "homes": compared,
    }
    over_homes = aggregate(homes)
    return content if over_homes is None else {**content, "aggregate": over_homes}


def home_document(home: HomeResults) -> dict[str, Any]:
    """The entry of one home, without comparisons of its methods."""
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
        content["identification"] = _identification_document(home.identification)
    if home.optimum is not None:
        content["optimum"] = _finite(asdict(home.optimum))
    if home.recommendation is not None:
        content["recommendation"] = asdict(home.recommendation)
        content["recommendation"]["judged"] = [_finite(asdict(one)) for one in home.recommendation.judged]
    content["demonstration_days"] = {m.method: m.days for m in home.methods if m.days is not None}
    content["methods"] = {m.method: method_document(m.runs) for m in home.methods}
    content["data_efficiency"] = [
        {"days": m.days, "method": m.method, **method_document(m.runs)} for m in home.data_efficiency
    ]
    content["regret"] = {r.method: _regret_document(r) for r in home.regret}
    content["pareto"] = [{**_finite(asdict(p)), "schedules": list(p.schedules)} for p in home.pareto]
    return content


def read_document(folder: Path) -> Any:
    """The results file of an earlier run, or None where there is none that can be read."""
    try:
        return json.loads((folder / RESULTS_FILE).read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return None


def _identification_document(identified: Identified) -> dict[str, Any]:
    return {
        "rmse_c": {e.horizon: _number(e.error) for e in identified.errors},
        "free_run": identified.free_run,
        "seconds": _number(identified.seconds),
    }


def method_document(runs: Sequence[Run]) -> dict[str, Any]:
    """The entry of a method: its runs, and what they say together."""
    names = [field.name for field in fields(Metrics)]
    summaries = {name: summarise([getattr(run.metrics, name) for run in runs]) for name in names}
    return {
        "runs": [_run_document(run) for run in runs],
        "mean": {name: summary.mean for name, summary in summaries.items()},
        "interval": {name: bounds(summary.interval) for name, summary in summaries.items()},
        "interval_kind": interval_kind([len(runs)]),
        "interquartile_mean": {name: summary.interquartile_mean for name, summary in summaries.items()},
        "worst_seed": _worst_seed(runs),
    }


def _worst_seed(runs: Sequence[Run]) -> int | None:
    """The seed of the run with the largest regret; None without seeds, or where a run's regret is missing."""
    regrets = [getattr(run.metrics, COMPARED) for run in runs]
    if any(_number(regret) is None for regret in regrets):
        return None
    return runs[regrets.index(max(regrets))].seed


def _run_document(run: Run) -> dict[str, Any]:
    return {
        "seed": run.seed,
        **_finite(asdict(run.metrics)),
        "schedule": run.schedule,
        "curve": run.curve,
    }


def _regret_document(regret: MethodRegret) -> dict[str, Any]:
    return _finite({name: value for name, value in asdict(regret).items() if name != "method"})


def bounds(interval: Interval | None) -> list[float] | None:
    """Low and high, or null where there is no interval."""
    return None if interval is None else [interval.low, interval.high]


def _finite(record: dict[str, Any]) -> dict[str, Any]:
    """The record with null for every number that JSON does not know."""
    return {name: _number(value) if isinstance(value, float) else value for name, value in record.items()}


def _number(value: float | None) -> float | None:
    """JSON knows no NaN and no infinity."""
    return value if value is not None and math.isfinite(value) else None
