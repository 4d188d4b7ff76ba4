"""What the files of all studies say of how they came about."""

from typing import Any, Literal

from pydantic import Field

from hemma.record import Record
from hemma.results.ledger import INTERVAL_KIND


class StudyFile(Record):
    """The head of a file."""

    version: Literal[1] = Field(default=1, alias="schema")
    hemma: str = ""
    code: str = ""
    command: str = ""
    """What was typed to get the file."""
    settings: dict[str, Any] = Field(default_factory=dict)
    interval_kind: str = INTERVAL_KIND
