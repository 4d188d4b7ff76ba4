"""The records of ``results.json`` that compare methods: who beats whom, where regret comes from, the trade of
cost against comfort, and what holds over several homes. Older folders have none of them."""

from pydantic import Field

from hemma.evaluation import IntervalKind
from hemma.record import Number, Range, Record


class ImprovementRecord(Record):
    """How probably a run of one method has a lower regret than a run of another."""

    method: str
    over: str
    probability: Number = None
    """Over all pairs of runs; ties count half."""
    interval: Range = None


class ParetoPoint(Record):
    """One point of a sweep that trades energy cost against comfort."""

    series: str
    """``optimum`` or the method that was swept."""
    parameter: str = ""
    """What was swept."""
    value: Number = None
    energy_cost: Number = None
    """[currency] over the test period, a mean where there are several runs."""
    mean_temperature_deviation: Number = None
    """[degC]."""
    runs: int = Field(default=1, ge=1)
    schedules: tuple[str, ...] = ()
    """Paths of the runs' schedules inside the folder; none for a proven optimum."""


class Aggregated(Record):
    """One metric of a method over all seeds and homes."""

    mean: Number = None
    interval: Range = None
    """On the same homes with other seeds."""
    interval_over_homes: Range = None
    """On other homes drawn like these, with other seeds."""
    interquartile_mean: Number = None
    worst: Number = None
    """Of all runs."""


class PairedDifference(Record):
    """How much more of the possible savings one method keeps than another, home by home."""

    method: str
    over: str
    metric: str = ""
    differences: dict[str, Number] = Field(default_factory=dict)
    """By home, fractions."""
    mean: Number = None
    interval: Range = None
    """Over homes."""


class AggregateMethod(Record):
    """A method over all homes."""

    interval_kind: IntervalKind | None = None
    share_of_savings: Aggregated = Aggregated()
    gap_to_optimum: Aggregated = Aggregated()
    mean_temperature_deviation: Aggregated = Aggregated()
    regret: Aggregated = Aggregated()


class Aggregate(Record):
    """What holds over several homes."""

    homes: tuple[str, ...] = ()
    methods: dict[str, AggregateMethod] = Field(default_factory=dict)
    probability_of_improvement: tuple[ImprovementRecord, ...] = ()
    paired: tuple[PairedDifference, ...] = ()
