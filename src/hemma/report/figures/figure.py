"""What a figure of the report is: what it needs, how it is drawn, what is said with it, where it stands."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from enum import Enum
from typing import Generic, TypeVar

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hemma.report.drawing.canvas import PANEL_WIDTH, single
from hemma.report.subject import HomeSubject
from hemma.results.results import HomeResults

Subject = TypeVar("Subject")
"""A home of a results folder, or all of them."""
Need = TypeVar("Need")


class Part(Enum):
    """The parts of the report about a home."""

    RESULTS = "what the methods did"
    BACKGROUND = "training, building and data"


@dataclass(frozen=True)
class ReportSection:
    """A section of the report; the first figure that names it says where it stands among the others."""

    title: str
    part: Part = Part.RESULTS


PANELS = ReportSection("The six panels")
LEARNING = ReportSection("Learning curves", Part.BACKGROUND)
IDENTIFICATION = ReportSection("Identification", Part.BACKGROUND)


@dataclass(frozen=True)
class Words:
    """The words of a figure."""

    title: str
    alternative: str
    """What a reader who cannot see it needs to know."""
    caption: str
    """What a reader who sees it wants to know."""


@dataclass(frozen=True)
class Picture:
    """A figure as it stands in the report."""

    svg: bytes
    words: Words


@dataclass(frozen=True)
class ReportFigure(Generic[Subject, Need]):
    """A figure, before it is known whether a results folder has what it needs."""

    name: str
    """File name without ending, and without what several homes put before it."""
    section: ReportSection | None
    """None for a figure that is written and stands in no report."""
    needs: Callable[[Subject], Need | None]
    """What it is drawn from; None where the folder does not have it."""
    draw: Callable[[Need], Figure]
    words: Callable[[Need], Words]
    missing: str = ""
    """What the report says where there is nothing to draw."""
    is_wide: bool = True
    """Whether it takes the whole width of the page."""


HomeFigure = ReportFigure[HomeSubject, Need]
"""A figure of one home."""


def half_panel(
    name: str,
    draw: Callable[[Axes, HomeResults], None],
    words: Callable[[HomeResults], Words],
    height: Callable[[HomeResults], float],
) -> HomeFigure[HomeResults]:
    """One of the panels that stand two beside each other; ``height`` is in inch."""
    return HomeFigure[HomeResults](
        name=name,
        section=PANELS,
        needs=lambda subject: subject.home,
        draw=lambda home: single(PANEL_WIDTH, height(home), lambda axes: draw(axes, home)),
        words=words,
        is_wide=False,
    )


def listed(names: Iterable[str]) -> str:
    """``A, B and C``."""
    *most, last = list(names) or ["no method"]
    return f"{', '.join(most)} and {last}" if most else last
