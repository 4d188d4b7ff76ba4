"""Where the regret of each causal method comes from."""

from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from hemma.methods.looks import BLUE, GREY, ORANGE, SKY
from hemma.report.comfort import at_equal_comfort
from hemma.report.drawing.canvas import INK, new_figure
from hemma.report.drawing.rows import label_rows, method_rows, rows_height, write_value
from hemma.report.figures.figure import HomeFigure, ReportSection, Words
from hemma.report.numbers import decimals, money
from hemma.results.results import HomeResults

REGRET_SECTION = ReportSection("Where the regret comes from")
PARTS = (
    ("not knowing the future", BLUE, ""),
    ("identified thermal model", SKY, "////"),
    ("policy", ORANGE, ""),
)
"""Name, colour and hatching of the three parts, in the order of ``RegretSplit.parts``."""
_EDGE: dict[str, Any] = {"edgecolor": "white", "linewidth": 0.4}


def regret_figure(home: HomeResults) -> Figure:
    """Stacked bars: parts that cost to the right of zero, parts that save to the left; a mark at the sum."""
    rows = method_rows(home.regret)
    figure = new_figure(9.2, rows_height(home.regret))
    axes = figure.add_subplot()
    for method, place in rows.places.items():
        split = home.regret[method]
        reach = _stack(axes, place, split.parts)
        if split.total is None:
            continue
        if split.parts is None:
            axes.barh(place, split.total, height=0.66, color=GREY, alpha=0.6, linewidth=0)
        axes.plot(split.total, place, "D", color="white", markeredgecolor=INK, markersize=5, zorder=4)
        write_value(axes, place, max(reach, split.total, 0.0), decimals(split.total, 2))
    label_rows(axes, rows)
    axes.axvline(0.0, color=INK, linewidth=0.9)
    axes.set_xlabel(f"Cost above perfect information {at_equal_comfort(home)} ({home.currency})")
    axes.margins(x=0.1)
    _explain(figure, home)
    return figure


def _stack(axes: Axes, place: float, parts: tuple[float, float, float] | None) -> float:
    """Draw the parts outwards from zero on either side; how far they reach to the right."""
    right = left = 0.0
    for value, (_, colour, hatch) in zip(parts or (), PARTS, strict=False):
        start = right if value >= 0 else left
        axes.barh(place, value, left=start, height=0.66, color=colour, hatch=hatch, **_EDGE)
        right, left = (right + value, left) if value >= 0 else (right, left + value)
    return right


def _explain(figure: Figure, home: HomeResults) -> None:
    handles: list[Artist] = [
        Patch(facecolor=colour, hatch=hatch, label=name, **_EDGE) for name, colour, hatch in PARTS
    ]
    if any(split.parts is None and split.total is not None for split in home.regret.values()):
        handles.append(Patch(color=GREY, alpha=0.6, linewidth=0, label="not split"))
    handles.append(Line2D([], [], marker="D", color="white", mec=INK, markersize=5, lw=0, label="sum"))
    figure.legend(handles=handles, loc="outside upper left", ncols=5)


def _words(home: HomeResults) -> Words:
    totals = "; ".join(
        f"{name} {money(split.total, home.currency)}" for name, split in home.regret.items() if split.total
    )
    return Words(
        "What stands between each method and perfect information",
        f"Stacked bars of the regret: {totals or 'no totals'}. The table below has the parts.",
        f"Regret is the cost above perfect information {at_equal_comfort(home)}. Parts right of zero cost, "
        "parts left of it save; the diamond is their sum.",
    )


REGRET = HomeFigure[HomeResults](
    name="regret",
    section=REGRET_SECTION,
    needs=lambda subject: subject.home if subject.home.regret else None,
    draw=regret_figure,
    words=_words,
    missing="The regret is not split in this folder.",
)
