"""The figures and the table of a transfer folder."""

from collections.abc import Callable, Sequence
from pathlib import Path

from hemma.checkpoint import write_atomically
from hemma.report.drawing.canvas import drawing_style, save
from hemma.report.numbers import degrees, fine, hundredths, percent
from hemma.studies.transfer.figure import transfer_figure
from hemma.studies.transfer.records import ChangedHome, Transfer, load_transfer
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
    return [row for name, place in found.places.items() for row in _rows(name, place)]


def transfer_markdown(found: Transfer) -> str:
    """The same as a table in Markdown, with what is compared seed by seed below it."""
    rows = [HEADINGS, ("---",) * len(HEADINGS), *transfer_rows(found)]
    table = "\n".join(f"| {' | '.join(row)} |" for row in rows)
    return f"{table}\n\n" + "\n".join(f"- {line}" for line in paired_lines(found)) + "\n"


def paired_lines(found: Transfer) -> list[str]:
    """What each method keeps more than the policy carried over, in points of the savings, seed by seed."""
    return [
        f"{name}: {pair.method} less {pair.over}: "
        f"{_with_interval(pair.mean, pair.interval, hundredths)} points"
        for name, place in found.places.items()
        for pair in place.paired
    ]


def _rows(name: str, place: ChangedHome) -> list[tuple[str, ...]]:
    return [
        (
            name,
            title,
            str(len(method.runs)),
            _with_interval(
                method.mean.share_of_savings, method.interval.share_of_savings, hundredths, percent
            ),
            _with_interval(
                method.mean.mean_temperature_deviation,
                method.interval.mean_temperature_deviation,
                fine,
                degrees,
            ),
        )
        for title, method in place.methods.items()
    ]


def _with_interval(
    mean: float | None,
    interval: tuple[float, float] | None,
    bare: Callable[[float | None], str],
    full: Callable[[float | None], str] | None = None,
) -> str:
    text = (full or bare)(mean)
    return text if interval is None else f"{text} [{bare(interval[0])}, {bare(interval[1])}]"
