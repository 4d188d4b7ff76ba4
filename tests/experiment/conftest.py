"""The tiny experiment, run once for all tests."""

import pytest

from hemma.experiment.run import Stage, run
from tiny_experiment import tiny_job


@pytest.fixture(scope="package")
def finished(tmp_path_factory):
    """Folder and results of the tiny experiment, up to and with the evaluation."""
    folder = tmp_path_factory.mktemp("finished") / "results"
    return folder, run(tiny_job(folder), Stage.EVALUATE)
