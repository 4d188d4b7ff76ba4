"""Receding horizon: how far a level plans, and how much of the plan it carries out."""

from collections.abc import Iterator
from dataclasses import dataclass

from hemma.home.checks import require


@dataclass(frozen=True)
class Window:
    """One plan: the slots ``start`` to ``end`` are planned, those before ``stop`` carried out."""

    start: int
    stop: int
    end: int


@dataclass(frozen=True)
class Horizon:
    """Plan ``planned`` hours, carry out ``carried_out`` of them, plan again."""

    planned: float | None = None
    """How far a plan looks ahead [h]; None for all that is left."""
    carried_out: float | None = None
    """How much of a plan is carried out before the next one [h]; None for all that was planned."""

    def __post_init__(self):
        """Refuse horizons that never arrive."""
        for name, value in (("planned", self.planned), ("carried_out", self.carried_out)):
            require("horizon", value is None or value > 0, f"{name} > 0", value)
        if self.planned is not None and self.carried_out is not None:
            far = self.carried_out <= self.planned
            require("horizon", far, "carried_out <= planned", (self.carried_out, self.planned))

    def windows(self, slots: int, slot_length: float) -> Iterator[Window]:
        """The plans that cover ``slots`` slots of ``slot_length`` [h]; those near the end are shorter.

        Hours are rounded to whole slots, at least one.
        """
        planned = _slots(self.planned, slot_length, slots)
        carried_out = min(_slots(self.carried_out, slot_length, planned), planned)
        start = 0
        while start < slots:
            end = min(start + planned, slots)
            stop = min(start + carried_out, end)
            yield Window(start=start, stop=stop, end=end)
            start = stop


def _slots(hours: float | None, slot_length: float, otherwise: int) -> int:
    return otherwise if hours is None else max(round(hours / slot_length), 1)


WHOLE_PERIOD = Horizon()
"""Everything in one plan, as hindsight allows."""
EVERY_DAY = Horizon(planned=48.0, carried_out=24.0)
"""Two days planned at every midnight: a day of foresight left when the next plan begins."""
