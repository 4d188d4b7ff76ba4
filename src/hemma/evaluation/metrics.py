"""What is reported of a method, with both distances to the optimum taken at equal comfort."""

from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np

from hemma.evaluation.regret import regret
from hemma.evaluation.replay import Outcome
from hemma.record import Number, Range, Record

NEGLIGIBLE = 1e-6
"""Costs nearer to zero than this [currency] are no denominator: a millionth is below any tariff's digits."""


@dataclass(frozen=True)
class EqualComfort:
    """Perfect information with the total deviation D that the measured method itself caused."""

    optimum: float
    """optimum(D), the least cost with at most that deviation [currency]."""
    no_battery: float
    """no_battery(D), the same without a battery [currency]."""
    gap: float = 0.0
    """The larger relative gap of the two that was not proved."""


Value = TypeVar("Value")


class Measures(Record, Generic[Value]):
    """Something about every metric: its value in a run, a mean, an interval. The one list of metrics."""

    energy_cost: Value | None = None
    """Sum of X1 + X2 over the period [currency], objective (1)."""
    transaction_cost: Value | None = None
    """Sum of X1 [currency]."""
    battery_cost: Value | None = None
    """Sum of X2 [currency]."""
    mean_temperature_deviation: Value | None = None
    """Mean of X3 over the slots [degC], the paper's MTD."""
    total_temperature_deviation: Value | None = None
    """D, sum of X3 [degC], objective (2)."""
    gap_to_optimum: Value | None = None
    """(cost - optimum(D)) / |optimum(D)|, a fraction; None where optimum(D) is zero."""
    share_of_savings: Value | None = None
    """(no_battery(D) - cost) / (no_battery(D) - optimum(D)); None where a battery saves nothing."""
    regret: Value | None = None
    """cost - optimum(D) [currency]: what perfect information would have saved at equal comfort."""
    reference_gap: Value | None = None
    """Relative gap up to which optimum(D) and no_battery(D) are proved; above 1e-6 they are not proven."""
    seconds_to_train: Value | None = None
    """Wall-clock time of the training [s], compilation included; None without training."""


Metrics = Measures[Number]
"""Of one run, or means over the runs of a method; None where undefined."""
Intervals = Measures[Range]
"""The 95 % intervals of the means."""


def measure(outcome: Outcome, reference: EqualComfort, seconds_to_train: float | None = None) -> Metrics:
    """The metrics of ``outcome``; ``reference`` must be solved for ``outcome.total_deviation``."""
    cost = float(np.sum(outcome.cost))
    return Metrics(
        energy_cost=cost,
        transaction_cost=float(np.sum(outcome.transaction)),
        battery_cost=float(np.sum(outcome.ageing)),
        mean_temperature_deviation=float(np.mean(outcome.temperature_deviation)),
        total_temperature_deviation=outcome.total_deviation,
        gap_to_optimum=_ratio(cost - reference.optimum, abs(reference.optimum)),
        share_of_savings=_ratio(reference.no_battery - cost, reference.no_battery - reference.optimum),
        regret=regret(cost, reference.optimum),
        reference_gap=reference.gap,
        seconds_to_train=seconds_to_train,
    )


def _ratio(numerator: float, denominator: float) -> float | None:
    """The fraction, or None where the denominator says nothing (also a negative benefit of a battery)."""
    return numerator / denominator if denominator > NEGLIGIBLE else None
