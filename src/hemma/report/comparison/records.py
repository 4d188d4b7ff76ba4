"""The records of a comparison of several results folders, as they are written to JSON."""

from typing import Any

from pydantic import Field

from hemma.evaluation import Intervals, Metrics
from hemma.record import Number, Range, Record


class Disagreement(Record):
    """Something that is not the same in all folders."""

    key: str
    """``hemma`` (the version), ``code`` (its source), or a setting such as ``airl.iterations``."""
    values: tuple[Any, ...]
    """One a folder; None where a folder does not have it."""


class Differences(Record):
    """What is more here than in the first folder; None where it cannot be compared."""

    energy_cost: Number = None
    """[currency]."""
    share_of_savings: Number = None
    gap_to_optimum: Number = None
    mean_temperature_deviation: Number = None
    """[degC]."""


class Chance(Record):
    """How probably a run of a folder has a lower regret than one of the first."""

    probability: Number
    interval: Range


class MeasuredMethod(Record):
    """A method on a home, in one folder."""

    runs: int
    mean: Metrics
    interval: Intervals
    difference: Differences | None
    """Only ratios where costs cannot be compared; None in the first folder, or where that lacks it."""
    improvement: Chance | None = Field(serialization_alias="probability_of_improvement")
    """None where it cannot be compared."""


class ComparedHome(Record):
    """A home that the first folder shares with another."""

    currencies: dict[str, str] = Field(exclude=True)
    """By folder."""
    notes: tuple[str, ...]
    """Between which folders only ratios can be compared, and why."""
    methods: dict[str, dict[str, MeasuredMethod]]
    """By method and folder; a folder that lacks the home or the method is left out."""


class ShareDifference(Record):
    """How much more of the savings is kept than in the first folder, mean over the homes."""

    difference: Number
    interval: Range
    """From home to home."""


class OverHomes(Record):
    """A method in one folder against the same method in the first, over the homes that both measured."""

    method: str
    folder: str
    homes: tuple[str, ...]
    share_of_savings: ShareDifference
    improvement: Chance | None = Field(serialization_alias="probability_of_improvement")
    """The mean over the homes; None where they were not measured on the same data."""


class FolderComparison(Record):
    """Everything that is said of several folders."""

    folders: tuple[str, ...]
    """The first is the one that the others are compared with."""
    disagreements: tuple[Disagreement, ...]
    notes: tuple[str, ...]
    """Homes that some folders lack."""
    homes: dict[str, ComparedHome]
    over_homes: tuple[OverHomes, ...]
    """Empty unless two homes or more are shared."""
