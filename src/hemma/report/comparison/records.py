"""The records of a comparison of several results folders."""

from dataclasses import dataclass

from hemma.evaluation import Improvement, Intervals, Metrics, Summary
from hemma.report.comparison.disagreements import Disagreement


@dataclass(frozen=True)
class MeasuredMethod:
    """A method on a home, in one folder."""

    runs: int
    mean: Metrics
    interval: Intervals
    difference: Metrics | None
    """What is more here than in the first folder: only ratios where costs cannot be compared. None in the
    first folder, and where that lacks the method."""
    improvement: Improvement | None
    """How probably a run of this folder has a lower regret than one of the first; None where it cannot be
    compared."""


@dataclass(frozen=True)
class ComparedMethod:
    """A method on a home, in all folders."""

    method: str
    found: tuple[MeasuredMethod | None, ...]
    """One a folder; None where a folder lacks the method."""


@dataclass(frozen=True)
class ComparedHome:
    """A home that the first folder shares with another."""

    home: str
    currencies: tuple[str | None, ...]
    """One a folder; None where a folder lacks the home."""
    methods: tuple[ComparedMethod, ...]
    notes: tuple[str, ...]
    """Between which folders only ratios can be compared, and why."""


@dataclass(frozen=True)
class OverHomes:
    """A method in one folder against the same method in the first, over the homes that both measured."""

    method: str
    folder: str
    homes: tuple[str, ...]
    share_of_savings: Summary
    """Of the differences home by home; the interval is from home to home."""
    improvement: Improvement | None
    """The mean over the homes; None where they were not measured on the same data."""


@dataclass(frozen=True)
class FolderComparison:
    """Everything that is said of several folders."""

    folders: tuple[str, ...]
    """The first is the one that the others are compared with."""
    disagreements: tuple[Disagreement, ...]
    homes: tuple[ComparedHome, ...]
    over_homes: tuple[OverHomes, ...]
    """Empty unless two homes or more are shared."""
    notes: tuple[str, ...]
    """Homes that some folders lack."""
