"""The cells of all tables: a value, and below it something smaller."""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from hemma.evaluation import Measures
from hemma.report.numbers import DASH, decimals, degrees, fine, hundredths, money, percent
from hemma.results.records import MethodRuns

Bounds = tuple[float, float] | None
"""Low and high end of an interval, or None where there is none."""
Metric = Callable[[Measures[Any]], Any]
"""Which of the metrics: a number of a run or of means, two of intervals."""


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

    least: float = -math.inf
    """What it is never below; the part of an interval that lies there cannot be true."""

    def range(self, bounds: Bounds) -> str:
        """``[low, high]``, or nothing."""
        if bounds is None:
            return ""
        low, high = (self.bare(max(bound, self.least)) for bound in bounds)
        return f"[{low}, {high}]"

    def cell(self, mean: float | None, bounds: Bounds = None) -> Cell:
        """The mean with its unit above its interval."""
        return Cell(self.full(mean), self.range(bounds))

    def of(self, method: MethodRuns, metric: Metric) -> Cell:
        """A method's mean of the metric above its interval."""
        return self.cell(metric(method.mean), metric(method.interval))


PERCENT = Notation(percent, hundredths)
DEGREES = Notation(degrees, fine, least=0.0)
"""Of deviations."""
CHANCE = Notation(lambda value: decimals(value, 2), lambda value: decimals(value, 2))
NOTHING = Cell(DASH)


def in_money(currency: str) -> Notation:
    """Amounts of a currency, to the cent."""
    return Notation(lambda value: money(value, currency), lambda value: decimals(value, 2))


def in_markdown(headings: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table as Markdown, without a line break behind its last row."""
    lines = (headings, ("---",) * len(headings), *rows)
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)
