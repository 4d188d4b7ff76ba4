"""How an experiment tells where it stands; the command line decides what that looks like."""

from typing import Protocol, runtime_checkable


@runtime_checkable
class Progress(Protocol):
    """Listens to an experiment. Stages follow each other; ``started`` comes before all else of a stage."""

    def started(self, stage: str, total: int) -> None:
        """A stage of ``total`` steps begins (1 where its length is unknown)."""

    def advanced(self, stage: str, done: int, message: str) -> None:
        """``done`` steps of the stage are behind it; ``message`` may be empty."""

    def finished(self, stage: str, message: str) -> None:
        """The stage is over; ``message`` says what it found."""

    def reused(self, stage: str, message: str) -> None:
        """The stage was not run: its product of an earlier run with the same settings stands."""

    def noticed(self, message: str) -> None:
        """Something that a reader of the results should know."""


class Silence(Progress):
    """Progress for callers who do not watch: nothing is said."""
