"""The table of results as text: the same rows on the screen and in the report."""

from dataclasses import dataclass
from pathlib import Path

from hemma.evaluation import Metrics
from hemma.report.methods import in_order
from hemma.report.numbers import DASH, money, percent, seconds
from hemma.report.tables.cells import DEGREES, NOTHING, PERCENT, Cell, Metric, in_money
from hemma.results.results import HomeResults, Results, load_results

PROVEN = 1e-6
"""A relative gap between cost and lower bound up to this is a proof."""


@dataclass(frozen=True)
class TableRow:
    """One method on one home."""

    home: str
    method: str
    measures: dict[str, Cell]
    """By heading."""


def results_table(source: Path | Results) -> list[TableRow]:
    """The rows of all homes, home by home and the methods in their usual order.

    ``source`` is a results folder or what ``load_results`` read from one. Raises ``HemmaError`` where the
    folder has no readable ``results.json``.
    """
    results = source if isinstance(source, Results) else load_results(source)
    return [
        TableRow(name, method, _measures(home, method))
        for name, home in results.finished.items()
        for method in in_order(home.methods)
    ]


def is_proven(home: HomeResults) -> bool:
    """Whether no controller can cost less than the optimum that was found; so too where no bound is known."""
    gap = home.optimum.relative_gap if home.optimum else None
    return gap is None or gap <= PROVEN


def _gap(home: HomeResults, name: str) -> Cell:
    """Gap to optimum; whoever's perfect information is not proven, or who is it, says so."""
    method = home.methods[name]
    found = PERCENT.of(method, lambda it: it.gap_to_optimum)
    if (method.mean.reference_gap or 0.0) <= PROVEN and (name != "optimum" or is_proven(home)):
        return found
    return Cell(found.value, " ".join(part for part in (found.detail, "not proven") if part))


def _measures(home: HomeResults, name: str) -> dict[str, Cell]:
    method, currency = home.methods[name], home.currency
    money_of, middle = in_money(currency), method.interquartile_mean if len(method.runs) > 1 else None
    return {
        "Seeds": Cell(str(len(method.runs)) if method.is_learned else DASH),
        "Energy cost": money_of.of(method, lambda it: it.energy_cost),
        "Trading X1": money_of.of(method, lambda it: it.transaction_cost),
        "Battery X2": money_of.of(method, lambda it: it.battery_cost),
        "Mean deviation": DEGREES.of(method, lambda it: it.mean_temperature_deviation),
        "Gap to optimum": _gap(home, name),
        "Share of savings": PERCENT.of(method, lambda it: it.share_of_savings),
        "Interquartile mean": _cost_beside(middle, currency, "share", lambda it: it.share_of_savings),
        "Worst seed": _cost_beside(method.worst_run, currency, "gap", lambda it: it.gap_to_optimum),
        "Training time": Cell(seconds(method.mean.seconds_to_train)),
    }


def _cost_beside(found: Metrics | None, currency: str, word: str, ratio: Metric) -> Cell:
    """A cost with one of the ratios; a dash where there is a single run."""
    if found is None:
        return NOTHING
    share = ratio(found)
    return Cell(money(found.energy_cost, currency), "" if share is None else f"({word} {percent(share)})")
