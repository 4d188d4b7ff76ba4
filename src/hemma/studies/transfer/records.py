"""``transfer.json`` as typed values, and its table."""

from pathlib import Path
from typing import Literal

from pydantic import Field

from hemma.results.reading import read_record
from hemma.results.records import Method, Number, Period, Range, Record

TRANSFER_FILE = "transfer.json"


class Paired(Record):
    """How much more of the savings a run of one method keeps than the run of another with its seed."""

    method: str
    over: str
    mean: Number = None
    interval: Range = None


class Place(Record):
    """All methods in one home."""

    meaning: str
    methods: dict[str, Method]
    paired: tuple[Paired, ...] = ()


class Transfer(Record):
    """The whole file."""

    version: Literal[1] = Field(alias="schema")
    home: str
    currency: str
    days: int
    """How many days each method learned from."""
    measured: Period
    places: dict[str, Place] = Field(min_length=1)

    @property
    def methods(self) -> list[str]:
        """All methods, in their order."""
        return list(dict.fromkeys(name for place in self.places.values() for name in place.methods))


def load_transfer(folder: Path) -> Transfer:
    """Read the file of a folder; a ``HemmaError`` names what is wrong in it."""
    expected = "what `hemma transfer` writes (schema 1)"
    return read_record(folder / TRANSFER_FILE, Transfer, expected, "hemma transfer")
