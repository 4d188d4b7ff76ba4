"""What to run, on what, and where the results go."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import jax

from hemma.data import Traces
from hemma.errors import HemmaError
from hemma.forecasting.outlook import Outlook
from hemma.identification.fit import parted
from hemma.identification.validation import LONGEST
from hemma.results.lock import LOCK, locked
from hemma.results.progress import Progress
from hemma.results.results import RESULTS_FILE
from hemma.settings.experiment import Experiment
from hemma.stages.case import Case, make_case

IGNORED = {LOCK, ".gitignore", ".gitkeep", ".DS_Store"}
"""Files that a folder may hold before its first results, besides the logs that a shell has opened."""


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


def checked(job: Job, is_taught: bool = True) -> list[Case]:
    """The homes of a job, refused where a stage would refuse them after hours of work.

    ``is_taught`` says whether the job goes as far as the demonstrations.
    """
    names = [home.name for home in job.homes]
    for name in names:
        if not name.isprintable():
            raise HemmaError(f"expected a home with a readable name, got {name!a}; rename its trace file")
        if names.count(name) > 1:
            raise HemmaError(f"expected homes with different names, got {name} twice; name each of them once")
    cases = [make_case(job.experiment, traces, job.test_from) for traces in job.homes]
    for case in cases:
        require_long_enough(case, is_taught)
    return cases


def require_long_enough(case: Case, is_taught: bool = True) -> None:
    """Refuse periods that are too short for what is to be done with them."""
    experiment, slot_length = case.experiment, case.traces.slot_length
    try:
        parted(case.training.slots, slot_length, experiment.identification)
        Outlook(case.training, case.test, slot_length, experiment.forecast_horizon)
    except HemmaError as error:
        raise HemmaError(f"{case.name}: {error}") from error
    if case.test.slots * slot_length < LONGEST:
        raise HemmaError(
            f"{case.name}: expected a test period of at least {LONGEST:g} h, got {case.test.slots} slots of "
            f"{slot_length:g} h; begin it earlier with --test-from, or give longer traces"
        )
    if is_taught:
        case.first_days(experiment.demonstration_days)


@contextmanager
def at_work(folder: Path, command: str, progress: Progress) -> Iterator[None]:
    """Work in a results folder alone; it, and what computes, are found fit before hours of work."""
    try:
        jax.devices()
    except (RuntimeError, AssertionError) as error:  # a plugin without its device fails either way
        wanted = os.environ.get("JAX_PLATFORMS")
        raise HemmaError(
            f"expected a device to compute on, JAX finds none for JAX_PLATFORMS={wanted}: "
            f"{str(error)[:200] or 'it is missing'}. Unset JAX_PLATFORMS, or set it to cpu"
        ) from error
    _require_results_folder(folder)
    with locked(folder, command, progress):
        yield


def _require_results_folder(folder: Path) -> None:
    """Make it where it is missing; refuse what cannot be written, and a folder full of other things."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise HemmaError(
            f"{folder}: expected a results folder, cannot make it: {error.strerror}. Choose another: --out"
        ) from error
    if not os.access(folder, os.W_OK | os.X_OK):
        raise HemmaError(f"{folder}: expected a results folder that may be written. Choose another: --out")
    names = sorted(path.name for path in folder.iterdir())
    others = [name for name in names if name not in IGNORED and not name.endswith(".log")]
    if others and not _is_ours(folder):
        raise HemmaError(
            f"{folder}: expected an empty folder or one with results of Hemma, got one with other things, "
            f"{others[0][:60]} among them. Name a folder of its own, such as --out {folder / 'results'}"
        )


def _is_ours(folder: Path) -> bool:
    if (folder / LOCK).is_file() or any(folder.glob("models/*/*.json")):
        return True
    files = [folder / name for name in (RESULTS_FILE, "robustness.json", "transfer.json")]
    return any(b'"hemma"' in file.read_bytes() for file in files if file.is_file())
