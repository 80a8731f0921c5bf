"""Stream plots as matplotlib draws them: lines in pieces, and arrow heads that stand on them."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.patches import FancyArrowPatch

from replicate.figures.polylines import Points

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.patches import Patch


def arrow_heads(axes: Axes) -> dict[LineCollection, list[Patch]]:
    """Return the arrow heads of stream plots by their lines: each stands in the middle of a segment of a line."""
    arrows: list[Any] = [patch for patch in axes.patches if type(patch) is FancyArrowPatch]
    collections = [one for one in axes.collections if isinstance(one, LineCollection)]
    found: dict[LineCollection, list[Patch]] = {}
    for collection in collections if arrows else ():
        ends: dict[tuple[float, ...], list[Points]] = {}
        for segment in collection.get_segments():
            for start, end in pairwise(segment):
                ends.setdefault(tuple(start), []).append((start + end) / 2.0)
        for arrow in arrows:
            places: Any = getattr(arrow, "_posA_posB", None)  # none of one between two patches
            if places and any(np.allclose(places[1], middle) for middle in ends.get(tuple(places[0]), ())):
                found.setdefault(collection, []).append(arrow)
    return found


def joined_up(segments: Sequence[Points]) -> list[Points]:
    """Return lines that begin where others end as one: those of many colours are drawn segment by segment."""
    lines: list[list[Points]] = []
    for segment in segments:
        if lines and len(segment) and np.array_equal(lines[-1][-1][-1], segment[0]):
            lines[-1].append(segment[1:])
        elif len(segment):
            lines.append([segment])
    return [np.vstack(line) for line in lines]
