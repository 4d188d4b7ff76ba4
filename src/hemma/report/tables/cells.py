"""The cells of all tables: a value, and below it something smaller."""

from collections.abc import Callable
from dataclasses import dataclass

from hemma.evaluation import Interval
from hemma.report.numbers import DASH, decimals, degrees, fine, hundredths, money, percent

Bounds = tuple[float, float] | Interval | None
"""Low and high end of an interval, or None where there is none."""


@dataclass(frozen=True)
class Cell:
    """One entry of a table."""

    value: str
    """The mean over the seeds with its unit, or an en dash."""
    detail: str = ""
    """The 95 % interval ``[low, high]`` in the same unit, if there is one; beside the interquartile mean of
    the cost that of the share of savings, beside the worst seed's cost its gap."""

    def __str__(self) -> str:
        """Both, as printed on one line."""
        return f"{self.value} {self.detail}".rstrip()


@dataclass(frozen=True)
class Notation:
    """How a kind of number is written."""

    full: Callable[[float | None], str]
    """With its unit."""
    bare: Callable[[float | None], str]
    """Without it."""

    def range(self, bounds: Bounds) -> str:
        """``[low, high]``, or nothing."""
        if bounds is None:
            return ""
        low, high = (bounds.low, bounds.high) if isinstance(bounds, Interval) else bounds
        return f"[{self.bare(low)}, {self.bare(high)}]"

    def cell(self, mean: float | None, bounds: Bounds = None) -> Cell:
        """The mean with its unit above its interval."""
        return Cell(self.full(mean), self.range(bounds))


PERCENT = Notation(percent, hundredths)
DEGREES = Notation(degrees, fine)
CHANCE = Notation(lambda value: decimals(value, 2), lambda value: decimals(value, 2))
NOTHING = Cell(DASH)


def in_money(currency: str) -> Notation:
    """Amounts of a currency, to the cent."""
    return Notation(lambda value: money(value, currency), lambda value: decimals(value, 2))
