"""What to run, on what, and where the results go."""

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from hemma.data import Traces
from hemma.errors import HemmaError
from hemma.settings.experiment import Experiment


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


def require_different_names(homes: Sequence[Traces]) -> None:
    """Refuse homes that would overwrite each other's results."""
    names = [home.name for home in homes]
    for name in names:
        if names.count(name) > 1:
            raise HemmaError(f"expected homes with different names, got {name} twice; name each of them once")


def require_writable(folder: Path) -> None:
    """Find out before hours of work that there is nowhere to put them."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise HemmaError(
            f"{folder}: expected a results folder, cannot make it: {error.strerror}. Choose another: --out"
        ) from error
    if not os.access(folder, os.W_OK | os.X_OK):
        raise HemmaError(f"{folder}: expected a results folder that may be written. Choose another: --out")
