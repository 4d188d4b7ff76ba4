"""What is said with each figure: its file name, a title, a text for those who cannot see it, a caption."""

from collections.abc import Iterable
from dataclasses import dataclass

from hemma.report.figures.panels_demonstrations import demonstration_lengths
from hemma.report.methods import in_order
from hemma.report.numbers import degrees, money, plain
from hemma.report.week import Week
from hemma.results.results import HomeResults

FROM_ZERO = "No deviation is negative: an interval that reaches below zero is drawn from zero."


@dataclass(frozen=True)
class Words:
    """The words of one figure."""

    name: str
    """File name without ending."""
    title: str
    alternative: str
    caption: str


def words_of_panels(home: HomeResults, week: Week) -> tuple[Words, ...]:
    """The words of the six panels (a) to (f), with a home's numbers in the alternative texts."""
    return (*_by_length(home), *_by_method(home), *_over_time(home, week))


def words_of_powers(week: Week) -> Words:
    """The words of the week's powers."""
    return Words(
        "powers-week",
        "PV generation, load and grid power",
        f"PV generation and load, and the grid power of {listed(week.selected)}, slot by slot for "
        f"{plain(round(week.days, 1))} days.",
        "Above: what the home cannot decide. Below: what each controller makes of it at the meter. "
        "The grey area is the buying price.",
    )


def words_of_traces(home: HomeResults, week: Week) -> Words:
    """The words of every method's week."""
    low, high = home.comfort_c
    ranges = "; ".join(
        f"{name} {plain(round(float(schedule.indoor_temperature.min()), 1))} to "
        f"{plain(round(float(schedule.indoor_temperature.max()), 1))} °C, battery "
        f"{plain(round(float(schedule.battery_energy.min()), 1))} to "
        f"{plain(round(float(schedule.battery_energy.max()), 1))} kWh"
        for name, schedule in week.schedules.items()
    )
    return Words(
        "traces-week",
        f"What every method does in week {week.number} of the test period",
        f"Ranges of indoor temperature and battery energy of each method in the week: {ranges}.",
        f"Of each method, above: indoor temperature, with the comfort band from {plain(low)} to "
        f"{plain(high)} °C; below: battery energy, with the buying price in grey. All panels share their "
        "scales; of several seeds the one of median cost is shown.",
    )


def listed(names: Iterable[str]) -> str:
    """``A, B and C``."""
    *most, last = list(names) or ["no method"]
    return f"{', '.join(most)} and {last}" if most else last


def _by_length(home: HomeResults) -> tuple[Words, Words]:
    points = sorted(demonstration_lengths(home), key=lambda point: point.days)
    costs = "; ".join(
        f"{p.method} with {plain(p.days)} days {money(p.mean.energy_cost, home.currency)}" for p in points
    )
    deviations = "; ".join(
        f"{p.method} with {plain(p.days)} days {degrees(p.mean.total_temperature_deviation)}" for p in points
    )
    return (
        Words(
            "cost-by-demonstrations",
            "(a) Energy cost against demonstration length",
            f"Energy cost by days of demonstrations: {costs or 'no such runs'}.",
            "What more days of demonstrations bring. Line: mean; whisker: 95 % interval; dot: one seed. "
            "Lines from edge to edge are methods that were not trained on several lengths; one so far off "
            "that it would flatten the rest is only named.",
        ),
        Words(
            "deviation-by-demonstrations",
            "(b) Temperature deviation against demonstration length",
            f"Total temperature deviation by days of demonstrations: {deviations or 'no such runs'}.",
            "Sum over all slots of the distance from the comfort band. The axis is linear below 1 °C, "
            f"logarithmic above. {FROM_ZERO}",
        ),
    )


def _by_method(home: HomeResults) -> tuple[Words, Words]:
    named = [(name, home.methods[name].mean) for name in in_order(home.methods)]
    costs = "; ".join(f"{name} {money(mean.energy_cost, home.currency)}" for name, mean in named)
    deviations = "; ".join(f"{name} {degrees(mean.mean_temperature_deviation)}" for name, mean in named)
    return (
        Words(
            "energy-cost",
            "(c) Energy cost of each method",
            f"Bars of the energy cost: {costs}.",
            "Bar and number: mean over the seeds. Read it together with (d): a home that is allowed to "
            "drift warm costs less.",
        ),
        Words(
            "temperature-deviation",
            "(d) Mean temperature deviation of each method",
            f"Points of the mean temperature deviation: {deviations}.",
            "Mean over all slots of the distance from the comfort band; 0 is always comfortable. The axis is "
            f"linear below 0.001 °C, logarithmic above. {FROM_ZERO}",
        ),
    )


def _over_time(home: HomeResults, week: Week) -> tuple[Words, Words]:
    low, high = home.comfort_c
    days = plain(round(week.days, 1))
    names = listed(week.selected)
    return (
        Words(
            "indoor-temperature",
            "(e) Indoor temperature",
            f"Indoor temperature of {names} over {days} days, with the comfort band from {plain(low)} "
            f"to {plain(high)} °C and the buying price.",
            f"Week {week.number} of the test period; of several seeds the one of median cost. "
            "Staying near the edge of the band needs the least energy.",
        ),
        Words(
            "battery-level",
            "(f) Battery level",
            f"Battery energy of {names} over {days} days, with the buying price.",
            "Good control fills the battery where the grey price is low and empties it where it is high. "
            "Batteries that rest are left out.",
        ),
    )
