"""What is said with the figures that compare methods and with those of their training."""

import math

from hemma.report.figures.captions import Words
from hemma.report.figures.panels_curves import COST, Curves, Spread, spread_of
from hemma.report.figures.panels_homes import over_homes, shares_by_home
from hemma.report.figures.panels_improvement import Comparison
from hemma.report.figures.panels_pareto import FRONTIER, standings, sweeps_of
from hemma.report.numbers import decimals, degrees, money, percent, rough
from hemma.results.results import HomeResults, Results


def words_of_pareto(home: HomeResults) -> Words:
    """The words of cost against comfort."""
    methods = "; ".join(
        f"{m.name} {money(m.cost, home.currency)} at {degrees(m.deviation)}" for m in standings(home)
    )
    swept = "; ".join(
        f"{sweep.name}, {point.parameter.replace('beta_T', 'weight of comfort')} {rough(point.value)}: "
        f"{money(point.energy_cost, home.currency)} at {degrees(point.mean_temperature_deviation)}"
        for sweep in sweeps_of(home)
        for point in sweep.points
        if point.value is not None
    )
    has_frontier = any(sweep.name == FRONTIER for sweep in sweeps_of(home))
    frontier = (
        "No controller can stand below the black line: it is proven for each deviation. "
        if has_frontier
        else ""
    )
    return Words(
        "cost-and-comfort",
        "Cost against comfort",
        f"Energy cost at mean deviation. Methods: {methods}. Sweeps: {swept or 'none'}.",
        f"{frontier}Down is cheaper, left is more comfortable. The small marks show what one method reaches "
        "when the weight of comfort, or the band that it is given, is changed.",
    )


def words_of_regret(home: HomeResults) -> Words:
    """The words of the regret split."""
    totals = "; ".join(
        f"{name} {money(split.total, home.currency)}" for name, split in home.regret.items() if split.total
    )
    return Words(
        "regret",
        "What stands between each method and perfect information",
        f"Stacked bars of the regret: {totals or 'no totals'}. The table below has the parts.",
        "Regret is the cost above perfect information at equal comfort. Parts right of zero cost, parts left "
        "of it save; the diamond is their sum.",
    )


def words_of_improvement(comparison: Comparison, over: str) -> Words:
    """The words of the table of probabilities; ``over`` says what the runs are of."""
    pairs = "; ".join(
        f"{method} over {other} {decimals(entry.probability, 2)}"
        for (method, other), entry in comparison.pairs.items()
        if comparison.methods.index(method) < comparison.methods.index(other)
    )
    return Words(
        "probability-of-improvement",
        "How probably one method beats another",
        f"Probability that a run of the first has the lower regret: {pairs}.",
        f"Over all pairs of runs {over}, ties count half; below it the 95 % interval. One half means that "
        "nobody can tell which is better; the colour is pale where the interval holds one half and leaves it "
        "open.",
    )


def words_of_homes(results: Results) -> Words:
    """The words of the shares of savings over homes."""
    told = []
    for name, by_home in shares_by_home(results).items():
        mean = over_homes(results, name).mean
        overall = "" if mean is None else f"{percent(mean)} over all, "
        if by_home:
            told.append(f"{name} {overall}{', '.join(f'{home} {percent(s)}' for home, s in by_home.items())}")
    has_mean = any(over_homes(results, name).mean is not None for name in shares_by_home(results))
    coloured = "The coloured mark and the number are the mean over all homes. " if has_mean else ""
    return Words(
        "share-of-savings",
        "Share of savings on every home",
        f"Points of the share of savings: {'; '.join(told)}.",
        f"One grey mark a home, the mean over its seeds. {coloured}Shares far below zero are written at the "
        "left edge.",
    )


def words_of_learning(home: HomeResults, curves: Curves) -> Words:
    """The words of the learning curves."""
    ends = "; ".join(
        f"{name} {_last(spread, home.currency)} a day"
        for name, runs in curves.items()
        if (spread := spread_of(runs, COST)) is not None
    )
    return Words(
        "training-curves",
        "Learning curves",
        "Energy cost and temperature deviation on the training days over the training. Cost at the end: "
        f"{ends}.",
        "Line: mean over the seeds; area: their range; grey: the means of the other methods. Measured with "
        "the mean action on the training days, never on the test period. The shares of training make methods "
        "comparable whose iterations are of another kind.",
    )


def _last(spread: Spread, currency: str) -> str:
    """The mean at the end of the training; a dash where a learner lost itself."""
    cost = float(spread.mean[-1])
    return money(cost if math.isfinite(cost) else None, currency)


def words_of_diagnostics(names: list[str]) -> Words:
    """The words of what else the learners wrote down; ``names`` are the quantities."""
    return Words(
        "training-diagnostics",
        "What else the learners wrote down",
        f"Over the training: {', '.join(names)}.",
        "Line: mean over the seeds; area: their range. Recognised transitions near one half mean that the "
        "discriminator can no longer tell agent from expert.",
    )


def words_of_free_run() -> Words:
    """The words of the network on its own."""
    return Words(
        "free-run",
        "Free run of the identified network",
        "Measured and predicted indoor temperature for the first days, and the error over the period.",
        "The network is given the first temperature only and then runs on its own predictions.",
    )
