"""Stage: identify the building with a physically consistent neural network."""

import csv
import io
import time
from dataclasses import dataclass

import jax
import numpy as np

from hemma.checkpoint import load_header, load_tree, save_tree, write_atomically
from hemma.experiment.case import Case
from hemma.experiment.fingerprint import fingerprint
from hemma.experiment.results import FreeRunError, Identified
from hemma.experiment.store import FINGERPRINT, Store
from hemma.identification.excitation import excite
from hemma.identification.fit import fit
from hemma.identification.pcnn import (
    InputScaling,
    PcnnWeights,
    PhysicallyConsistentNetwork,
    ThermalResponse,
)
from hemma.identification.record import ThermalRecord
from hemma.identification.validation import free_run, free_run_errors

STAGE = "identify"


@dataclass(frozen=True)
class Identification:
    """The product of the stage."""

    model: PhysicallyConsistentNetwork
    found: Identified
    mark: str


def identify(case: Case, store: Store) -> Identification:
    """Fit the network to a simulated, excited training period; measure it free-running in the test period."""
    settings = case.experiment.identification
    mark = fingerprint(STAGE, case.mark, case.experiment.excitation, settings)
    path = store.model("network.safetensors")
    if store.holds(path, mark, [store.free_run]):
        found = _found(load_header(path), store)
        store.progress.reused(STAGE, _message(found))
    else:
        found = _fit(case, store, mark)
        store.progress.finished(STAGE, _message(found))
    model = load_tree(path, _structure(settings.width, settings.depth))
    return Identification(model, found, mark)


def _fit(case: Case, store: Store, mark: str) -> Identified:
    settings, excitation = case.experiment.identification, case.experiment.excitation
    store.progress.started(STAGE, settings.updates)
    begun = time.monotonic()
    training_key, test_key, fit_key = jax.random.split(jax.random.key(0), 3)
    record = excite(case.home, case.training, excitation, training_key)
    fitted = fit(
        record, settings, fit_key, on_progress=lambda done, _: store.progress.advanced(STAGE, done, "")
    )
    test = excite(case.home, case.test, excitation, test_key)
    errors = free_run_errors(fitted.model, test)
    _write_free_run(case, store, fitted.model, test)
    header = {
        FINGERPRINT: mark,
        "seconds": time.monotonic() - begun,
        "errors": [[h, float(e)] for h, e in _horizons(errors)],
    }
    save_tree(store.model("network.safetensors"), fitted.model, header)
    return _found(header, store)


def _horizons(errors) -> list[tuple[str, float]]:
    return [
        ("1 h", errors.one_hour),
        ("6 h", errors.six_hours),
        ("24 h", errors.day),
        ("whole period", errors.month),
    ]


def _found(header: dict, store: Store) -> Identified:
    errors = tuple(FreeRunError(horizon, error) for horizon, error in header["errors"])
    return Identified(errors=errors, free_run=store.free_run, seconds=header["seconds"])


def _message(found: Identified) -> str:
    return "free-run error " + ", ".join(f"{e.error:.3f} °C after {e.horizon}" for e in found.errors[:3])


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


def _structure(width: int, depth: int) -> PhysicallyConsistentNetwork:
    """A network of these sizes, to be filled from a checkpoint."""
    return PhysicallyConsistentNetwork(
        weights=PcnnWeights.create(jax.random.key(0), width, depth),
        start=ThermalResponse(heating=1.0, cooling=1.0, loss=0.5),
        scaling=InputScaling(temperature_mean=0.0, temperature_deviation=1.0, pv_peak=1.0),
        slot_length=1.0,
    )
