"""How to read the report: what each number means, and what it does not say."""

from collections.abc import Iterable

from hemma.report.comfort import REACHABLE
from hemma.report.methods import in_order, meaning_of
from hemma.report.numbers import DASH
from hemma.report.tables.aggregate import INTERVALS
from hemma.results.results import HomeResults, Results

_METRICS = {
    "Energy cost": (
        "X1 + X2 summed over the test period: X1 is what the energy bought costs minus what the energy sold "
        "earns, X2 is the ageing of the battery. Negative means that the home earns money."
    ),
    "Mean deviation, total deviation": (
        "X3 is the distance of the indoor temperature from the comfort band at the end of a slot, 0 inside "
        "the band. The mean deviation is the mean of X3 over all slots, the total is the sum."
    ),
    "Optimum, perfect information": (
        "The least cost that any controller could have reached had it known all prices, weather and loads of "
        "the test period beforehand, with the least deviation that is possible. It is proven by branch and "
        "bound, not estimated; where a gap to the proven lower bound is left, the table says 'not proven'. "
        "Nobody can run it: it is the end of the scale."
    ),
    "Equal comfort": (
        "A home that drifts warm in summer or cold in winter looks cheap. So each method is compared with "
        "perfect information that may cause the same total deviation D as the method itself did: optimum(D). "
        "no-battery(D) is the same problem without the battery. Where even perfect information misses the "
        f"comfort band by more than {REACHABLE:g} °C on average, costs are compared at the same deviation, "
        "and nobody speaks of equal comfort."
    ),
    "Gap to optimum": "(cost − optimum(D)) / |optimum(D)|: what not knowing the future costs.",
    "Share of savings": (
        "(no-battery(D) − cost) / (no-battery(D) − optimum(D)): 100 % is perfect information, 0 % is no "
        "better than having no battery. Unlike the gap it keeps its meaning where the optimum is near zero."
    ),
    "Regret and its parts": (
        "cost − optimum(D) in money. Not knowing the future: the regret of a planner with the best causal "
        "forecast and the true building. Identified thermal model: what that planner loses by planning "
        "through the identified network. Policy: the rest, by which a method decides worse than that "
        "planner. A part below zero saves. The policy part of a planner's own row is zero."
    ),
    "Interquartile mean, worst seed": (
        "The interquartile mean leaves out the best and the worst quarter of the runs, so that one run gone "
        "astray does not move it. The worst seed is the run farthest from optimum(D): what "
        "an owner with bad luck gets."
    ),
    "Probability of improvement": (
        "How probably a run of one method, drawn at random, has a lower regret than a run of another; ties "
        "count half. 0.5 means no difference."
    ),
}
_DASH = (
    "No such number: a method without training or without seeds, the worst of a single run, a gap to an "
    "optimum of zero, a share of savings where a battery can save nothing, or a result that is not in "
    "the folder."
)

LIMITS = (
    "The home is simulated: the controllers act on a thermal model and a battery model, not on a building.",
    "One test period, one climate, one tariff: other seasons and prices are not measured here.",
    "The intervals cover the randomness of training alone, not that of weather, prices or homes; those from "
    "home to home cover what differs between these homes, and several homes may share weather, prices and "
    "building.",
)


def metric_meanings(results: Results) -> dict[str, str]:
    """What each number means, with the kind of interval that these results have."""
    return {**_METRICS, "Seeds and intervals": _seeds_and_intervals(results), f"En dash ({DASH})": _DASH}


def _seeds_and_intervals(results: Results) -> str:
    over_homes = (
        f" Over several homes every home counts the same: {INTERVALS}. Homes that share these are fewer than "
        "they look, and it is too narrow for homes in general."
        if results.aggregate is not None
        else ""
    )
    return (
        "A method that learns is trained anew with several random seeds. The number is the mean; in brackets "
        f"stands the 95 % interval of that mean ({results.interval_kind}). Methods without randomness "
        "run once and have no interval. An interval of a deviation that reaches below zero only says that "
        f"there are few seeds: no deviation is negative.{over_homes}"
    )


def method_meanings(results: Results) -> dict[str, str]:
    """The methods of all homes, each with what it is; the length of the demonstrations where it is known."""
    homes = results.finished.values()
    named = (name for home in homes for name in (*home.methods, *(it.method for it in home.data_efficiency)))
    meanings = {name: meaning_of(name) for name in in_order(dict.fromkeys(named))}
    return {name: text + _days(name, homes) for name, text in meanings.items() if text is not None}


def _days(method: str, homes: Iterable[HomeResults]) -> str:
    days = sorted({home.demonstration_days[method] for home in homes if method in home.demonstration_days})
    return f" ({' or '.join(f'{length:g}' for length in days)} days)" if days else ""


def data_facts(home: HomeResults) -> dict[str, str]:
    """Where a home's data come from and how they were used."""
    periods = {"Training period": home.training, "Test period": home.test}
    return {
        "Source": home.source or "not stated",
        "Slot length": f"{home.slot_length_h:g} h",
        **{name: f"{one.slots} slots from {one.start}" for name, one in periods.items() if one is not None},
        "Comfort band": f"{home.comfort_c[0]:g} to {home.comfort_c[1]:g} °C",
    }
