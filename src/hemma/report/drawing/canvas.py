"""Figures without pyplot: the style of all of them, and how they reach the disk."""

import io
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from jaxtyping import Shaped
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.dates import HourLocator, num2date
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from hemma.checkpoint import write_atomically
from hemma.report.numbers import plain

DOTS_PER_INCH = 180
PANEL_WIDTH, FULL_WIDTH = 5.4, 9.2
"""Widths [inch] of half and whole figures."""
INK, FAINT, GRID = "#222222", "#666666", "#E2E2E2"
LINEAR_BELOW = 0.001
"""Mean deviation [degC] below which its axis is linear, so that zero has a place."""

_STYLE: dict[Any, Any] = {
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": 9.0,
    "axes.titlesize": 10.0,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.labelsize": 9.0,
    "axes.labelcolor": INK,
    "axes.edgecolor": FAINT,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": GRID,
    "grid.linewidth": 0.7,
    "xtick.color": FAINT,
    "ytick.color": FAINT,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "legend.frameon": False,
    "legend.fontsize": 8.5,
    "legend.handlelength": 2.4,
    "legend.columnspacing": 1.4,
    "text.color": INK,
    "text.parse_math": False,
    "figure.constrained_layout.h_pad": 0.06,
    "svg.hashsalt": "hemma",
    "svg.fonttype": "path",
}


@contextmanager
def drawing_style() -> Iterator[None]:
    """The style inside the block; the caller's Matplotlib settings are as they were behind it."""
    with mpl.rc_context():
        mpl.rcdefaults()
        mpl.rcParams.update(_STYLE)
        yield


def new_figure(width: float, height: float) -> Figure:
    """A figure of a size [inch] that belongs to nobody's pyplot."""
    return Figure(figsize=(width, height), layout="constrained")


def single(width: float, height: float, draw: Callable[[Axes], None]) -> Figure:
    """A figure of a size [inch] with one pair of axes."""
    figure = new_figure(width, height)
    draw(figure.add_subplot())
    return figure


def save(figure: Figure, folder: Path, name: str) -> bytes:
    """Write ``name.png`` and ``name.svg``, the same bytes for the same numbers; returns the SVG.

    The layout is found once and then frozen: finding it again for each format takes longer than drawing.
    """
    png, svg = io.BytesIO(), io.BytesIO()
    figure.draw_without_rendering()
    figure.set_layout_engine(None)
    figure.savefig(png, format="png", dpi=DOTS_PER_INCH)
    figure.savefig(svg, format="svg", metadata={"Date": None, "Creator": "Hemma"})
    write_atomically(folder / f"{name}.png", png.getvalue())
    write_atomically(folder / f"{name}.svg", svg.getvalue())
    return svg.getvalue()


def literal(text: str) -> str:
    """The text as it is, for a place where Matplotlib looks for formulas."""
    return text.replace("$", r"\$")


def legend_above(axes: Axes, columns: int) -> None:
    """The legend in rows between title and axes, where it hides no data."""
    handles, _ = axes.get_legend_handles_labels()
    if not handles:
        return
    rows = -(-len(handles) // columns)
    axes.legend(
        loc="lower left", bbox_to_anchor=(-0.01, 1.0), ncols=columns, borderaxespad=0.1, borderpad=0.2
    )
    axes.set_title(axes.get_title(loc="left"), pad=7.0 + 14.0 * rows)


def plain_numbers(axis: Axis) -> None:
    """Numbers without powers of ten beside a logarithmic axis, and no marks between them."""
    axis.set_major_formatter(lambda value, _: plain(value))
    axis.set_minor_locator(NullLocator())


def label_deviation(axes: Axes) -> None:
    """Numbers and name of the mean deviation below an axis that is linear below ``LINEAR_BELOW``."""
    plain_numbers(axes.xaxis)
    axes.set_xlabel(f"Mean deviation (°C, linear below {plain(LINEAR_BELOW)})")


def on_white(pad: float) -> dict[str, Any]:
    """The ground of a text that stands above lines; ``pad`` [point] wider than the text on all sides."""
    return {"facecolor": "white", "edgecolor": "none", "pad": pad}


def days_below(axes: Axes, first: np.datetime64, last: np.datetime64) -> None:
    """A local time axis from ``first`` to ``last`` with at most about eight named days."""
    days = float((last - first) / np.timedelta64(1, "D"))
    axes.set_xticks(midnights(first, last)[:: max(1, round(days / 7))])
    axes.set_xlim(first, last)  # pyright: ignore[reportArgumentType]
    if days <= 8:
        axes.xaxis.set_minor_locator(HourLocator(byhour=(6, 12, 18)))
    axes.xaxis.set_major_formatter(lambda days, _: _day_name(days))


def midnights(first: np.datetime64, last: np.datetime64) -> Shaped[np.ndarray, "days"]:
    """All midnights from ``first`` to ``last``."""
    day = np.timedelta64(1, "D")
    every = np.arange(first.astype("datetime64[D]"), last + day, day)
    return every[(every >= first) & (every <= last)]


def say_nothing_to_show(axes: Axes, reason: str) -> None:
    """An empty panel that says why it is empty."""
    axes.set_axis_off()
    axes.text(0.5, 0.5, reason, ha="center", va="center", transform=axes.transAxes, color=FAINT)


def _day_name(days: float) -> str:
    moment = num2date(days)
    return f"{moment:%a} {moment.day} {moment:%b}"
