"""``hemma transfer``: is the learned reward worth anything in a changed home?"""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hemma.cli.console import (
    going_on_later,
    grouped,
    print_json,
    results_console,
    ruled,
    say,
    show_progress,
    typed,
)
from hemma.cli.experiment import Quick, Seeds, Settings, chosen_experiment
from hemma.cli.files import path_option

if TYPE_CHECKING:
    from hemma.studies.transfer.run import TransferJob

Home = Annotated[int, typer.Option("--home", help="Embedded home, 1 to 6.")]
Out = Annotated[Path, path_option("--out", "DIR", "Folder of the test's results.")]
Json = Annotated[bool, typer.Option("--json", help="Print transfer.json instead of a table.")]
OUT = Path("transfer")


def transfer(
    home: Home = 1,
    seeds: Seeds = None,
    settings: Settings = None,
    out: Out = OUT,
    quick: Quick = False,
    json: Json = False,
) -> None:
    """Learn a reward in one home, train on it again in changed ones; draw what it wants."""
    with going_on_later():
        from hemma.studies.transfer.run import transfer as run

        job = _job(home, chosen_experiment(settings, seeds, quick), out)
        with show_progress() as progress:
            content = run(job, progress)
    if json:
        print_json(content)
    else:
        _print_tables(out)


def _job(home: int, experiment, folder: Path) -> "TransferJob":
    from hemma.stages.load import embedded_homes
    from hemma.studies.transfer.run import TransferJob

    [traces] = embedded_homes(experiment, (home,))
    return TransferJob(experiment, traces, folder, command=typed())


def _print_tables(folder: Path) -> None:
    from hemma.studies.transfer.records import TRANSFER_FILE, load_transfer
    from hemma.studies.transfer.report import HEADINGS, TABLE_FILE, paired_lines, transfer_rows

    found = load_transfer(folder)
    console = results_console()
    table = ruled(f"{found.home}: mean of the runs, and its 95 % interval", HEADINGS, left=2)
    console.print(grouped(table, transfer_rows(found)))
    for line in paired_lines(found):
        console.print(line)
    say(f"Results: {folder / TRANSFER_FILE}")
    say(f"Table: {folder / TABLE_FILE}")
    say(f"Figures: {folder / 'figures'}")
