"""A filled results folder, ready to act again: its own settings and homes, and nothing is trained."""

import math
from dataclasses import replace
from pathlib import Path

from hemma.data import AUSTIN2021_HOMES, Traces
from hemma.errors import HemmaError
from hemma.methods import learned
from hemma.results.progress import Progress
from hemma.results.results import RESULTS_FILE, Results, load_results
from hemma.results.store import Store
from hemma.rl.loading import load_controllers
from hemma.settings.experiment import DataEfficiency, Experiment
from hemma.settings.file import experiment_of
from hemma.stages.case import Case
from hemma.stages.demonstrate import Expert
from hemma.stages.identify import identified
from hemma.stages.job import Job
from hemma.stages.load import embedded_homes, own_home
from hemma.stages.observer import observer_of
from hemma.stages.train import Trained
from hemma.studies.robustness.records import Robustness
from hemma.studies.robustness.trial import Trial

SAME_COST = 1e-3
"""How far a cost may be from the one that the folder tells, relative to it, to be called the same."""


def stored_job(folder: Path, traces: Path | None, command: str) -> Job:
    """What filled the folder: its settings, its finished homes and their test period.

    An embedded home is known by its name; the home of a trace file needs the file again. Raises
    ``HemmaError`` where the folder has no results, and where the traces are not those that it measured.
    """
    results, path = load_results(folder), folder / RESULTS_FILE
    experiment = replace(experiment_of(results.settings, path), data_efficiency=DataEfficiency(days=()))
    homes = _homes(results, experiment, traces, path)
    starts = sorted({home.test.start for home in results.finished.values()})
    if len(starts) > 1:
        raise HemmaError(
            f"{path}: expected one test period for all homes, got starts {', '.join(starts)}; give each "
            "period a folder of its own"
        )
    return Job(experiment, homes, folder, starts[0], command)


def stored_trial(case: Case, store: Store) -> Trial:
    """The methods of a home as the folder holds them; one that was not trained is left out, and said."""
    expert = Expert(case, identified(store))
    trained = {}
    for method in learned(case.experiment):
        mark = store.mark_of(method.name)
        if mark is None:
            store.progress.noticed(
                f"{case.name}: {method.name} is left out, the folder holds no unchanged controllers of it"
            )
            continue
        controllers = load_controllers(
            store.folder / store.model(f"{method.name}.safetensors"), expert.planning_home
        )
        observer = observer_of(method.observation_model, expert, store)
        trained[method.name] = Trained(controllers, (), 0.0, mark, observer)
    return Trial(expert, store, trained)


def tell_what_differs(results: Results, found: Robustness, progress: Progress) -> None:
    """Say which runs cost something else where nothing is wrong than the folder's results tell."""
    for name, home in found.homes.items():
        nothing = home.faults[0].methods
        for method, one in results.homes[name].methods.items():
            told = {run.seed: run.energy_cost for run in one.runs}
            for run in nothing[method].runs if method in nothing else ():
                usual, cost = told.get(run.seed), run.energy_cost
                if usual is None or cost is None or not math.isclose(cost, usual, rel_tol=SAME_COST):
                    seed = "" if run.seed is None else f" with seed {run.seed}"
                    progress.noticed(
                        f"{name}: {method}{seed} costs {cost} where nothing is wrong, {usual} in "
                        f"{RESULTS_FILE}; it was made anew since, or the safety layer intervened"
                    )


def _homes(results: Results, experiment: Experiment, file: Path | None, path: Path) -> tuple[Traces, ...]:
    """The homes of the results with the traces that they were measured on."""
    own = {} if file is None else {home.name: home for home in own_home(experiment, file)}
    for name in own.keys() - results.finished.keys():
        raise HemmaError(
            f"--traces: expected the file of a home in {path} ({', '.join(results.finished)}), "
            f"got that of {name}"
        )
    embedded = {f"austin2021-{number}": number for number in AUSTIN2021_HOMES}
    homes = []
    for name, measured in results.finished.items():
        if name not in own and name not in embedded:
            raise HemmaError(
                f"{path}: {name} is no embedded home; give its trace file with --traces {name}.csv"
            )
        home = own[name] if name in own else embedded_homes(experiment, (embedded[name],))[0]
        if home.sha256 != measured.traces_sha256:
            raise HemmaError(
                f"{path}: {name} was measured on other traces than these; give its file with --traces, or "
                "run `hemma reproduce` again"
            )
        homes.append(home)
    return tuple(homes)
