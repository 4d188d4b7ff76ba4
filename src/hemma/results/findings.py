"""The records of ``results.json`` that compare methods: who beats whom, where regret comes from, the trade of
cost against comfort, and what holds over several homes. Older folders have none of them."""

from pydantic import Field

from hemma.results.records import Number, Range, Record


class Improvement(Record):
    """How probably a run of one method has a lower regret than a run of another."""

    method: str
    over: str
    probability: Number = None
    """Over all pairs of runs; ties count half."""
    interval: Range = None


class RegretSplit(Record):
    """Regret = future + thermal model + policy [currency]; any part may be negative."""

    total: Number = None
    """Cost minus optimum(D)."""
    future: Number = None
    """What not knowing prices, weather and load costs."""
    thermal_model: Number = None
    """What planning with an identified instead of the true building costs."""
    policy: Number = None
    """The rest: what the controller does worse than planning with the same knowledge would."""

    @property
    def parts(self) -> tuple[float, float, float] | None:
        """Future, thermal model and policy; None unless all are known."""
        if self.future is None or self.thermal_model is None or self.policy is None:
            return None
        return self.future, self.thermal_model, self.policy


class ParetoPoint(Record):
    """One point of a sweep that trades energy cost against comfort."""

    series: str
    """``optimum`` or the method that was swept."""
    parameter: str = ""
    """What was swept."""
    value: Number = None
    energy_cost: Number = None
    mean_temperature_deviation: Number = None
    runs: int = 1


class Aggregated(Record):
    """One metric of a method over all seeds and homes."""

    mean: Number = None
    interval: Range = None
    """On the same homes with other seeds."""
    interval_over_homes: Range = None
    """On other homes drawn like these, with other seeds."""
    interquartile_mean: Number = None


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

    share_of_savings: Aggregated = Aggregated()
    gap_to_optimum: Aggregated = Aggregated()
    mean_temperature_deviation: Aggregated = Aggregated()
    regret: Aggregated = Aggregated()


class Aggregate(Record):
    """What holds over several homes."""

    homes: tuple[str, ...] = ()
    methods: dict[str, AggregateMethod] = Field(default_factory=dict)
    probability_of_improvement: tuple[Improvement, ...] = ()
    paired: tuple[PairedDifference, ...] = ()
