"""The table and the figure of what faults do to each method."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hemma.checkpoint import write_atomically
from hemma.report.drawing.canvas import drawing_style, save
from hemma.report.methods import in_order
from hemma.report.numbers import decimals, fine, percent
from hemma.report.tables.cells import in_markdown
from hemma.studies.robustness.figure import robustness_figure
from hemma.studies.robustness.records import Robustness, load_robustness

TABLE_FILE = "robustness.md"


@dataclass(frozen=True)
class Met:
    """A method under one fault, over all homes and runs."""

    share: float | None
    """Mean share of savings."""
    worst: float | None
    """Of all runs."""
    deviation: float | None
    """Mean X3 [degC]."""
    interventions: float | None
    """Slots a run in which the safety layer changed something."""


def write_robustness_report(folder: Path) -> Robustness:
    """Write the figure and the table of what ``robustness.json`` holds."""
    found = load_robustness(folder)
    shares = [[met(found, fault, method).share for method in shown(found)] for fault in found.faults]
    with drawing_style():
        figure = robustness_figure(found.faults, shown(found), np.asarray(shares, float))
        save(figure, folder / "figures", "robustness")
    write_atomically(folder / TABLE_FILE, robustness_markdown(found).encode())
    return found


def shown(found: Robustness) -> list[str]:
    """The methods in the order of the report."""
    return in_order(found.methods)


def met(found: Robustness, fault: str, method: str) -> Met:
    """What a method makes of a fault; every home counts the same."""
    entries = [
        table.methods[method]
        for home in found.homes.values()
        for table in home.faults
        if table.fault == fault and method in table.methods
    ]
    runs = [run.share_of_savings for entry in entries for run in entry.runs]
    return Met(
        share=_mean([entry.mean.share_of_savings for entry in entries]),
        worst=None if _mean(runs) is None else min(run for run in runs if run is not None),
        deviation=_mean([entry.mean.mean_temperature_deviation for entry in entries]),
        interventions=_mean([entry.interventions for entry in entries]),
    )


def robustness_rows(found: Robustness) -> list[tuple[str, ...]]:
    """A row a fault: for each method the mean share, the worst run's, the deviation and the interventions."""
    return [(fault, *(_cell(met(found, fault, method)) for method in shown(found))) for fault in found.faults]


def robustness_markdown(found: Robustness) -> str:
    """The table, and what the faults are."""
    table = in_markdown(("Fault", *shown(found)), robustness_rows(found))
    first = next(iter(found.homes.values()))
    meanings = "\n".join(f"- {one.fault}: {one.meaning}" for one in first.faults)
    return f"{LEGEND}\n\n{table}\n\n{meanings}\n"


LEGEND = (
    "Mean share of savings at the same deviation in the home as it is under the fault (worst run), mean "
    "deviation in °C, slots in which the safety layer intervened."
)


def _cell(one: Met) -> str:
    changes = decimals(one.interventions, 0)
    return f"{percent(one.share)} ({percent(one.worst)}), {fine(one.deviation)}, {changes}"


def _mean(values: list[float | None]) -> float | None:
    """Missing where any is: the mean of the rest would flatter."""
    present = [value for value in values if value is not None]
    return float(np.mean(present)) if values and len(present) == len(values) else None
