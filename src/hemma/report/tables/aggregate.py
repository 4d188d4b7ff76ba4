"""Every method over all homes of a results folder, as text, and the main one against the others."""

from collections.abc import Iterable

from hemma.report.numbers import DASH, hundredths, percent
from hemma.report.tables.cells import DEGREES, NOTHING, PERCENT, Cell
from hemma.results.findings import AggregateMethod, PairedDifference
from hemma.results.results import Results

PAIRED_HEADINGS = ("Against", "Points of the share of savings", "From home to home", "Better on")
INTERVALS = (
    "in brackets the 95 % interval of the mean for other seeds on the same homes; 'from home to home' is the "
    "95 % interval that the differences between these homes give, which leaves out all that they share: "
    "weather, prices, building"
)
"""What the two intervals of the table are over."""


def aggregate_rows(results: Results) -> dict[str, dict[str, Cell]]:
    """By method and heading; nothing for a single home."""
    found = results.aggregate.methods if results.aggregate else {}
    return {name: _cells(results, name, method) for name, method in found.items()}


def paired_rows(results: Results, main: str) -> dict[str, tuple[Cell, ...]]:
    """By other method what stands below ``PAIRED_HEADINGS`` from the second on."""
    paired = results.aggregate.paired if results.aggregate else ()
    return {name: _paired_cells(pair) for name, pair in differences_of(main, paired).items()}


def differences_of(method: str, paired: Iterable[PairedDifference]) -> dict[str, PairedDifference]:
    """By the other method how much more of the savings ``method`` keeps; pairs the other way are turned."""
    known = [pair for pair in paired if pair.metric == "share_of_savings" and pair.mean is not None]
    turned = {pair.method: _turned(pair) for pair in known if pair.over == method}
    return {pair.over: pair for pair in known if pair.method == method} | turned


def worst_over_homes(results: Results, method: str) -> Cell:
    """The run that keeps the least of the possible savings, with home and seed; a dash if none has any."""
    shares = [
        (run.share_of_savings, name, run.seed)
        for name, home in results.finished.items()
        if method in home.methods
        for run in home.methods[method].runs
        if run.share_of_savings is not None
    ]
    if not shares:
        return NOTHING
    share, home, seed = min(shares, key=lambda worst: worst[0])
    return Cell(percent(share), home if seed is None else f"{home}, seed {seed}")


def _cells(results: Results, name: str, found: AggregateMethod) -> dict[str, Cell]:
    share, gap, deviation = found.share_of_savings, found.gap_to_optimum, found.mean_temperature_deviation
    return {
        "Share of savings": PERCENT.cell(share.mean, share.interval),
        "From home to home": Cell(PERCENT.range(share.interval_over_homes) or DASH),
        "Interquartile mean": Cell(percent(share.interquartile_mean)),
        "Worst run": worst_over_homes(results, name),
        "Gap to optimum": PERCENT.cell(gap.mean, gap.interval),
        "Mean deviation": DEGREES.cell(deviation.mean, deviation.interval),
    }


def _paired_cells(pair: PairedDifference) -> tuple[Cell, ...]:
    known = [gain for gain in pair.differences.values() if gain is not None]
    better = f"{sum(gain > 0 for gain in known)} of {len(known)} homes"
    return Cell(hundredths(pair.mean)), Cell(PERCENT.range(pair.interval) or DASH), Cell(better)


def _turned(pair: PairedDifference) -> PairedDifference:
    return PairedDifference(
        method=pair.over,
        over=pair.method,
        metric=pair.metric,
        differences={home: None if gain is None else -gain for home, gain in pair.differences.items()},
        mean=None if pair.mean is None else -pair.mean,
        interval=None if pair.interval is None else (-pair.interval[1], -pair.interval[0]),
    )
