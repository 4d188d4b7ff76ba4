"""One run at a time works in a results folder."""

import errno
import os
import platform
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TextIO

from hemma.errors import HemmaError
from hemma.results.progress import Progress

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None

LOCK = ".hemma.lock"
"""Stays in the folder; it holds a line while a run is under way, and is empty otherwise."""
SHOWN = 200
"""Characters of that line in messages."""
WITHOUT_LOCKS = (errno.ENOLCK, errno.ENOTSUP, errno.EINVAL, errno.ENOSYS)
"""What file systems say that have none."""


@contextmanager
def locked(folder: Path, command: str, progress: Progress) -> Iterator[None]:
    """Work in ``folder`` alone: the operating system's lock on a file in it, which ends with the process.

    Raises ``HemmaError`` with who works there and since when. A line that an interrupted or killed run left
    behind holds nobody up; it is noticed. Where the file system has no locks, that is noticed too.
    """
    with open(folder / LOCK, "a+", encoding="utf-8", errors="replace") as file:
        is_locked = _lock(file, folder)
        file.seek(0)
        earlier = file.read(SHOWN).strip()
        if earlier:
            progress.noticed(
                f"{folder}: an earlier run did not come to its end ({earlier}); going on from it"
            )
        if not is_locked:
            progress.noticed(f"{folder} cannot be locked here: let no other run use it before this one ends")
        since = time.strftime("%Y-%m-%d %H:%M:%S %z")
        _write(file, f"process {os.getpid()} on {platform.node()} since {since}: {command}")
        try:
            yield
        finally:
            _write(file, "")


def _lock(file: TextIO, folder: Path) -> bool:
    """Whether the file could be locked; a ``HemmaError`` where another run has it."""
    if fcntl is None:
        return False
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError as error:
        file.seek(0)
        who = file.read(SHOWN).strip() or "another run"
        raise HemmaError(
            f"{folder}: expected a results folder that no other run is using, got one in use by {who}. "
            "Wait until it ends, or name another folder with --out"
        ) from error
    except OSError as error:
        if error.errno not in WITHOUT_LOCKS:
            raise
        return False
    return True


def _write(file: TextIO, line: str) -> None:
    file.seek(0)
    file.truncate()
    file.write(line)
    file.flush()
