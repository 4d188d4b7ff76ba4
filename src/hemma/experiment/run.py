"""The main job, stage by stage: traces in, one results folder out."""

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hemma.data import Traces
from hemma.errors import HemmaError
from hemma.experiment.case import make_case
from hemma.experiment.home_run import HomeRun, Stage
from hemma.experiment.keys import outside
from hemma.experiment.ledger import open_ledger
from hemma.experiment.progress import Progress, Silence
from hemma.experiment.results import Head
from hemma.experiment.settings import Experiment
from hemma.experiment.store import Store

__all__ = ["Job", "Stage", "run"]


@dataclass(frozen=True)
class Job:
    """What to run, on what, and where the results go."""

    experiment: Experiment
    homes: tuple[Traces, ...]
    folder: Path
    test_from: str | None = None
    """Start of the test period; the last 31 days by default."""
    command: str = "hemma reproduce"
    """What was typed, for the results file."""


def run(job: Job, last: Stage = Stage.REPORT, progress: Progress | None = None) -> Any:
    """Run the stages up to ``last`` for every home; the content of ``results.json``.

    Every stage keeps its product in the folder, with a fingerprint of all that it depends on. The same call
    after an interruption goes on where it was, and repeated it changes nothing; a stage whose settings,
    traces or version differ is done again.
    """
    progress = Silence() if progress is None else progress
    require_different_names(job.homes)
    cases = [make_case(job.experiment, traces, job.test_from) for traces in job.homes]
    require_writable(job.folder)
    ledger = open_ledger(job.folder, Head(job.command, outside(job.experiment)), progress)
    for case in cases:
        HomeRun(case, Store(job.folder, case.name, progress), ledger).up_to(last)
    ledger.close()
    if last is Stage.REPORT:
        _report(job.folder, progress)
    return ledger.content


def require_different_names(homes: Sequence[Traces]) -> None:
    """Refuse homes that would overwrite each other's results."""
    names = [home.name for home in homes]
    for name in names:
        if names.count(name) > 1:
            raise HemmaError(f"expected homes with different names, got {name} twice; name each of them once")


def require_writable(folder: Path) -> None:
    """Find out before hours of work that there is nowhere to put them."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise HemmaError(
            f"{folder}: expected a results folder, cannot make it: {error.strerror}. Choose another: --out"
        ) from error
    if not os.access(folder, os.W_OK | os.X_OK):
        raise HemmaError(f"{folder}: expected a results folder that may be written. Choose another: --out")


def _report(folder: Path, progress: Progress) -> None:
    from hemma.report.report import write_report

    progress.started("report", 1)
    progress.finished("report", str(write_report(folder)))
