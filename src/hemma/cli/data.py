"""``hemma data``: look at traces, and bring them into the canonical form."""

from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer(help="Look at traces and bring them into the canonical form.", no_args_is_help=True)

File = Annotated[Path, typer.Argument(help="Canonical trace file, .csv or .csv.gz.", show_default=False)]


@app.command()
def check(file: File) -> None:
    """Read a canonical trace file and say what it holds, what was repaired and what looks odd."""
    from hemma.data import read_canonical, report_quality

    for line in report_quality(read_canonical(file)):
        typer.echo(line)


@app.command()
def export(
    file: File,
    home: Annotated[int, typer.Option("--home", help="Number of the embedded home, 1 to 6.")] = 1,
) -> None:
    """Write an embedded home as a canonical trace file: an example to fill with your own numbers."""
    from hemma.data import load_austin2021, write_canonical

    traces = load_austin2021(home)
    write_canonical(traces, file)
    typer.echo(f"{file}: {traces.slots} slots of {traces.name}. {traces.source}")
