"""Names beside points, none on another: found by trying places around each point, nearest first."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise, product

import numpy as np
from jaxtyping import Float
from matplotlib.axes import Axes

from hemma.report.canvas import FAINT, INK

_DISTANCES = (7.0, 11.0, 17.0, 25.0, 35.0, 47.0, 61.0, 77.0)
_ANGLES = tuple(np.pi / 8 * turn for turn in (0, 1, 15, 2, 14, 6, 10, 7, 9, 8, 4, 12, 3, 5, 11, 13))
"""To the right first, above and below last."""
_LEADER = 12.0
"""From this distance [point] on, a thin line leads from the point to its name."""
_SAME = 9.0
"""Points nearer than this [pixel] share a label."""
_OVERLAP, _OUTSIDE, _ON_A_LINE = 1000.0, 3000.0, 15.0
"""What a place costs beside its distance: over another name or point, outside the axes, on a line."""


@dataclass(frozen=True)
class Label:
    """A text for a point in data coordinates."""

    text: str
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
    points = [axes.transData.transform((label.x, label.y)) for label in labels]
    occupied: list[Box] = [_around(point, 4.0) for point in points]
    traced = [_dense(axes.transData.transform(line)) for line in lines if len(line)]
    track = np.concatenate(traced) if traced else np.zeros((0, 2))
    pixels = figure.dpi / 72
    for label, point in zip(labels, points, strict=True):
        size = _size(axes, label)
        places = [_offset(distance, angle) for distance, angle in product(_DISTANCES, _ANGLES)]
        boxes = [_box(point + pixels * offset, size, offset) for offset in places]
        costs = [
            _cost(box, frame, occupied, track) + float(np.hypot(*offset))
            for box, offset in zip(boxes, places, strict=True)
        ]
        best = int(np.argmin(costs))
        occupied.append(boxes[best])
        _write(axes, label, places[best])


def _joined(axes: Axes, labels: Sequence[Label]) -> list[Label]:
    """One label for points that lie on each other, three names a line; the first point carries it."""
    groups: list[list[Label]] = []
    for label in labels:
        here = axes.transData.transform((label.x, label.y))
        near = [
            group
            for group in groups
            if group[0].size == label.size
            and np.hypot(*(axes.transData.transform((group[0].x, group[0].y)) - here)) < _SAME
        ]
        if near:
            near[0].append(label)
        else:
            groups.append([label])
    return [replace(group[0], text=_in_lines([label.text for label in group])) for group in groups]


def _in_lines(texts: list[str]) -> str:
    lines = [", ".join(texts[first : first + 3]) for first in range(0, len(texts), 3)]
    return ",\n".join(lines)


def _write(axes: Axes, label: Label, offset: Float[np.ndarray, "2"]) -> None:
    is_far = float(np.hypot(*offset)) > _LEADER
    note = axes.annotate(
        label.text,
        (label.x, label.y),
        xytext=tuple(offset),
        textcoords="offset points",
        ha="left" if offset[0] >= 0 else "right",
        va="center",
        fontsize=label.size,
        color=label.colour,
        zorder=6,
        arrowprops={"arrowstyle": "-", "color": FAINT, "lw": 0.5, "shrinkB": 3.0} if is_far else None,
    )
    note.set_in_layout(False)


def _offset(distance: float, angle: float) -> Float[np.ndarray, "2"]:
    return np.array([distance * np.cos(angle), distance * np.sin(angle)])


def _size(axes: Axes, label: Label) -> Float[np.ndarray, "2"]:
    """Width and height of the text [pixel]."""
    text = axes.text(label.x, label.y, label.text, fontsize=label.size)
    extent = text.get_window_extent()
    text.remove()
    return np.array([extent.width, extent.height])


def _box(anchor: Float[np.ndarray, "2"], size: Float[np.ndarray, "2"], offset: Float[np.ndarray, "2"]) -> Box:
    left = anchor[0] if offset[0] >= 0 else anchor[0] - size[0]
    return np.array([left - 1, anchor[1] - size[1] / 2, left + size[0] + 1, anchor[1] + size[1] / 2])


def _around(point: Float[np.ndarray, "2"], radius: float) -> Box:
    return np.array([*(point - radius), *(point + radius)])


def _dense(track: Float[np.ndarray, "points 2"]) -> Float[np.ndarray, "more 2"]:
    """Points all along a line, about four pixels apart."""
    steps = [np.linspace(a, b, 2 + int(np.hypot(*(b - a)) / 4)) for a, b in pairwise(track)]
    return np.concatenate(steps) if steps else track


def _cost(box: Box, frame: Box, occupied: list[Box], track: Float[np.ndarray, "points 2"]) -> float:
    others = np.array(occupied)
    wide = np.minimum(box[2], others[:, 2]) - np.maximum(box[0], others[:, 0])
    tall = np.minimum(box[3], others[:, 3]) - np.maximum(box[1], others[:, 1])
    overlaps = int(np.sum((wide > 0) & (tall > 0)))
    is_outside = box[0] < frame[0] or box[1] < frame[1] or box[2] > frame[2] or box[3] > frame[3]
    inside = (track >= box[:2]) & (track <= box[2:])
    crossed = int(np.sum(np.all(inside, axis=1)))
    return _OVERLAP * overlaps + _OUTSIDE * is_outside + _ON_A_LINE * crossed
