"""``transfer.json``: what each method made of each changed home, as it is written and as it is read."""

from pathlib import Path

from pydantic import Field

from hemma.record import Number, Range, Record
from hemma.results.reading import read_record
from hemma.results.records import MethodRuns, Period
from hemma.studies.study_file import StudyFile

TRANSFER_FILE = "transfer.json"


class SeedPairs(Record):
    """How much more of the savings a run of one method keeps than the run of another with its seed."""

    method: str
    over: str
    metric: str = "share_of_savings"
    differences: tuple[Number, ...] = ()
    """By seed."""
    mean: Number = None
    interval: Range = None


class ChangedHome(Record):
    """All methods in one changed home."""

    meaning: str
    learned_from: str = ""
    """Start of the days that are learned from."""
    methods: dict[str, MethodRuns]
    paired: tuple[SeedPairs, ...] = ()


class Transfer(StudyFile):
    """The whole file."""

    command: str = "hemma transfer"
    home: str
    source: str = ""
    currency: str
    days: int
    """How many days each method learned from."""
    measured: Period
    places: dict[str, ChangedHome] = Field(min_length=1)
    """By the name of the change."""

    @property
    def methods(self) -> list[str]:
        """All methods, in their order."""
        return list(dict.fromkeys(name for place in self.places.values() for name in place.methods))


def load_transfer(folder: Path) -> Transfer:
    """Read the file of a folder; a ``HemmaError`` names what is wrong in it."""
    expected = "what `hemma transfer` writes (schema 1)"
    return read_record(folder / TRANSFER_FILE, Transfer, expected, "hemma transfer")
