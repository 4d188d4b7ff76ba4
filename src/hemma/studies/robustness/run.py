"""``hemma robustness``: train what is not trained yet, and let every method meet every fault."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import hemma
from hemma.errors import HemmaError
from hemma.methods import learned
from hemma.results.ledger import CODE
from hemma.results.progress import Progress, Silence
from hemma.results.reading import write_record
from hemma.results.results import load_results
from hemma.results.store import Store
from hemma.settings.experiment import DataEfficiency
from hemma.settings.keys import outside
from hemma.stages.case import Case
from hemma.stages.demonstrate import Expert
from hemma.stages.identify import identify
from hemma.stages.job import Job, at_work, checked
from hemma.stages.train import train_all
from hemma.studies.robustness.records import ROBUSTNESS_FILE, RobustHome, Robustness
from hemma.studies.robustness.report import write_robustness_report
from hemma.studies.robustness.stored import stored_job, stored_trial, tell_what_differs
from hemma.studies.robustness.trial import SEED, Trial


def run_faults(job: Job, progress: Progress | None = None) -> Robustness:
    """All homes of the job.

    What an earlier command left in the folder is used, the rest is trained; the same call goes on where it
    stopped.
    """
    progress = Silence() if progress is None else progress
    plain = replace(job.experiment, data_efficiency=DataEfficiency(days=()))
    learned(plain)  # refuses unknown names before any work
    cases = checked(replace(job, experiment=plain))
    with at_work(job.folder, job.command, progress):
        return measure_faults(job, [_trained(case, Store(job.folder, case.name, progress)) for case in cases])


def run_stored_faults(
    folder: Path, traces: Path | None, command: str, progress: Progress | None = None
) -> Robustness:
    """The homes and methods that a folder holds, nothing trained.

    Raises ``HemmaError`` where the folder has nothing to measure.
    """
    progress = Silence() if progress is None else progress
    job = stored_job(folder, traces, command)
    cases = checked(job)
    with at_work(folder, command, progress):
        trials = [stored_trial(case, Store(folder, case.name, progress)) for case in cases]
        content = measure_faults(job, trials)
    tell_what_differs(load_results(folder), content, progress)
    return content


def measure_faults(job: Job, trials: Sequence[Trial]) -> Robustness:
    """Let the methods of every home meet every fault, and those of the next home where there are several."""
    homes: dict[str, RobustHome] = {}
    found: Robustness | None = None
    for trial, following in zip(trials, [*trials[1:], *trials[:1]], strict=True):
        case, neighbour = trial.expert.case, None if following is trial else following
        homes[case.name] = RobustHome(
            traces_sha256=case.traces.sha256,
            currency=case.experiment.currency,
            test=case.test_period,
            faults=trial.results(neighbour),
        )
        found = Robustness(
            hemma=hemma.__version__,
            code=CODE,
            command=job.command,
            settings=outside(job.experiment),
            seed_of_faults=SEED,
            homes=homes,
        )
        write_record(job.folder / ROBUSTNESS_FILE, found)
    if found is None:
        raise HemmaError("robustness: expected at least one home, got none; name one with --home")
    write_robustness_report(job.folder)
    return found


def _trained(case: Case, store: Store) -> Trial:
    expert = Expert(case, identify(case, store))
    jobs = [method.training_job(expert, store) for method in learned(case.experiment)]
    return Trial(expert, store, train_all(jobs, store))
