"""The bytes of a user's file as text: found, unpacked, decoded, or refused with the cure."""

import gzip
import hashlib
import zlib
from dataclasses import dataclass
from pathlib import Path

from hemma.errors import HemmaError

GZIP = b"\x1f\x8b"
ZIP = b"PK\x03\x04"
NEWLINE = b"\n"


@dataclass(frozen=True)
class SourceFile:
    """A text file, perhaps compressed with gzip."""

    path: Path
    sha256: str
    """Of the bytes on disk."""
    text: str


def read_source(path: Path) -> SourceFile:
    """Read a UTF-8 text file, plain or gzip, with or without a byte order mark."""
    try:
        content = path.read_bytes()
    except OSError as error:
        reason = error.strerror or str(error)
        raise HemmaError(f"{path}: expected a readable file: {reason}. Check the path") from error
    digest = hashlib.sha256(content).hexdigest()
    if content.startswith(GZIP):
        content = _unpacked(path, content)
    if content.startswith(ZIP):
        raise HemmaError(f"{path}: expected a CSV text file, got an Excel or zip file. Export it as CSV")
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise HemmaError(
            f"{_place(path, content, error.start)}: expected text in UTF-8, got byte "
            f"{content[error.start]:#04x} at position {error.start}. Save it as CSV UTF-8"
        ) from error
    if "\0" in text:
        raise HemmaError(
            f"{_place(path, content, content.index(0))}: expected text in UTF-8, got a byte 0x00: UTF-16, "
            "or a file that was not written to its end. Save it as CSV UTF-8"
        )
    return SourceFile(path, digest, text)


def _place(path: Path, content: bytes, position: int) -> str:
    return f"{path}, line {content.count(NEWLINE, 0, position) + 1}"


def _unpacked(path: Path, content: bytes) -> bytes:
    try:
        return gzip.decompress(content)
    except (OSError, EOFError, zlib.error) as error:
        raise HemmaError(f"{path}: the gzip file is damaged ({error}). Fetch or write it again") from error


def stem(path: Path) -> str:
    """Name of a file without its folder, ``.gz`` and ``.csv``."""
    name = path.name.removesuffix(".gz").removesuffix(".csv")
    return name or path.name
