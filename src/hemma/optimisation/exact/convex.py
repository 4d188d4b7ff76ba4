"""Many convex piecewise linear functions of one variable at once, each as its slopes in rising order."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Int

EMPTY = 1e-12
"""Pieces shorter than this are rounding."""

Row = Float[np.ndarray, "functions"]
Pieces = Float[np.ndarray, "functions pieces"]


@dataclass(frozen=True)
class Convex:
    """Functions on intervals that begin at 0: the value there, then pieces of a slope and a length each."""

    start: Row
    slopes: Pieces
    """Rising along a row; pieces without length come last."""
    lengths: Pieces

    @classmethod
    def zero(cls, length: float) -> "Convex":
        """One function, 0 on [0, ``length``]."""
        return cls(np.zeros(1), np.zeros((1, 1)), np.full((1, 1), length))

    def of(self, functions: Int[np.ndarray, "functions"]) -> "Convex":
        """Some of them, in this order."""
        return Convex(self.start[functions], self.slopes[functions], self.lengths[functions])

    def raised(self, by: Row) -> "Convex":
        """Plus a constant each."""
        return replace(self, start=self.start + by)

    def at(self, points: Float[np.ndarray, "points"]) -> Float[np.ndarray, "functions points"]:
        """Their values at the same points."""
        inside = np.clip(points[:, None] - self._begins()[:, None], 0.0, self.lengths[:, None])
        return self.start[:, None] + np.einsum("fk,fpk->fp", self.slopes, inside)

    def kinks(self) -> Float[np.ndarray, "points"]:
        """Every point at which one of them may bend, and both ends."""
        ends = np.cumsum(self.lengths, axis=1)
        return np.unique(np.round(np.concatenate([[0.0], ends.ravel()]), 11))

    def convolved(self, slopes: Pieces, lengths: Pieces, cut: Row, length: float) -> "Convex":
        """Least sum with a second function over all ways to share the variable, on a shorter interval.

        The second function is 0 at its left end and has these pieces, in any order. ``cut`` is taken off at
        the left, where an interval of exactly ``length`` begins: what rounding takes from it would grow with
        every slot.
        """
        slopes = np.concatenate([self.slopes, slopes], axis=1)
        lengths = np.concatenate([self.lengths, lengths], axis=1)
        order = np.argsort(np.where(lengths > EMPTY, slopes, np.inf), axis=1, kind="stable")
        slopes, lengths = np.take_along_axis(slopes, order, 1), np.take_along_axis(lengths, order, 1)
        ends = np.cumsum(lengths, axis=1)
        left = np.clip(cut[:, None] - (ends - lengths), 0.0, lengths)
        right = np.clip(ends - cut[:, None] - length, 0.0, lengths)
        start = self.start + np.sum(slopes * left, axis=1)
        found = _packed(start, slopes, np.maximum(lengths - left - right, 0.0))
        total = np.sum(found.lengths, axis=1, keepdims=True)
        exact = np.where(total > 0, length / np.maximum(total, EMPTY), 1.0)
        return replace(found, lengths=found.lengths * exact)

    def bent(self, low: float, high: float, slope: float) -> "Convex":
        """Plus ``slope`` times the distance from [``low``, ``high``]."""
        begins = self._begins()
        edges = ((-np.inf, low, -slope), (low, high, 0.0), (high, np.inf, slope))
        inside = [np.minimum(begins + self.lengths, b) - np.maximum(begins, a) for a, b, _ in edges]
        slopes = np.concatenate([self.slopes + added for *_, added in edges], axis=1)
        away = max(low, 0.0) + max(-high, 0.0)
        return _packed(self.start + slope * away, slopes, np.maximum(np.concatenate(inside, axis=1), 0.0))

    def stretched(self, by: float) -> "Convex":
        """f(x / ``by``)."""
        return replace(self, slopes=self.slopes / by, lengths=self.lengths * by)

    def _begins(self) -> Pieces:
        return np.cumsum(self.lengths, axis=1) - self.lengths


def _packed(start: Row, slopes: Pieces, lengths: Pieces) -> Convex:
    """Empty pieces to the end, and as few columns as the longest row needs."""
    lengths = np.where(lengths > EMPTY, lengths, 0.0)
    order = np.argsort(lengths == 0, axis=1, kind="stable")
    width = max(int(np.max(np.count_nonzero(lengths, axis=1))), 1)
    order = order[:, :width]
    return Convex(start, np.take_along_axis(slopes, order, 1), np.take_along_axis(lengths, order, 1))
