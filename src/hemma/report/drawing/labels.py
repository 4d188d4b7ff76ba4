"""Names beside points, none on another and none crossed by the line that leads to another."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise, product

import numpy as np
from jaxtyping import Float
from matplotlib.axes import Axes

from hemma.report.drawing.canvas import FAINT, INK

_DISTANCES = (7.0, 11.0, 17.0, 25.0, 35.0, 47.0, 61.0, 77.0)
_ANGLES = tuple(np.pi / 8 * turn for turn in (0, 1, 15, 2, 14, 6, 10, 7, 9, 8, 4, 12, 3, 5, 11, 13))
"""To the right first, above and below last."""
_LEADER = 12.0
"""From this distance [point] on, a thin line leads from the point to its name."""
_SAME = 9.0
"""Points nearer than this [pixel] share a label."""
_OVERLAP, _OUTSIDE, _ON_A_LINE, _CROSSED, _STRUCK = 1000.0, 3000.0, 7.5, 500.0, 100.0
"""What a place costs beside its distance: over another name or point, outside the axes, on a line, and for
every name that a leading line crosses and every point that it strikes."""


@dataclass(frozen=True)
class Label:
    """A text for a point in data coordinates."""

    text: str
    """Formulas stand between dollar signs; other dollar signs are escaped."""
    x: float
    y: float
    colour: str = INK
    size: float = 8.0


Box = Float[np.ndarray, "4"]
"""Left, bottom, right, top [pixel]."""


def place_labels(axes: Axes, labels: Sequence[Label], lines: Sequence[Float[np.ndarray, "_ 2"]]) -> None:
    """Write the labels; ``lines`` are curves in data coordinates that are better left free.

    The limits of the axes must be final. Deterministic: a label takes the cheapest place that the ones
    before it left.
    """
    figure = axes.get_figure(root=True)
    assert figure is not None
    figure.draw_without_rendering()
    frame = np.array(axes.get_window_extent().extents)
    labels = _joined(axes, labels)
    points = [_pixel(axes, label) for label in labels]
    traced = [_dense(axes.transData.transform(line)) for line in lines if len(line)]
    track = np.concatenate(traced) if traced else np.zeros((0, 2))
    taken = _Taken(frame, track, [np.array([*(point - 4.0), *(point + 4.0)]) for point in points], [], [])
    for number, (label, point) in enumerate(zip(labels, points, strict=True)):
        spot = _Spot(number, point, _size(axes, label), figure.dpi / 72)
        offset = _cheapest(spot, taken)
        taken.names.append(spot.box(offset))
        taken.leaders.append(spot.leader(offset))
        _write(axes, label, offset)


@dataclass(frozen=True)
class _Taken:
    """What the place of a name depends on, in pixels; grows name by name."""

    frame: Box
    track: Float[np.ndarray, "points 2"]
    marks: list[Box]
    """Around the points."""
    names: list[Box]
    leaders: list[Float[np.ndarray, "_ 2"]]


@dataclass(frozen=True)
class _Spot:
    """A point that needs a name."""

    number: int
    point: Float[np.ndarray, "2"]
    size: Float[np.ndarray, "2"]
    """Of the name."""
    pixels: float
    """In a point of typography, the unit of all offsets."""

    def box(self, offset: Float[np.ndarray, "2"]) -> Box:
        """Around the name."""
        (x, y), (width, height) = self.point + self.pixels * offset, self.size
        left = x if offset[0] >= 0 else x - width
        return np.array([left - 1, y - height / 2, left + width + 1, y + height / 2])

    def leader(self, offset: Float[np.ndarray, "2"]) -> Float[np.ndarray, "more 2"]:
        """Points along the line to the name; none where it stands beside its point."""
        if np.hypot(*offset) <= _LEADER:
            return np.zeros((0, 2))
        return _dense(np.array([self.point, self.point + self.pixels * offset]))


def _cheapest(spot: _Spot, taken: _Taken) -> Float[np.ndarray, "2"]:
    """The offset of the name that costs least, the nearest of equals."""
    others = taken.marks[: spot.number] + taken.marks[spot.number + 1 :]
    best, least = np.zeros(2), np.inf
    for distance, angle in product(_DISTANCES, _ANGLES):
        offset = np.array([distance * np.cos(angle), distance * np.sin(angle)])
        box, leader = spot.box(offset), spot.leader(offset)
        cost = distance + _cost(box, taken)
        if cost < least:
            crossed = _crossings(taken.names, leader) + sum(_crossings([box], it) for it in taken.leaders)
            cost += _CROSSED * crossed + _STRUCK * _crossings(others, leader)
        if cost < least:
            best, least = offset, cost
    return best


def _joined(axes: Axes, labels: Sequence[Label]) -> list[Label]:
    """One label for points that lie on each other, three names a line; the first point carries it."""
    groups: list[list[Label]] = []
    for label in labels:
        here = _pixel(axes, label)
        near = (group for group in groups if np.hypot(*(_pixel(axes, group[0]) - here)) < _SAME)
        alike = next((group for group in near if group[0].size == label.size), None)
        if alike is None:
            groups.append([label])
        else:
            alike.append(label)
    return [replace(group[0], text=_in_lines([label.text for label in group])) for group in groups]


def _pixel(axes: Axes, label: Label) -> Float[np.ndarray, "2"]:
    return axes.transData.transform((label.x, label.y))


def _in_lines(texts: list[str]) -> str:
    names = list(dict.fromkeys(texts))
    return ",\n".join(", ".join(names[first : first + 3]) for first in range(0, len(names), 3))


def _write(axes: Axes, label: Label, offset: Float[np.ndarray, "2"]) -> None:
    is_far, is_right = float(np.hypot(*offset)) > _LEADER, offset[0] >= 0
    # From the point to the near edge of its name.
    line = {"arrowstyle": "-", "color": FAINT, "lw": 0.5, "shrinkA": 0.0, "shrinkB": 3.0}
    line["relpos"] = (0.0 if is_right else 1.0, 0.5)
    note = axes.annotate(
        label.text,
        (label.x, label.y),
        xytext=tuple(offset),
        textcoords="offset points",
        fontsize=label.size,
        parse_math=True,
        arrowprops=line if is_far else None,
    )
    note.set(ha="left" if is_right else "right", va="center", color=label.colour, zorder=6, in_layout=False)


def _crossings(boxes: Sequence[Box], line: Float[np.ndarray, "more 2"]) -> int:
    """How many of the boxes a line runs through."""
    return sum(bool(np.any(np.all((line > box[:2]) & (line < box[2:]), axis=1))) for box in boxes)


def _size(axes: Axes, label: Label) -> Float[np.ndarray, "2"]:
    """Width and height of the text [pixel]."""
    text = axes.text(label.x, label.y, label.text, fontsize=label.size, parse_math=True)
    extent = text.get_window_extent()
    text.remove()
    return np.array([extent.width, extent.height])


def _dense(track: Float[np.ndarray, "points 2"]) -> Float[np.ndarray, "more 2"]:
    """Points all along a line, about two pixels apart."""
    steps = [np.linspace(a, b, 2 + int(np.hypot(*(b - a)) / 2)) for a, b in pairwise(track)]
    return np.concatenate(steps) if steps else track


def _cost(box: Box, taken: _Taken) -> float:
    others, frame, track = np.array([*taken.marks, *taken.names]), taken.frame, taken.track
    wide = np.minimum(box[2], others[:, 2]) - np.maximum(box[0], others[:, 0])
    tall = np.minimum(box[3], others[:, 3]) - np.maximum(box[1], others[:, 1])
    overlaps = int(np.sum((wide > 0) & (tall > 0)))
    is_outside = box[0] < frame[0] or box[1] < frame[1] or box[2] > frame[2] or box[3] > frame[3]
    inside = (track >= box[:2]) & (track <= box[2:])
    crossed = int(np.sum(np.all(inside, axis=1)))
    return _OVERLAP * overlaps + _OUTSIDE * is_outside + _ON_A_LINE * crossed
