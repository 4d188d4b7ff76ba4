"""The start of a report on several homes: every method over all of them."""

from collections.abc import Iterable
from dataclasses import dataclass

from hemma.report.methods import grouped, main_method
from hemma.report.numbers import DASH, degrees, fine, hundredths, percent
from hemma.report.page.headline import summary_cells
from hemma.report.page.markup import body, cell, figure, paragraph, row, table
from hemma.report.pictures import Pictures
from hemma.report.tables.results import Cell
from hemma.results.findings import Aggregated, AggregateMethod, PairedDifference
from hemma.results.records import Run
from hemma.results.results import Results

OVERVIEW_HEADINGS = (
    "Method",
    "Share of savings",
    "On other homes",
    "Interquartile mean",
    "Worst seed",
    "Gap to optimum",
    "Mean deviation",
)
PAIRED_HEADINGS = ("Against", "Points of the share of savings", "On other homes", "Better on")
GLANCE_HEADINGS = (
    "Home",
    "Method",
    "Energy cost",
    "Rule",
    "Perfect information",
    "Share of savings",
    "Gap to optimum",
    "Mean deviation",
)


@dataclass(frozen=True)
class WorstRun:
    """The run of a method that keeps the least of the possible savings, over all homes."""

    home: str
    run: Run


def worst_over_homes(results: Results, method: str) -> WorstRun | None:
    """The worst run by share of savings; None where no run has a share."""
    shared = [
        WorstRun(name, run)
        for name, home in results.finished.items()
        if method in home.methods
        for run in home.methods[method].runs
        if run.share_of_savings is not None
    ]
    return min(shared, key=lambda worst: worst.run.share_of_savings or 0.0) if shared else None


def overview_section(results: Results, pictures: Pictures) -> str:
    """All methods over all homes: a table, the shares of savings home by home, who beats whom, the homes."""
    return (
        _methods_table(results)
        + (figure(pictures.shares, "full") if pictures.shares else "")
        + _paired_table(results)
        + (figure(pictures.improvement, "full") if pictures.improvement else "")
        + _homes_table(results)
    )


def _methods_table(results: Results) -> str:
    aggregate = results.aggregate
    if aggregate is None or not aggregate.methods:
        return paragraph("No statistics over homes in this folder.", "faint")
    main = main_method(aggregate.methods)
    bodies = [
        body(
            [_method_row(results, name, aggregate.methods[name], name == main) for name in names],
            title,
            len(OVERVIEW_HEADINGS),
        )
        for title, names in grouped(aggregate.methods).items()
    ]
    counted = len(aggregate.homes or results.finished)
    return table(
        f"Every method over {counted} homes; mean over homes and seeds [95 % interval]",
        OVERVIEW_HEADINGS,
        bodies,
    )


def _method_row(results: Results, name: str, found: AggregateMethod, is_main: bool) -> str:
    cells = (
        _percent_cell(found.share_of_savings),
        Cell(_between(found.share_of_savings.interval_over_homes)),
        Cell(percent(found.share_of_savings.interquartile_mean)),
        _worst_cell(worst_over_homes(results, name)),
        _percent_cell(found.gap_to_optimum),
        _deviation_cell(found.mean_temperature_deviation),
    )
    return row(name, [cell(c.value, c.detail) for c in cells], "main" if is_main else "")


def _paired_table(results: Results) -> str:
    """The main method against every other, home by home."""
    aggregate = results.aggregate
    if aggregate is None or not aggregate.methods:
        return ""
    main = main_method(aggregate.methods)
    differences = differences_of(main, aggregate.paired)
    bodies = [
        body([_paired_row(name, differences[name]) for name in names], title, len(PAIRED_HEADINGS))
        for title, names in grouped(differences).items()
    ]
    caption = f"{main} against the others, home by home; percentage points, above zero {main} keeps more"
    return table(caption, PAIRED_HEADINGS, bodies) if bodies else ""


def differences_of(method: str, paired: Iterable[PairedDifference]) -> dict[str, PairedDifference]:
    """By the other method how much more of the savings ``method`` keeps; pairs the other way are turned."""
    own = {pair.over: pair for pair in paired if pair.method == method}
    turned = {pair.method: _turned(pair) for pair in paired if pair.over == method}
    known = {name: pair for name, pair in (own | turned).items() if pair.metric == "share_of_savings"}
    return {name: pair for name, pair in known.items() if pair.mean is not None}


def _turned(pair: PairedDifference) -> PairedDifference:
    interval = None if pair.interval is None else (-pair.interval[1], -pair.interval[0])
    differences = {home: None if gain is None else -gain for home, gain in pair.differences.items()}
    return PairedDifference(
        method=pair.over,
        over=pair.method,
        metric=pair.metric,
        differences=differences,
        mean=None if pair.mean is None else -pair.mean,
        interval=interval,
    )


def _paired_row(name: str, pair: PairedDifference) -> str:
    known = [gain for gain in pair.differences.values() if gain is not None]
    better = f"{sum(gain > 0 for gain in known)} of {len(known)} homes"
    return row(name, [cell(text) for text in (hundredths(pair.mean), _between(pair.interval), better)])


def _between(interval: tuple[float, float] | None) -> str:
    return DASH if interval is None else f"[{hundredths(interval[0])}, {hundredths(interval[1])}]"


def _percent_cell(found: Aggregated) -> Cell:
    return Cell(percent(found.mean), "" if found.interval is None else _between(found.interval))


def _deviation_cell(found: Aggregated) -> Cell:
    if found.interval is None:
        return Cell(degrees(found.mean))
    low, high = found.interval
    return Cell(degrees(found.mean), f"[{fine(low)}, {fine(high)}]")


def _worst_cell(worst: WorstRun | None) -> Cell:
    if worst is None:
        return Cell(DASH)
    seed = "" if worst.run.seed is None else f", seed {worst.run.seed}"
    return Cell(percent(worst.run.share_of_savings), f"{worst.home}{seed}")


def _homes_table(results: Results) -> str:
    rows = [
        row(name, [cell(text) for text in summary_cells(home)]) for name, home in results.finished.items()
    ]
    return table("The homes at a glance; means over the seeds.", GLANCE_HEADINGS, [body(rows)])
