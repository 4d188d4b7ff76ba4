"""``hemma robustness``: train what is not trained yet, and let every method meet every fault."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import hemma
from hemma.errors import HemmaError
from hemma.results.ledger import CODE
from hemma.results.progress import Progress, Silence
from hemma.results.reading import write_record
from hemma.results.results import load_results
from hemma.results.store import Store
from hemma.settings.experiment import DataEfficiency
from hemma.settings.keys import outside
from hemma.stages.case import Case, make_case
from hemma.stages.demonstrate import Expert
from hemma.stages.explicit import explicit_lesson, explicit_methods, sweep_comfort_price
from hemma.stages.identify import identify
from hemma.stages.job import Job, require_different_names, require_writable
from hemma.stages.lessons import imitations, lessons
from hemma.stages.planners import planners
from hemma.stages.train import Trained, train_lesson, train_lessons
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
    require_different_names(job.homes)
    plain = replace(job.experiment, data_efficiency=DataEfficiency(days=()))
    cases = [make_case(plain, traces, job.test_from) for traces in job.homes]
    require_writable(job.folder)
    return measure_faults(job, [_trained(case, Store(job.folder, case.name, progress)) for case in cases])


def run_stored_faults(
    folder: Path, traces: Path | None, command: str, progress: Progress | None = None
) -> Robustness:
    """The homes and methods that a folder holds, nothing trained.

    Raises ``HemmaError`` where the folder has nothing to measure.
    """
    progress = Silence() if progress is None else progress
    job = stored_job(folder, traces, command)
    require_writable(folder)
    cases = [make_case(job.experiment, home, job.test_from) for home in job.homes]
    content = measure_faults(job, [stored_trial(case, Store(folder, case.name, progress)) for case in cases])
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
    return Trial(expert, store, learned_methods(expert, store), planners(expert, store))


def learned_methods(expert: Expert, store: Store) -> dict[str, Trained]:
    """The controllers of all learned methods, those of earlier commands where they are kept."""
    case = expert.case
    wanted = imitations(case.experiment, case.training_days)
    made = lessons(case, expert, store, wanted)
    trained: dict[str, Trained] = {}
    for kind in dict.fromkeys(lesson.kind for lesson in made):
        same = [lesson for lesson in made if lesson.kind == kind]
        done = train_lessons(same, store)
        trained |= {lesson.label: one for lesson, one in zip(same, done, strict=True)}
    for method in explicit_methods(case.experiment):
        sweep = sweep_comfort_price(expert, store, method)
        trained[method] = train_lesson(explicit_lesson(expert, store, method, sweep.chosen), store)
    return trained
