"""Which controller a home should have, in plain words and as a table."""

from functools import partial

from hemma.report.comfort import at_equal_comfort
from hemma.report.numbers import degrees, money
from hemma.results.results import HomeResults

DIGITS = 3
"""Of a day's cost: methods differ by cents."""
HEADINGS = ("Method, the simplest first", "Cost a day", "More than the least", "Mean deviation")


def recommendation_sentence(name: str, home: HomeResults) -> str:
    """What to take, and why; empty where nothing was judged."""
    found = home.recommendation
    if found is None:
        return ""
    least = min(found.judged, key=lambda one: one.daily_cost or 0.0)
    chosen = next(one for one in found.judged if one.method == found.method)
    cost, lowest = (money(one.daily_cost, home.currency, DIGITS) for one in (chosen, least))
    costs = (
        f"it cost {cost} a day {at_equal_comfort(home)} on {found.days} training days that it had not been "
        "fitted to"
    )
    if chosen.daily_cost == least.daily_cost and chosen is not least:
        why = f"{costs}, no more than any other, and of those that cost as little it keeps comfort best"
    elif chosen is least:
        why = f"{costs}, the least of all, and no simpler method came within a standard error of it"
    else:
        why = (
            f"{costs}; {least.method} cost {lowest}, but the difference is within its standard error, and "
            "the simpler method is taken"
        )
    return f"Recommended for {name}: {found.method}, since {why}."


def recommendation_rows(home: HomeResults) -> list[tuple[str, ...]]:
    """The cells of the table, a row each method."""
    judged = home.recommendation.judged if home.recommendation else ()
    cost = partial(money, currency=home.currency, digits=DIGITS)
    return [
        (
            one.method,
            cost(one.daily_cost),
            cost(one.excess) + (f" ± {cost(one.standard_error)}" if one.excess else ""),
            degrees(one.mean_temperature_deviation),
        )
        for one in judged
    ]
