"""The products of the stages on disk: what an interrupted run keeps and a repeated one uses again."""

import hashlib
import json
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from hemma.errors import HemmaError
from hemma.results.progress import Progress
from hemma.results.reading import read_json, write_json


@dataclass(frozen=True)
class Store:
    """The results folder, as far as one home is concerned.

    Every product has a card: a JSON file with the fingerprint of all that the product depends on, the
    digests of its files, its content as far as that is small, and a seal over all of them. A card whose seal
    is broken is none, so whoever reads a content finds what was written.
    """

    folder: Path
    home: str
    progress: Progress
    _told: set[str] = field(default_factory=set, repr=False, compare=False)
    """Products whose making, or that of an earlier run, was already told of."""

    def model(self, file: str) -> str:
        """Name, inside the folder, of a product of this home."""
        return f"models/{self.home}/{file}"

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

    def product(
        self,
        name: str,
        mark: str,
        make: Callable[[], tuple[dict[str, Any], Iterable[str]]],
        stage: str | None = None,
    ) -> dict[str, Any]:
        """The content of a product with the fingerprint ``mark``: that of an earlier run, or made now.

        ``make`` writes the product's files and gives its content, as JSON, and their names inside the folder.
        An earlier one is told of once as a ``stage`` that is not run again, by the content's ``message``.
        """
        content = self.kept(name, mark)
        if content is None:
            content, files = make()
            self.keep(name, mark, files, content)
        elif stage is not None and name not in self._told:
            self.progress.reused(stage, content.get("message", ""))
        self._told.add(name)
        return content

    def keep(self, product: str, mark: str, files: Iterable[str], content: dict[str, Any]) -> None:
        """Write the card of a product whose ``files`` (names inside the folder) have just been written."""
        digests = {name: _digest(self.folder / name) for name in files}
        card = {"fingerprint": mark, "files": digests, "content": content}
        write_json(self._card(product), {**card, "seal": _seal(card)})

    def kept(self, product: str, mark: str) -> dict[str, Any] | None:
        """The content of a card with this fingerprint; None if there is none or a file of it was changed."""
        card = self._read(product)
        return card["content"] if card is not None and card["fingerprint"] == mark else None

    def mark_of(self, product: str) -> str | None:
        """The fingerprint of a product, whatever made it; None if there is none or a file was changed."""
        card = self._read(product)
        return None if card is None else card["fingerprint"]

    def _read(self, product: str) -> dict[str, Any] | None:
        """A card of which all files are as they were written."""
        try:
            card = read_json(self._card(product))
        except (OSError, HemmaError):
            return None
        if not isinstance(card, dict) or card.pop("seal", None) != _seal(card):
            return None
        unchanged = all(_digest(self.folder / name) == digest for name, digest in card["files"].items())
        return card if unchanged else None

    def _card(self, product: str) -> Path:
        return self.folder / self.model(f"{product}.json")


def _seal(card: dict[str, Any]) -> str:
    """SHA-256 over what a file says of the card, whatever wrote or read it."""
    plain = json.loads(json.dumps(card))
    return hashlib.sha256(json.dumps(plain, sort_keys=True).encode()).hexdigest()


def _digest(path: Path) -> str | None:
    """SHA-256 of a file, None where it cannot be read."""
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError:
        return None
