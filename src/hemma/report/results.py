"""``results.json`` as typed values: the border between a results folder and everything drawn from it."""

import json
import math
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError

from hemma.errors import HemmaError

RESULTS_FILE = "results.json"


def _finite_or_none(value: Any) -> Any:
    """JSON has no NaN: a metric that is undefined comes as null, as NaN or as an infinity."""
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _both_or_none(value: Any) -> Any:
    if isinstance(value, list) and any(_finite_or_none(bound) is None for bound in value):
        return None
    return value


Number = Annotated[float | None, BeforeValidator(_finite_or_none)]
"""A metric, or None where it is undefined."""
Range = Annotated[tuple[float, float] | None, BeforeValidator(_both_or_none)]
"""Low and high end of a 95 % interval, or None where there is none."""


class Record(BaseModel):
    """What all parts of the file share: frozen, and unknown keys of later versions are left alone."""

    model_config = ConfigDict(frozen=True, extra="ignore")


class Metrics(Record):
    """The metrics of one run, or their means over the runs of a method."""

    energy_cost: Number = None
    """Sum of X1 + X2 over the test period [currency]."""
    transaction_cost: Number = None
    """Sum of X1 [currency]."""
    battery_cost: Number = None
    """Sum of X2 [currency]."""
    mean_temperature_deviation: Number = None
    """Mean of X3 [degC]."""
    total_temperature_deviation: Number = None
    """Sum of X3 [degC]."""
    gap_to_optimum: Number = None
    """Distance to the optimum at equal comfort, a fraction."""
    share_of_savings: Number = None
    """Part of the possible savings that was kept, at equal comfort, a fraction."""
    seconds_to_train: Number = None
    """Training time [s]."""


class Intervals(Record):
    """The 95 % intervals of the means, by the names of the metrics."""

    energy_cost: Range = None
    transaction_cost: Range = None
    battery_cost: Range = None
    mean_temperature_deviation: Range = None
    total_temperature_deviation: Range = None
    gap_to_optimum: Range = None
    share_of_savings: Range = None
    seconds_to_train: Range = None


class Run(Metrics):
    """One run; a deterministic method has one, without a seed."""

    seed: int | None = None
    schedule: str | None = None
    """Path of its schedule inside the folder."""
    curve: str | None = None
    """Path of its training curve inside the folder; None without training."""


class Method(Record):
    """All runs of a method on a home."""

    runs: tuple[Run, ...] = Field(min_length=1)
    mean: Metrics
    interval: Intervals = Intervals()

    @property
    def typical_run(self) -> Run:
        """The run of median energy cost (the lower one of two): what the time plots show."""
        priced = [run for run in self.runs if run.energy_cost is not None] or list(self.runs)
        return sorted(priced, key=lambda run: run.energy_cost or 0.0)[(len(priced) - 1) // 2]


class DemonstrationRuns(Method):
    """A method trained on demonstrations of a certain length."""

    days: float
    method: str


class Period(Record):
    """A period of the traces."""

    start: str
    slots: int


class Identification(Record):
    """How well the identified network predicts the indoor temperature without correction."""

    rmse_c: dict[str, Number] = {}
    """Root mean square error [degC] by prediction horizon."""
    free_run: str | None = None
    """Path of the free run inside the folder."""
    seconds: Number = None


class Optimum(Record):
    """Perfect information with the least reachable deviation."""

    energy_cost: Number = None
    mean_temperature_deviation: Number = None
    bound: Number = None
    """Proven lower bound of the cost [currency]."""
    relative_gap: Number = None


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
    demonstration_days: dict[str, float] = {}
    data_efficiency: tuple[DemonstrationRuns, ...] = ()

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
    settings: dict[str, Any] = {}
    homes: dict[str, HomeResults]

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
    path = folder / RESULTS_FILE
    expected = f"{path}: expected the results that `hemma reproduce` writes (schema 1)"
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError as error:
        raise HemmaError(f"{expected}, there is no such file. Run `hemma reproduce` first") from error
    except (OSError, ValueError) as error:
        raise HemmaError(f"{expected}, cannot read it: {error}") from error
    try:
        results = Results.model_validate(content)
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(str(part) for part in first["loc"]) or "the file"
        raise HemmaError(
            f"{expected}; {place}: {first['msg']}, found {str(first['input'])[:60]}. "
            "Correct it, or run `hemma reproduce` again"
        ) from error
    if not results.finished:
        raise HemmaError(f"{expected}, no method has finished in it yet. Let `hemma reproduce` go on")
    return results
