"""The figures and the table of a transfer folder."""

from collections.abc import Sequence
from pathlib import Path

from hemma.checkpoint import write_atomically
from hemma.report.drawing.canvas import drawing_style, save
from hemma.report.numbers import hundredths
from hemma.report.tables.cells import DEGREES, PERCENT, Cell, in_markdown
from hemma.studies.transfer.figure import transfer_figure
from hemma.studies.transfer.records import Transfer, load_transfer
from hemma.studies.transfer.reward_figure import BatteryMap, ComfortMap, battery_figure, comfort_figure

FIGURES, TABLE_FILE = "figures", "transfer.md"
HEADINGS = ("Home", "Method", "Runs", "Share of savings", "Mean deviation")


def write_maps(folder: Path, battery: Sequence[BatteryMap], comfort: ComfortMap) -> None:
    """Write the reward maps as PNG and SVG."""
    with drawing_style():
        save(battery_figure(battery), folder / FIGURES, "reward-battery")
        save(comfort_figure(comfort), folder / FIGURES, "reward-comfort")


def write_transfer_report(folder: Path) -> Transfer:
    """Write the figure and the table of what ``transfer.json`` holds."""
    found = load_transfer(folder)
    with drawing_style():
        save(transfer_figure(found), folder / FIGURES, "transfer")
    write_atomically(folder / TABLE_FILE, transfer_markdown(found).encode())
    return found


def transfer_rows(found: Transfer) -> list[tuple[str, ...]]:
    """The cells of the table below ``HEADINGS``: means and 95 % intervals."""
    return [
        (
            name,
            title,
            str(len(method.runs)),
            str(PERCENT.of(method, lambda it: it.share_of_savings)),
            str(DEGREES.of(method, lambda it: it.mean_temperature_deviation)),
        )
        for name, place in found.places.items()
        for title, method in place.methods.items()
    ]


def transfer_markdown(found: Transfer) -> str:
    """The same as a table in Markdown, with what is compared seed by seed below it."""
    paired = "\n".join(f"- {line}" for line in paired_lines(found))
    return f"{in_markdown(HEADINGS, transfer_rows(found))}\n\n{paired}\n"


def paired_lines(found: Transfer) -> list[str]:
    """What each method keeps more than the policy carried over, in points of the savings, seed by seed."""
    return [
        f"{name}: {pair.method} less {pair.over}: "
        f"{Cell(hundredths(pair.mean), PERCENT.range(pair.interval))} points"
        for name, place in found.places.items()
        for pair in place.paired
    ]
