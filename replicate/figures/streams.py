"""Stream plots compared: the lines of a field, whose choice has ties that rounding decides, and their arrow heads.

matplotlib begins a line wherever there is room for one, and ends it where it comes too close to another. In a field
with symmetries both are ties: a relative change of 1e-14 ends a line earlier, begins another elsewhere, and moves the
arrow heads, which stand half-way along each line. What the eye sees is the field: so two sets of lines are the same if
most of them coincide, and the others run as their neighbours do.
"""

from __future__ import annotations

import numpy as np

from replicate.figures.distance import nearest, to_own_segment
from replicate.figures.polylines import Points
from replicate.figures.scaling import finite

_STEP = 4e-3
_NEAR = 5e-4
#: Of the length of the lines, as much may lie elsewhere, ...
_ELSEWHERE = 0.2
#: ... this far from the others at most, as fractions of the axes.
_APART = 0.1
_LONGER = 0.05


def heads_words(one: int, other: int) -> str:
    """Return how the number of arrow heads changed; empty if no more than that of lines may by rounding.

    Examples
    --------
    >>> heads_words(36, 37), heads_words(36, 72)
    ('', 'now has 72 arrow heads (had 36)')
    """
    return f"now has {other} arrow heads (had {one})" if abs(other - one) > 1 + _LONGER * one else ""


def field_words(one: Points, other: Points) -> str | None:
    """Return how two sets of lines differ as a field; empty if they do not, ``None`` if the lines themselves tell.

    Parameters
    ----------
    one, other
        Shape (n, 2), as fractions of the axes, in the direction of the field; a row that is not finite is a break.
    """
    first, second = _Lines(one), _Lines(other)
    lengths = len(first.points), len(second.points)
    if min(lengths) == 0 or abs(lengths[0] - lengths[1]) > _LONGER * max(lengths):
        return None
    if not (first.follow(second) and second.follow(first)):
        return None
    return "" if first.along(second) else "runs the other way now"


class _Lines:
    """Points at equal steps along lines, with the segment on which each lies, and the ends of the lines."""

    def __init__(self, vertices: Points) -> None:
        there = finite(vertices)
        both = there[:-1] & there[1:]
        count = np.maximum(np.rint(np.hypot(*np.diff(vertices, axis=0)[both].T) / _STEP), 1).astype(int)
        segment = np.repeat(np.flatnonzero(both), count)
        share = (np.arange(len(segment)) - np.repeat(np.cumsum(count) - count, count) + 0.5) / np.repeat(count, count)
        self.starts, self.stops = vertices[segment], vertices[segment + 1]
        self.points = self.starts + share[:, None] * (self.stops - self.starts)
        self.line = np.cumsum(~there)[segment]
        edges = np.flatnonzero(np.diff(np.r_[False, there, False].astype(int)))
        self.ends = np.vstack([vertices[edges[::2]], vertices[edges[1::2] - 1]])

    def follow(self, other: _Lines) -> bool:
        """Whether most of these lines lie on the others, and leave them only where one of those ends."""
        near = nearest(self.points, other.points)[1]
        apart = to_own_segment(self.points, other.starts[near], other.stops[near])
        elsewhere = apart > _NEAR
        if elsewhere.mean() > _ELSEWHERE or apart.max() > _APART:
            return False
        leaves = np.flatnonzero((elsewhere[1:] != elsewhere[:-1]) & (self.line[1:] == self.line[:-1]))
        return bool((nearest(self.points[leaves], other.ends)[0] <= 2.0 * _STEP).all())

    def along(self, other: _Lines) -> bool:
        """Whether these lines run in the direction of the others."""
        near = nearest(self.points, other.points)[1]
        ways = np.einsum("ij,ij->i", self.stops - self.starts, other.stops[near] - other.starts[near])
        return bool((ways > 0.0).mean() > 0.5)
