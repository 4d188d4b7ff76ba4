"""Every method over all homes of a results folder, as text."""

from collections.abc import Callable
from dataclasses import dataclass

from hemma.report.methods import in_order
from hemma.report.numbers import DASH, degrees, fine, hundredths, percent
from hemma.report.tables.results import Cell
from hemma.results.findings import Aggregated, AggregateMethod
from hemma.results.results import Results

AGGREGATE_HEADINGS = (
    "Method",
    "Share of savings",
    "Other homes",
    "Interquartile mean",
    "Worst run",
    "Gap to optimum",
    "Mean deviation",
)


@dataclass(frozen=True)
class AggregateRow:
    """One method over all homes."""

    method: str
    cells: tuple[Cell, ...]
    """What stands below the headings from the second on: the share's interval is about other seeds on the
    same homes, that below "Other homes" about other homes."""


def aggregate_table(results: Results) -> list[AggregateRow]:
    """The rows, methods in their usual order; none where the folder has fewer than two homes."""
    if results.aggregate is None:
        return []
    methods = results.aggregate.methods
    return [AggregateRow(name, _cells(results, name, methods[name])) for name in in_order(methods)]


def _cells(results: Results, name: str, found: AggregateMethod) -> tuple[Cell, ...]:
    return (
        _cell(found.share_of_savings, percent, hundredths),
        Cell(_range(found.share_of_savings.interval_over_homes)),
        Cell(percent(found.share_of_savings.interquartile_mean)),
        Cell(_worst(results, name)),
        _cell(found.gap_to_optimum, percent, hundredths),
        _cell(found.mean_temperature_deviation, degrees, fine),
    )


def _cell(
    found: Aggregated, full: Callable[[float | None], str], bare: Callable[[float | None], str]
) -> Cell:
    if found.interval is None:
        return Cell(full(found.mean))
    return Cell(full(found.mean), f"[{bare(found.interval[0])}, {bare(found.interval[1])}]")


def _range(bounds: tuple[float, float] | None) -> str:
    return DASH if bounds is None else f"[{hundredths(bounds[0])}, {hundredths(bounds[1])}]"


def _worst(results: Results, name: str) -> str:
    """The least share of savings of any run on any home."""
    homes = [home.methods[name].runs for home in results.finished.values() if name in home.methods]
    shares = [run.share_of_savings for runs in homes for run in runs]
    known = [share for share in shares if share is not None]
    return percent(min(known)) if len(known) == len(shares) else DASH
