"""The command ``hemma``: what it offers, and how it ends.

Nothing heavy is imported here: help must come at once. Each command imports what it needs when it runs.
"""

import sys
from typing import Annotated

import typer

import hemma
from hemma.cli import compare, data, experiment, robustness, transfer
from hemma.cli.console import say, tell
from hemma.cli.streams import part_streams
from hemma.errors import HemmaError

MISTAKE = 2
"""Exit status of a mistake that the user can put right."""

EPILOG = (
    "Results go to standard output, messages and progress to standard error. "
    "Exit status: 0 done; 1 a fault in Hemma; 2 something to put right (a file, a setting, an option); "
    "130 interrupted, run the same command to go on."
)

app = typer.Typer(
    name="hemma",
    help="Home energy management that learns from an optimiser.",
    epilog=EPILOG,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
app.add_typer(data.app, name="data")
experiment.register(app)
for command in (compare.compare, robustness.robustness, transfer.transfer):
    app.command()(command)


def run() -> None:
    """Entry point: a user's mistake becomes one message on standard error, never a traceback."""
    part_streams()
    try:
        try:
            app()
        finally:
            sys.stdout.flush()
    except HemmaError as error:
        _stop(str(error))
    except OSError as error:
        place = f"{error.filename}: " if error.filename else ""
        _stop(
            f"{place}{error.strerror or error}. Check that it exists, may be written, and that disk is left"
        )


def _stop(message: str) -> None:
    tell(f"hemma: {message}")
    sys.exit(MISTAKE)


def _print_version(wanted: bool | None) -> bool:
    if wanted:
        say(hemma.__version__)
        raise typer.Exit
    return False


@app.callback()
def _common(
    version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    """Home energy management that learns from an optimiser."""
