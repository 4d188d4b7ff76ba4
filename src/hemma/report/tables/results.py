"""The table of results as text: the same rows on the screen and in the report."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from hemma.report.methods import in_order
from hemma.report.numbers import DASH, decimals, degrees, fine, hundredths, money, percent, seconds
from hemma.results.records import MethodRuns
from hemma.results.results import HomeResults, Results, load_results

TABLE_HEADINGS = (
    "Method",
    "Seeds",
    "Energy cost",
    "Trading X1",
    "Battery X2",
    "Mean deviation",
    "Gap to optimum",
    "Share of savings",
    "Interquartile mean",
    "Worst seed",
    "Training time",
)


@dataclass(frozen=True)
class Cell:
    """One entry of the table."""

    value: str
    """The mean over the seeds with its unit, or an en dash."""
    detail: str = ""
    """The 95 % interval ``[low, high]`` in the same unit, if there is one; beside the interquartile mean of
    the cost that of the share of savings, beside the worst seed's cost its gap."""

    def __str__(self) -> str:
        """Both, as printed on one line."""
        return f"{self.value} {self.detail}".rstrip()


@dataclass(frozen=True)
class Notation:
    """How a kind of number is written."""

    full: Callable[[float | None], str]
    """With its unit."""
    bare: Callable[[float | None], str]
    """Without it."""


@dataclass(frozen=True)
class TableRow:
    """One method on one home."""

    home: str
    method: str
    seeds: Cell
    energy_cost: Cell
    transaction_cost: Cell
    battery_cost: Cell
    mean_temperature_deviation: Cell
    gap_to_optimum: Cell
    share_of_savings: Cell
    interquartile_mean: Cell
    worst_seed: Cell
    seconds_to_train: Cell

    @property
    def measures(self) -> tuple[Cell, ...]:
        """The cells behind the method's name, in the order of ``TABLE_HEADINGS``."""
        return (
            self.seeds,
            self.energy_cost,
            self.transaction_cost,
            self.battery_cost,
            self.mean_temperature_deviation,
            self.gap_to_optimum,
            self.share_of_savings,
            self.interquartile_mean,
            self.worst_seed,
            self.seconds_to_train,
        )

    @property
    def cells(self) -> tuple[str, ...]:
        """The whole row as text, in the order of ``TABLE_HEADINGS``."""
        return (self.method, *(str(cell) for cell in self.measures))


def results_table(source: Path | Results) -> list[TableRow]:
    """The rows of all homes, home by home and the methods in their usual order.

    ``source`` is a results folder or what ``load_results`` read from one. Raises ``HemmaError`` where the
    folder has no readable ``results.json``.
    """
    results = source if isinstance(source, Results) else load_results(source)
    return [
        _row(name, home, method, home.methods[method])
        for name, home in results.finished.items()
        for method in in_order(home.methods)
    ]


def _row(name: str, home: HomeResults, title: str, method: MethodRuns) -> TableRow:
    mean, interval = method.mean, method.interval

    cost = Notation(lambda value: money(value, home.currency), lambda value: decimals(value, 2))
    return TableRow(
        home=name,
        method=title,
        seeds=Cell(str(len(method.runs)) if method.is_learned else DASH),
        energy_cost=_cell(mean.energy_cost, interval.energy_cost, cost),
        transaction_cost=_cell(mean.transaction_cost, interval.transaction_cost, cost),
        battery_cost=_cell(mean.battery_cost, interval.battery_cost, cost),
        mean_temperature_deviation=_cell(
            mean.mean_temperature_deviation, interval.mean_temperature_deviation, Notation(degrees, fine)
        ),
        gap_to_optimum=_cell(mean.gap_to_optimum, interval.gap_to_optimum, Notation(percent, hundredths)),
        share_of_savings=_cell(
            mean.share_of_savings, interval.share_of_savings, Notation(percent, hundredths)
        ),
        interquartile_mean=_interquartile_cell(method, home.currency),
        worst_seed=_worst_cell(method, home.currency),
        seconds_to_train=Cell(seconds(mean.seconds_to_train)),
    )


def _cell(mean: float | None, interval: tuple[float, float] | None, notation: Notation) -> Cell:
    if interval is None:
        return Cell(notation.full(mean))
    low, high = (notation.bare(bound) for bound in interval)
    return Cell(notation.full(mean), f"[{low}, {high}]")


def _interquartile_cell(method: MethodRuns, currency: str) -> Cell:
    middle = method.interquartile_mean
    if len(method.runs) < 2:
        return Cell(DASH)
    share = "" if middle.share_of_savings is None else f"(share {percent(middle.share_of_savings)})"
    return Cell(money(middle.energy_cost, currency), share)


def _worst_cell(method: MethodRuns, currency: str) -> Cell:
    worst = method.worst_run
    if worst is None:
        return Cell(DASH)
    gap = "" if worst.gap_to_optimum is None else f"(gap {percent(worst.gap_to_optimum)})"
    return Cell(money(worst.energy_cost, currency), gap)
