"""What a product depends on, in one number: same fingerprint, same product."""

import hashlib
import json
from collections.abc import Sequence
from dataclasses import fields, is_dataclass
from datetime import date
from functools import cache
from pathlib import Path
from types import FunctionType
from typing import Any

import jax
import numpy as np

import hemma


def fingerprint(stage: str, *parts: Any) -> str:
    """SHA-256 over the stage's name, the version of Hemma and all that the stage's product depends on.

    ``parts`` are parameters (dataclasses, modules, numbers, text), arrays, the ``code`` of the layers that
    do the work, and the fingerprints of the products that the stage starts from.
    """
    content = json.dumps([stage, hemma.__version__, [plain(part) for part in parts]], sort_keys=True)
    return hashlib.sha256(content.encode()).hexdigest()


@cache
def code(*layers: str) -> str:
    """SHA-256 over the source of these layers of Hemma: a change of the code is a change of what it makes."""
    package = Path(hemma.__file__).parent
    return source_digest([package / layer for layer in layers])


def source_digest(folders: Sequence[Path]) -> str:
    """SHA-256 over names and contents of all Python files in ``folders``, at any depth."""
    digest = hashlib.sha256()
    for folder in folders:
        for path in sorted(folder.rglob("*.py")):
            content = hashlib.sha256(path.read_bytes()).hexdigest()
            digest.update(f"{folder.name}/{path.relative_to(folder).as_posix()} {content}\n".encode())
    return digest.hexdigest()


def plain(value: Any) -> Any:
    """``value`` in a form that JSON writes the same way each time; arrays become digests of their content."""
    if value is None or isinstance(value, str | bool | int | float):
        return value
    if isinstance(value, FunctionType):
        return f"{value.__module__}.{value.__qualname__}"
    if isinstance(value, type):
        return value.__qualname__
    if isinstance(value, date):
        return value.isoformat()
    if isinstance(value, tuple | list):
        return [plain(item) for item in value]
    if is_dataclass(value):
        content = {field.name: plain(getattr(value, field.name)) for field in fields(value)}
        return {"type": type(value).__name__, **content}
    if isinstance(value, np.ndarray | np.generic | jax.Array):
        array = np.ascontiguousarray(value)
        digest = hashlib.sha256(array.tobytes()).hexdigest()
        return f"{array.dtype}{list(array.shape)}:{digest}"
    raise TypeError(f"a fingerprint cannot cover a {type(value).__name__}")
