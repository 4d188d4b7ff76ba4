"""``hemma reproduce``, its stages one by one, ``hemma report`` and ``hemma settings``."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from hemma.cli.console import going_on_later, print_json, print_table, say, show_progress, show_results, typed
from hemma.cli.files import path_argument, path_option
from hemma.cli.homes import chosen_homes

if TYPE_CHECKING:
    from hemma.experiment.run import Job
    from hemma.settings.experiment import Experiment

Traces = Annotated[
    Path | None,
    path_option("--traces", "FILE", "Canonical trace file of your own home.", "an embedded home"),
]
Home = Annotated[
    list[int] | None,
    typer.Option("--home", help="Embedded home, 1 to 6; repeat it for several.", show_default="1"),
]
Homes = Annotated[
    str | None,
    typer.Option("--homes", metavar="LIST", help="Several embedded homes: all, or numbers such as 1,3,5."),
]
TestFrom = Annotated[
    str | None,
    typer.Option(
        "--test-from", metavar="DATE", help="First day of the test.", show_default="the last 31 days"
    ),
]
Settings = Annotated[
    Path | None, path_option("--settings", "FILE.yaml", "Settings; `hemma settings` prints the defaults.")
]
Out = Annotated[Path, path_option("--out", "DIR", "Results folder.")]
Seeds = Annotated[
    int | None,
    typer.Option("--seeds", help="Runs of each learned method instead of the number in the settings."),
]
Quick = Annotated[
    bool, typer.Option("--quick", help="All stages in a few minutes, too little training to quote.")
]
Json = Annotated[bool, typer.Option("--json", help="Print results.json instead of a table.")]
Week = Annotated[
    int, typer.Option("--week", help="Which week of the test period the time plots show, from 1.")
]
Folder = Annotated[Path, path_argument("FOLDER", "Results folder of an earlier run.")]

OUT = Path("results")

VERBS = {
    "reproduce": "Run everything: identify, demonstrate, baselines, train, evaluate, report.",
    "identify": "Identify the building and say how well the network predicts it.",
    "demonstrate": "Identify, and let the expert demonstrate on the first training days.",
    "train": "Identify, demonstrate, and train all learned methods.",
    "evaluate": "Everything but the report.",
}
"""Each goes as far as its name and takes what an earlier command left in the folder."""


@dataclass(frozen=True)
class Request:
    """What was asked for on the command line."""

    traces: Path | None
    homes: tuple[int, ...]
    test_from: str | None
    settings: Path | None
    folder: Path
    seeds: int | None
    quick: bool


def register(app: typer.Typer) -> None:
    """Add the commands to ``app``."""
    for verb, text in VERBS.items():
        app.command(verb, help=text)(_command(verb))
    app.command()(report)
    app.command()(settings)


def report(folder: Folder = OUT, week: Week = 1) -> None:
    """Write the figures and the report of a results folder again."""
    from hemma.report import write_report

    path = write_report(folder, week)
    print_table(folder)
    say(path)


def settings(file: Settings = None) -> None:
    """Print all settings with their explanations, as a file for --settings."""
    from hemma.settings.experiment import Experiment
    from hemma.settings.file import read_settings, settings_text

    say(settings_text(Experiment() if file is None else read_settings(file)).rstrip("\n"))


def _command(verb: str):
    """The command of a verb: they all take the same options."""

    def command(  # noqa: PLR0913
        traces: Traces = None,
        home: Home = None,
        homes: Homes = None,
        test_from: TestFrom = None,
        settings: Settings = None,
        out: Out = OUT,
        seeds: Seeds = None,
        quick: Quick = False,
        json: Json = False,
    ) -> None:
        chosen = chosen_homes(home, homes)
        content = _run(verb, Request(traces, chosen, test_from, settings, out, seeds, quick))
        if json:
            print_json(content)
        else:
            show_results(out, content)

    return command


def _run(verb: str, request: Request) -> Any:
    """Run the stages up to the verb's; interrupted, it says how to go on."""
    with going_on_later():
        from hemma.experiment.run import Stage, run

        last = Stage.REPORT if verb == "reproduce" else Stage[verb.upper()]
        job = job_of(request)
        with show_progress() as progress:
            return run(job, last, progress)


def job_of(request: Request) -> "Job":
    """The homes and settings that were asked for."""
    from hemma.errors import HemmaError
    from hemma.experiment.run import Job
    from hemma.stages.load import embedded_homes, own_home

    if request.traces is not None and request.homes:
        raise HemmaError("expected --traces FILE or --home N (--homes LIST), got both; leave one of them out")
    experiment = chosen_experiment(request.settings, request.seeds, request.quick)
    if request.traces is None:
        homes = embedded_homes(experiment, request.homes or (1,))
    else:
        homes = own_home(experiment, request.traces)
    return Job(experiment, homes, request.folder, request.test_from, typed())


def chosen_experiment(file: Path | None, seeds: int | None, is_quick: bool) -> "Experiment":
    """The settings of a file, or the defaults, with what the command line says otherwise."""
    from dataclasses import replace

    from hemma.errors import HemmaError
    from hemma.settings.experiment import Experiment, quick
    from hemma.settings.file import read_settings
    from hemma.settings.plausibility import limits_of

    if seeds is not None:
        try:
            limits_of(Experiment, "seeds").check(seeds)
        except ValueError as error:
            raise HemmaError(f"--seeds: {error}") from error
    experiment = Experiment() if file is None else read_settings(file)
    experiment = quick(experiment) if is_quick else experiment
    return experiment if seeds is None else replace(experiment, seeds=seeds)
