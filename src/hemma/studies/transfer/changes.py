"""Where a learned reward is taken: the home that it was learned in, and homes that changed in one respect.

All lie in the training period; its end measures every one of them, and no policy learns from it.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from hemma.data import Traces, split
from hemma.data.time_of_use import TimeOfUse
from hemma.errors import HemmaError
from hemma.settings.experiment import Experiment
from hemma.stages.case import HOURS_OF_A_DAY, Case, make_case

ORIGIN = "unchanged"
PEAK = (15.0, 20.0)
"""Hours of the dear time of the time-of-use tariff."""
PEAK_RATIO = 3.0
"""How many times the other hours' price it costs."""


@dataclass(frozen=True)
class Change:
    """One way in which a home differs from that in which the reward was learned."""

    name: str
    """In tables and file names."""
    meaning: str
    home: Callable[[Experiment], Experiment] = lambda experiment: experiment
    traces: Callable[[Traces], Traces] = lambda traces: traces
    is_later: bool = False
    """Whether it is the other half of the training period that is learned from."""
    is_identified: bool = False
    """Whether the building changed and its network is identified anew."""
    knows_building: bool = True
    """Whether fractions are counted from comfort as the network of this building has it, not the old one."""

    @property
    def slug(self) -> str:
        """The name in file names."""
        return self.name.replace(",", "").replace(" ", "-")


@dataclass(frozen=True)
class ChangedCase:
    """A changed home, in days of the training period alone: of its case, the "test" is their end."""

    change: Change
    case: Case


def _bigger_battery(experiment: Experiment) -> Experiment:
    return _battery(experiment, capacity=2.0, power=2.0)


def _slower_battery(experiment: Experiment) -> Experiment:
    return _battery(experiment, capacity=1.0, power=0.5)


def _battery(experiment: Experiment, capacity: float, power: float) -> Experiment:
    battery = experiment.battery
    changed = replace(
        battery,
        max_energy=capacity * battery.max_energy,
        min_energy=capacity * battery.min_energy,
        initial_energy=capacity * battery.initial_energy,
        max_charging_power=power * battery.max_charging_power,
        max_discharging_power=power * battery.max_discharging_power,
    )
    return replace(experiment, battery=changed)


def _leaky(experiment: Experiment) -> Experiment:
    building = experiment.building
    return replace(experiment, building=replace(building, conductance=1.5 * building.conductance))


def _twice_the_spread(traces: Traces) -> Traces:
    """u' = u_mean + 2 (u - u_mean), the mean over the whole period; u- keeps its ratio to u+."""
    price = np.asarray(traces.exogenous.buying_price, float)
    return _priced(traces, price.mean() + 2 * (price - price.mean()))


def _time_of_use(traces: Traces) -> Traces:
    """Two prices with the mean of the real ones."""
    tariff = TimeOfUse(1.0, PEAK_RATIO, *PEAK)
    shape = tariff.buying_price(traces.clock)
    return _priced(traces, shape * float(np.mean(traces.exogenous.buying_price)) / shape.mean())


def _priced(traces: Traces, price: np.ndarray) -> Traces:
    old = traces.exogenous
    ratio = float(np.sum(old.selling_price) / np.sum(old.buying_price))
    return replace(traces, exogenous=replace(old, buying_price=price, selling_price=ratio * price))


CHANGES = (
    Change(ORIGIN, "the home and the days that the reward was learned in"),
    Change("other month", "the same home, later days of the training period", is_later=True),
    Change("twice the battery", "twice the capacity and twice the power", home=_bigger_battery),
    Change("half the power", "the same capacity, half the power", home=_slower_battery),
    Change("leaky house", "conductance +50 %, its network identified anew", home=_leaky, is_identified=True),
    Change(
        "leaky, unnoticed",
        "conductance +50 %, actions still counted from comfort by the old network",
        home=_leaky,
        is_identified=True,
        knows_building=False,
    ),
    Change("twice the spread", "prices twice as far from their mean", traces=_twice_the_spread),
    Change(
        "time of use",
        f"two prices, {PEAK_RATIO:g} to 1 from {PEAK[0]:g} to {PEAK[1]:g} h, with the mean of the real ones",
        traces=_time_of_use,
    ),
)
"""The first is where the reward is learned."""


def changed_cases(
    experiment: Experiment, traces: Traces, changes: Sequence[Change] = CHANGES, test_from: str | None = None
) -> tuple[ChangedCase, ...]:
    """The changed homes, in the order of the changes.

    With so many days D of demonstrations and N of training, the first D days are learned from, or in the
    other month the D days from day N/2 on; the days from N/2 + D on measure.
    """
    training = split(traces, test_from).training
    day = round(HOURS_OF_A_DAY / training.slot_length)
    days, learned = training.slots // day, experiment.demonstration_days
    later = days // 2
    measured = later + learned
    if learned > later or measured >= days:
        raise HemmaError(
            f"{traces.name}: expected a training period of more than {2 * learned} days to learn from "
            f"{learned}, again from {learned} later ones, and to measure on the rest, got {days}; "
            "give longer traces, or set demonstration_days lower"
        )
    starts = training.time_stamps()[measured * day]

    def changed(change: Change) -> ChangedCase:
        days_seen = training.window(later * day if change.is_later else 0, days * day)
        return ChangedCase(change, make_case(change.home(experiment), change.traces(days_seen), starts))

    return tuple(changed(change) for change in changes)
