"""One way to read the JSON files of a results folder as typed values, and one to write them."""

import json
from pathlib import Path
from typing import Any, TypeVar

from pydantic import ValidationError

from hemma.checkpoint import write_atomically
from hemma.errors import HemmaError
from hemma.results.records import Record

Kind = TypeVar("Kind", bound=Record)


def read_record(path: Path, kind: type[Kind], expected: str, command: str) -> Kind:
    """The content of a file; a ``HemmaError`` names the file and what is wrong in it.

    ``expected`` and ``command`` are for its message: what the file should be, and what writes it.
    """
    start = f"{path}: expected {expected}"
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError as error:
        raise HemmaError(f"{start}, there is no such file. Run `{command}` first") from error
    except (OSError, ValueError) as error:
        raise HemmaError(f"{start}, cannot read it: {error}. Run `{command}` again") from error
    try:
        return kind.model_validate(content)
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(str(part) for part in first["loc"]) or "the file"
        raise HemmaError(
            f"{start}; {place}: {first['msg']}, found {str(first['input'])[:60]}. "
            f"Correct it, or run `{command}` again"
        ) from error


def write_json(path: Path, content: Any) -> None:
    """Write a file, whole or not at all; NaN is refused, null stands for what is undefined."""
    write_atomically(path, json_text(content).encode())


def json_text(content: Any) -> str:
    """What ``write_json`` writes."""
    return json.dumps(content, indent=1, allow_nan=False, ensure_ascii=False) + "\n"
