"""``transfer.json``: what each method made of each changed home; docs/reward.md explains it."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import hemma
from hemma.evaluation import summarise
from hemma.results.document import CODE, INTERVAL_KIND, bounds, method_document
from hemma.results.found import MethodResults
from hemma.results.reading import write_json
from hemma.settings.experiment import Experiment
from hemma.settings.keys import outside
from hemma.studies.transfer.changes import Place
from hemma.studies.transfer.records import TRANSFER_FILE

SCHEMA = 1
PAIRED = "share_of_savings"
"""Of this metric methods are compared seed by seed: a run's reward and its policy come from one training."""


@dataclass(frozen=True)
class Measured:
    """All methods in one place; the others are compared with the first, a policy from elsewhere."""

    place: Place
    methods: tuple[MethodResults, ...]


def transfer_document(command: str, experiment: Experiment, measured: Sequence[Measured]) -> dict[str, Any]:
    """The whole file."""
    first = measured[0].place.case
    return {
        "schema": SCHEMA,
        "hemma": hemma.__version__,
        "code": CODE,
        "command": command,
        "settings": outside(experiment),
        "interval_kind": INTERVAL_KIND,
        "home": first.name,
        "source": first.traces.source,
        "currency": experiment.currency,
        "days": experiment.demonstration_days,
        "measured": {"start": first.parts.test.time_stamps()[0], "slots": first.test.slots},
        "places": {one.place.change.name: _place(one) for one in measured},
    }


def write_transfer(folder: Path, content: dict[str, Any]) -> None:
    """Write the file, whole or not at all."""
    write_json(folder / TRANSFER_FILE, content)


def _place(one: Measured) -> dict[str, Any]:
    baseline, *others = one.methods
    return {
        "meaning": one.place.change.meaning,
        "learned_from": one.place.case.parts.training.time_stamps()[0],
        "methods": {method.method: method_document(method.runs) for method in one.methods},
        "paired": [_paired(other, baseline) for other in others],
    }


def _paired(method: MethodResults, over: MethodResults) -> dict[str, Any]:
    """How much more of the savings a run of ``method`` keeps than the run of ``over`` with its seed."""
    pairs = zip(_shares(method), _shares(over), strict=True)
    differences = [None if own is None or other is None else own - other for own, other in pairs]
    found = summarise(differences)
    return {
        "method": method.method,
        "over": over.method,
        "metric": PAIRED,
        "differences": differences,
        "mean": found.mean,
        "interval": bounds(found.interval),
    }


def _shares(method: MethodResults) -> list[float | None]:
    return [run.metrics.share_of_savings for run in method.runs]
