"""Files and folders that the command line names."""

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

from hemma.errors import HemmaError

Force = Annotated[bool, typer.Option("--force", help="Replace the file if there is one.")]


def named(text: str | Path) -> Path:
    """The path that was given; an empty one, an unset variable in a script, is refused."""
    if not str(text).strip():
        raise typer.BadParameter("expected a name, got nothing. Correct it, or leave the option out")
    return Path(text)


def path_option(name: str, metavar: str, text: str, default: bool | str = True) -> Any:
    """An option ``name`` that takes a path; ``default`` is what its help says of the default, if anything."""
    return typer.Option(name, parser=named, metavar=metavar, help=text, show_default=default)


def path_argument(metavar: str, text: str, default: bool | str = True) -> Any:
    """An argument that is a path; ``default`` as in ``path_option``."""
    return typer.Argument(parser=named, metavar=metavar, help=text, show_default=default)


def require_new(file: Path, force: bool, endings: Sequence[str]) -> None:
    """Refuse, before any work, other ``endings`` and, without ``--force``, a file that is there already."""
    if not file.name.endswith(tuple(endings)):
        found = file.suffix or "no ending"
        raise HemmaError(f"{file}: expected a name that ends in {', '.join(endings)}, got {found}. Rename it")
    if file.is_dir():
        raise HemmaError(f"{file}: expected the name of a file to write, got a folder. Name a file in it")
    if file.is_file() and not force:
        raise HemmaError(
            f"{file}: expected the name of a new file, this one is there already. Choose another name, or "
            "replace it with --force"
        )
