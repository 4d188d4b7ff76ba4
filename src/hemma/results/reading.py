"""One way to write the JSON files of a results folder and to read them as typed values."""

import json
from pathlib import Path
from typing import Any, TypeVar

from pydantic import ValidationError

from hemma.checkpoint import write_atomically
from hemma.errors import HemmaError, shortened
from hemma.record import Record

Kind = TypeVar("Kind", bound=Record)


def read_record(path: Path, kind: type[Kind], expected: str, command: str) -> Kind:
    """The content of a file; a ``HemmaError`` names the file and what is wrong in it.

    ``expected`` and ``command`` are for its message: what the file should be, and what writes it.
    """
    start = f"{path}: expected {expected}"
    try:
        content = read_json(path)
    except FileNotFoundError as error:
        raise HemmaError(f"{start}, there is no such file. Run `{command}` first") from error
    except (OSError, HemmaError) as error:
        raise HemmaError(f"{start}, cannot read it: {error}. Run `{command}` again") from error
    try:
        return kind.model_validate(content)
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(shortened(part) for part in first["loc"]) or "the file"
        raise HemmaError(
            f"{start}; {place}: {first['msg']}, found {shortened(first['input'])}. "
            f"Correct it, or run `{command}` again"
        ) from error


def read_json(path: Path) -> Any:
    """What a JSON file holds; ``HemmaError`` where it is none, ``OSError`` where it cannot be opened."""
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except RecursionError as error:
        raise HemmaError("it is nested too deeply") from error
    except ValueError as error:
        raise HemmaError(str(error)) from error


def write_record(path: Path, record: Record) -> None:
    """Write a record as JSON, whole or not at all; null stands for what is undefined."""
    text = json.dumps(json_content(record), indent=1, allow_nan=False, ensure_ascii=False)
    write_atomically(path, (text + "\n").encode())


def json_content(record: Record) -> Any:
    """A record as its file has it."""
    return record.model_dump(mode="json", by_alias=True)
