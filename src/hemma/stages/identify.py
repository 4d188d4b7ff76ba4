"""Stage: identify the building with a physically consistent neural network."""

import csv
import io
import time
from dataclasses import dataclass
from typing import Any

import jax
import numpy as np

from hemma.checkpoint import write_atomically
from hemma.errors import HemmaError
from hemma.identification.excitation import excite
from hemma.identification.fit import fit
from hemma.identification.pcnn import PhysicallyConsistentNetwork
from hemma.identification.record import ThermalRecord
from hemma.identification.store import load_model, save_model
from hemma.identification.validation import FreeRunErrors, free_run, free_run_errors
from hemma.results.fingerprint import code, fingerprint
from hemma.results.records import Identification
from hemma.results.store import Store
from hemma.stages.case import Case

STAGE = "identify"
PRODUCT, NETWORK = "network", "network.safetensors"
SEED = 0
"""Of the excitation and of the fit."""


@dataclass(frozen=True)
class IdentifiedBuilding:
    """The product of the stage."""

    model: PhysicallyConsistentNetwork
    found: Identification
    mark: str


def identify(case: Case, store: Store) -> IdentifiedBuilding:
    """Fit the network to a simulated, excited training period; measure it free-running in the test period."""
    settings = case.experiment.identification
    mark = fingerprint(STAGE, code("identification"), case.mark, case.experiment.excitation, settings)
    content = store.product(PRODUCT, mark, lambda: _fit(case, store), STAGE)
    return IdentifiedBuilding(load_model(store.folder / store.model(NETWORK)), _found(content, store), mark)


def identified(store: Store) -> IdentifiedBuilding:
    """The product of an earlier run as it lies in the folder, whatever settings or version made it."""
    mark = store.mark_of(PRODUCT)
    content = None if mark is None else store.kept(PRODUCT, mark)
    if mark is None or content is None:
        raise HemmaError(
            f"{store.folder / store.model(NETWORK)}: expected the network that `hemma reproduce` identifies, "
            "it is missing or was changed. Run `hemma reproduce` into this folder"
        )
    return IdentifiedBuilding(load_model(store.folder / store.model(NETWORK)), _found(content, store), mark)


def _fit(case: Case, store: Store) -> tuple[dict[str, Any], list[str]]:
    settings, excitation = case.experiment.identification, case.experiment.excitation
    store.progress.started(STAGE, settings.updates)
    begun = time.monotonic()
    training_key, test_key, fit_key = jax.random.split(jax.random.key(SEED), 3)
    record = excite(case.home, case.training, excitation, training_key)
    fitted = fit(
        record, settings, fit_key, on_progress=lambda done, _: store.progress.advanced(STAGE, done, "")
    )
    test = excite(case.home, case.test, excitation, test_key)
    errors = free_run_errors(fitted.model, test)
    _write_free_run(case, store, fitted.model, test)
    save_model(store.folder / store.model(NETWORK), fitted, SEED)
    errors = [[horizon, float(error)] for horizon, error in _horizons(errors)]
    message = "free-run error " + ", ".join(
        f"{error:.2g} °C after {horizon}" for horizon, error in errors[:3]
    )
    store.progress.finished(STAGE, message)
    content = {"seconds": time.monotonic() - begun, "errors": errors, "message": message}
    return content, [store.model(NETWORK), store.free_run]


def _horizons(errors: FreeRunErrors) -> list[tuple[str, float]]:
    return [
        ("1 h", errors.one_hour),
        ("6 h", errors.six_hours),
        ("24 h", errors.day),
        ("whole period", errors.month),
    ]


def _found(content: dict[str, Any], store: Store) -> Identification:
    return Identification(rmse_c=dict(content["errors"]), free_run=store.free_run, seconds=content["seconds"])


def _write_free_run(
    case: Case, store: Store, model: PhysicallyConsistentNetwork, record: ThermalRecord
) -> None:
    """One row a slot, temperatures at its start."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(("time", "measured_c", "predicted_c", "outdoor_c"))
    columns = (record.indoor_temperature[:-1], free_run(model, record)[:-1], case.test.outdoor_temperature)
    rows = np.column_stack([np.asarray(column, float) for column in columns]).tolist()
    writer.writerows([stamp, *row] for stamp, row in zip(case.parts.test.time_stamps(), rows, strict=True))
    write_atomically(store.folder / store.free_run, text.getvalue().encode())
