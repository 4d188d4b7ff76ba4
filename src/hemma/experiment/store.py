"""The products of the stages on disk: what an interrupted run keeps and a repeated one uses again."""

import json
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hemma.checkpoint import load_header, write_atomically
from hemma.errors import HemmaError
from hemma.experiment.progress import Progress

FINGERPRINT = "fingerprint"


@dataclass(frozen=True)
class Store:
    """The results folder, as far as one home is concerned."""

    folder: Path
    home: str
    progress: Progress

    def model(self, file: str) -> Path:
        """Where a product of this home lies."""
        return self.folder / "models" / self.home / file

    def schedule(self, file: str) -> str:
        """Name, inside the folder, of a schedule of this home."""
        return f"schedules/{self.home}/{file}"

    def curve(self, file: str) -> str:
        """Name, inside the folder, of a training curve of this home."""
        return f"curves/{self.home}/{file}"

    @property
    def free_run(self) -> str:
        """Name, inside the folder, of the free run of the identified network."""
        return f"identification/{self.home}.csv"

    def holds(self, path: Path, mark: str, files: Iterable[str] = ()) -> bool:
        """Whether a product with this fingerprint, and the ``files`` that came with it, lie there whole."""
        return self.fingerprint(path) == mark and all((self.folder / name).is_file() for name in files)

    def fingerprint(self, path: Path) -> str | None:
        """Fingerprint of the product that lies there; None where there is none that can be read."""
        try:
            header = load_header(path) if path.suffix == ".safetensors" else read_json(path)
        except HemmaError:
            return None
        return header.get(FINGERPRINT)


def read_json(path: Path) -> dict[str, Any]:
    """A product that is a JSON object."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise HemmaError(f"{path}: expected a product of Hemma (JSON), cannot read it: {error}") from error
    if not isinstance(content, dict):
        raise HemmaError(f"{path}: expected a JSON object, found a {type(content).__name__}")
    return content


def write_json(path: Path, content: dict[str, Any]) -> None:
    """Write a product as JSON, whole or not at all."""
    write_atomically(path, json.dumps(content, indent=1, allow_nan=False).encode())
