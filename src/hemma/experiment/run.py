"""The main job, stage by stage: traces in, one results folder out."""

from pathlib import Path
from typing import Any

from hemma.experiment.home_run import HomeRun, Stage
from hemma.results.ledger import open_ledger
from hemma.results.progress import Progress, Silence
from hemma.results.reading import json_content
from hemma.results.store import Store
from hemma.settings.keys import outside
from hemma.stages.case import make_case
from hemma.stages.job import Job, require_different_names, require_writable

__all__ = ["Job", "Stage", "run"]


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
    ledger = open_ledger(job.folder, job.command, outside(job.experiment), progress)
    for case in cases:
        HomeRun(case, Store(job.folder, case.name, progress), ledger).up_to(last)
    ledger.close()
    if last is Stage.REPORT:
        _report(job.folder, progress)
    return json_content(ledger.results)


def _report(folder: Path, progress: Progress) -> None:
    from hemma.report.report import write_report

    progress.started("report", 1)
    progress.finished("report", str(write_report(folder)))
