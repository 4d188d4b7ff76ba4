"""One way to write the JSON files of a results folder and to read them as typed values."""

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, TypeVar

from pydantic import ValidationError

from hemma.checkpoint import write_atomically
from hemma.errors import HemmaError, shortened
from hemma.record import Record

Kind = TypeVar("Kind", bound=Record)
NO_TEXT = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\ud800-\udfff]")
"""Control characters and halves of surrogate pairs: no path, no figure and no terminal takes them."""


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
        content = json.loads(path.read_text(encoding="utf-8"))
    except RecursionError as error:
        raise HemmaError("it is nested too deeply") from error
    except ValueError as error:
        raise HemmaError(shortened(error)) from error
    _require_text(content)
    return content


def _require_text(content: Any) -> None:
    for item in items(content):
        if isinstance(item, str) and NO_TEXT.search(item):
            raise HemmaError(f"{shortened(ascii(item))} holds characters that no text has")


def items(content: Any) -> Iterator[Any]:
    """Whatever stands in the content of a JSON file, at any depth: mappings, lists, keys and values."""
    waiting = [content]
    while waiting:
        item = waiting.pop()
        yield item
        if isinstance(item, list):
            waiting += item
        elif isinstance(item, dict):
            waiting += [*item, *item.values()]


def write_record(path: Path, record: Record) -> None:
    """Write a record as JSON, whole or not at all; null stands for what is undefined."""
    write_json(path, json_content(record))


def write_json(path: Path, content: Any) -> None:
    """Write a JSON file, whole or not at all; NaN is refused."""
    text = json.dumps(content, indent=1, allow_nan=False, ensure_ascii=False)
    write_atomically(path, (text + "\n").encode())


def json_content(record: Record) -> Any:
    """A record as its file has it."""
    return record.model_dump(mode="json", by_alias=True)
