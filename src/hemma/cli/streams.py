"""Standard output belongs to results: whatever else a library writes there comes out on standard error."""

import codecs
import io
import os
import sys
import unicodedata
from typing import TextIO

PLAIN = {"−": "-", "–": "-", "—": "-", "±": "+-", "✓": "+", "β": "beta", "‘": "'", "’": "'"}
"""Stand-ins where a terminal's encoding lacks the character; others lose their accents, or become ``?``."""


def part_streams() -> None:
    """Keep the real standard output for ``sys.stdout``, and give file descriptor 1 to standard error.

    A solver that prints its banner from C cannot spoil results then. Both streams replace what their encoding
    cannot show, and drop what nobody reads any more (``| head``). Streams that somebody else put in place
    are left alone.
    """
    codecs.register_error("hemma", _replaced)
    if sys.stdout is not sys.__stdout__ or sys.stderr is not sys.__stderr__:
        return
    if sys.platform == "win32":
        for stream in (sys.stdout, sys.stderr):
            if isinstance(stream, io.TextIOWrapper):
                stream.reconfigure(errors="hemma")
        return
    _fill_closed()
    results = os.dup(1)
    os.dup2(2, 1)
    sys.stdout = _text(results, sys.stdout)
    sys.stderr = _text(os.dup(2), sys.stderr, line_buffering=True)


class _Outlet(io.FileIO):
    """A file descriptor whose reader may go away, or whose disk may fill: it says so once."""

    is_gone = False

    def write(self, content, /) -> int:
        """Write as far as it goes; where the reader is gone, nothing."""
        if self.is_gone:
            return len(content)
        try:
            return super().write(content)
        except BlockingIOError:
            raise
        except OSError as error:
            self.is_gone = True
            if isinstance(error, BrokenPipeError):
                return len(content)
            raise


def _fill_closed() -> None:
    """A closed standard stream would be given to the next file that is opened."""
    while (descriptor := os.open(os.devnull, os.O_RDWR)) <= 2:
        os.set_inheritable(descriptor, True)
    os.close(descriptor)


def _text(descriptor: int, like: TextIO | None, line_buffering: bool = False) -> io.TextIOWrapper:
    return io.TextIOWrapper(
        io.BufferedWriter(_Outlet(descriptor, "w")),
        encoding="utf-8" if like is None else like.encoding,
        errors="hemma",
        line_buffering=line_buffering or os.isatty(descriptor),
    )


def _replaced(error: UnicodeError) -> tuple[str, int]:
    """The error handler of both streams."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    text = error.object[error.start : error.end]
    return "".join(map(_plain, text)), error.end


def _plain(character: str) -> str:
    parts = unicodedata.normalize("NFKD", PLAIN.get(character, character))
    return parts.encode("ascii", "ignore").decode() or "?"
