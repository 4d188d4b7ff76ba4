"""Receding horizon: how far a level plans, and how much of the plan it carries out."""

from collections.abc import Iterator
from dataclasses import dataclass

from hemma.errors import HemmaError


@dataclass(frozen=True)
class Window:
    """One plan: the slots ``start`` to ``end`` are planned, those before ``stop`` carried out."""

    start: int
    stop: int
    end: int


@dataclass(frozen=True)
class Horizon:
    """Plan ``slots`` slots, carry out ``advance`` of them, plan again. Without numbers: all in one plan."""

    slots: int | None = None
    """Slots planned; None for all that are left."""
    advance: int | None = None
    """Slots carried out of each plan; None for all that were planned."""

    def __post_init__(self):
        """Refuse horizons that never arrive."""
        for name, value in (("slots", self.slots), ("advance", self.advance)):
            if value is not None and value < 1:
                raise HemmaError(f"horizon: expected {name} >= 1, got {value}; correct this setting")
        if self.slots is not None and self.advance is not None and self.advance > self.slots:
            raise HemmaError(
                f"horizon: expected advance <= slots, got {self.advance} > {self.slots}; plan at least as "
                "many slots as are carried out"
            )

    def windows(self, slots: int) -> Iterator[Window]:
        """The plans that cover a period of ``slots`` slots; those near its end are shorter."""
        start = 0
        while start < slots:
            end = slots if self.slots is None else min(start + self.slots, slots)
            stop = end if self.advance is None else min(start + self.advance, end)
            yield Window(start=start, stop=stop, end=end)
            start = stop


WHOLE_PERIOD = Horizon()
"""Everything in one plan, as hindsight allows."""
