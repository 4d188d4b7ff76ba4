"""The tiny experiment, run once for all tests, in however many processes they run."""

import json
import shutil
import time
from pathlib import Path

import jax
import pytest

from hemma.experiment.run import Stage, run
from tiny_experiment import tiny_job

PATIENCE = 600.0
"""How long a process waits for another one to run the experiment [s]."""


@pytest.fixture(scope="package")
def finished(tmp_path_factory, worker_id):
    """Folder and results of the tiny experiment, up to and with the evaluation.

    The first process that asks runs it, the others wait; each has a copy of its own.
    """
    own = tmp_path_factory.getbasetemp()
    place = (own if worker_id == "master" else own.parent) / "finished"
    try:
        place.mkdir()
    except FileExistsError:
        _wait_for(place / "content.json")
    else:
        content = run(tiny_job(place / "results"), Stage.EVALUATE)
        (place / "writing").write_text(json.dumps(content))
        (place / "writing").rename(place / "content.json")
    folder = tmp_path_factory.mktemp("finished") / "results"
    shutil.copytree(place / "results", folder)
    return folder, json.loads((place / "content.json").read_text())


def _wait_for(file: Path) -> None:
    begun = time.monotonic()
    while not file.exists():
        if time.monotonic() - begun > PATIENCE:
            pytest.fail(f"{file}: another process was to write it and has not; run the tests again")
        time.sleep(0.2)


@pytest.fixture(scope="package", autouse=True)
def _compile_quickly():
    """Compile without optimising: these tests run each program for a moment only."""
    jax.config.update("jax_disable_most_optimizations", True)
    yield
    jax.config.update("jax_disable_most_optimizations", False)
