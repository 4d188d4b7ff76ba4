"""What is said with each figure: its file name, a title, a text for those who cannot see it, a caption."""

from dataclasses import dataclass

from hemma.report.methods import in_order
from hemma.report.numbers import degrees, money, plain
from hemma.report.panels_demonstrations import demonstration_lengths
from hemma.report.panels_time import Week
from hemma.report.results import HomeResults


@dataclass(frozen=True)
class Words:
    """The words of one figure."""

    name: str
    """File name without ending."""
    title: str
    alternative: str
    caption: str


@dataclass(frozen=True)
class HomeWords:
    """The words of all figures of a home."""

    panels: tuple[Words, ...]
    powers: Words
    training: Words
    free_run: Words


def words_of(home: HomeResults, week: Week) -> HomeWords:
    """The words for a home's figures, with its numbers in the alternative texts."""
    return HomeWords(
        panels=(*_by_length(home), *_by_method(home), *_over_time(home, week)),
        powers=Words(
            "powers-week",
            "PV generation, load and grid power",
            f"PV generation and load, and the grid power of {_names(week)}, hour by hour for a week.",
            "Above: what the home cannot decide. Below: what each controller makes of it at the meter. "
            "The grey area is the buying price.",
        ),
        training=Words(
            "training-curves",
            "Training curves",
            "Costs, losses and accuracies over the iterations of training, one line a seed.",
            "One thin line is one seed. Energy cost and deviation are those of the mean action on the "
            "training days, never on the test period. Recognised transitions near one half mean that the "
            "discriminator can no longer tell agent from expert. Long curves are drawn as means of "
            "neighbouring iterations.",
        ),
        free_run=Words(
            "free-run",
            "Free run of the identified network",
            "Measured and predicted indoor temperature for the first days, and the error over the period.",
            "The network is given the first temperature only and then runs on its own predictions.",
        ),
    )


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
            "What more days of demonstrations bring. Line: mean; whisker: 95 % interval; dot: one seed.",
        ),
        Words(
            "deviation-by-demonstrations",
            "(b) Temperature deviation against demonstration length",
            f"Total temperature deviation by days of demonstrations: {deviations or 'no such runs'}.",
            "Sum over all slots of the distance from the comfort band. The axis is linear below 1 °C, "
            "logarithmic above.",
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
            "linear below 0.001 °C, logarithmic above.",
        ),
    )


def _over_time(home: HomeResults, week: Week) -> tuple[Words, Words]:
    low, high = home.comfort_c
    days = plain(round(week.slots * home.slot_length_h / 24, 1))
    return (
        Words(
            "indoor-temperature",
            "(e) Indoor temperature",
            f"Indoor temperature of {_names(week)} over {days} days, with the comfort band from {plain(low)} "
            f"to {plain(high)} °C and the buying price.",
            f"The first {days} days of the test period; of several seeds the one of median cost. "
            "Staying near the edge of the band needs the least energy.",
        ),
        Words(
            "battery-level",
            "(f) Battery level",
            f"Battery energy of {_names(week)} over {days} days, with the buying price.",
            "Good control fills the battery where the grey price is low and empties it where it is high. "
            "Batteries that rest are left out.",
        ),
    )


def _names(week: Week) -> str:
    *most, last = week.schedules or ["no method"]
    return f"{', '.join(most)} and {last}" if most else last
