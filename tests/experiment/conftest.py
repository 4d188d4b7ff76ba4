"""The tiny experiment, run once for all tests."""

import jax
import pytest

from hemma.experiment.run import Stage, run
from tiny_experiment import tiny_job


@pytest.fixture(scope="package")
def finished(tmp_path_factory):
    """Folder and results of the tiny experiment, up to and with the evaluation."""
    folder = tmp_path_factory.mktemp("finished") / "results"
    return folder, run(tiny_job(folder), Stage.EVALUATE)


@pytest.fixture(scope="package", autouse=True)
def _compile_quickly():
    """Compile without optimising: these tests run each program for a moment only."""
    jax.config.update("jax_disable_most_optimizations", True)
    yield
    jax.config.update("jax_disable_most_optimizations", False)
