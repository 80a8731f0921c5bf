"""What lies over what, where panels, insets and what belongs to the whole figure overlap."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from replicate.figures.recorder import DPI, Array, Drawn

#: Names of what belongs to the axes as such; an inset covers it or not, but nobody asks which.
_OF_AXES = ("background", "frame", " spine", " axis")
_LETTER = 0.6  # width of a letter, as a fraction of the font size
_TOUCHING = 2.0  # pixels

Extent = tuple[float, float, float, float]


@dataclass
class Stack:
    """What was drawn, from the lowest to the highest, each name with the box around it in pixels."""

    boxes: dict[str, Extent] = field(default_factory=dict)

    def add(self, name: str, box: Extent | None) -> None:
        """Note that something was drawn; what is drawn in several steps lies where its first one does."""
        if box is None or name.startswith(_OF_AXES) or name.endswith(_OF_AXES):
            return
        self.boxes[name] = _joined([self.boxes.get(name, box), box])

    def over(self) -> dict[str, list[list[str]]]:
        """Return ``over``, if any: pairs of names that overlap, the upper one first, one of them a panel's."""
        names = list(self.boxes)
        found = [
            [upper, lower]
            for i, upper in enumerate(names)
            for lower in names[:i]
            if (_is_panel(upper) or _is_panel(lower)) and _overlap(self.boxes[upper], self.boxes[lower])
        ]
        return {"over": sorted(found)} if found else {}


def extent(drawn: Drawn) -> Extent | None:
    """Return left, bottom, right and top of what was drawn, in pixels; ``None`` if nothing can be seen of it."""
    if drawn.kind == "text":  # wherever it is anchored
        x, y = drawn.extra["place"]
        size = drawn.extra["font"].get_size_in_points() * DPI / 72.0
        reach = size * max(1.0, _LETTER * len(drawn.extra["text"]))
        return x - reach, y - reach, x + reach, y + reach
    shapes = [np.reshape(np.asarray(path.vertices), (-1, 2)) for path in drawn.paths]
    margin = max(drawn.widths, default=0.0) * DPI / 144.0
    if "corners" in drawn.extra:
        together = np.asarray(drawn.extra["corners"])
    elif drawn.offsets is not None:  # markers have their size around each place
        together = drawn.offsets
        margin += max((float(np.abs(shape).max(initial=0.0)) for shape in shapes), default=0.0) * _largest(drawn.scales)
    else:
        together = np.concatenate(shapes) if shapes else np.empty((0, 2))
    together = together[np.isfinite(together).all(axis=1)]
    if not len(together):
        return None
    (left, bottom), (right, top) = together.min(axis=0) - margin, together.max(axis=0) + margin
    return float(left), float(bottom), float(right), float(top)


def box_around(calls: Sequence[Drawn]) -> Extent | None:
    """Return the extent of several calls; ``None`` if nothing can be seen of them."""
    boxes = [box for box in map(extent, calls) if box is not None]
    return _joined(boxes) if boxes else None


def _joined(boxes: Sequence[Extent]) -> Extent:
    left, bottom, right, top = zip(*boxes, strict=True)
    return min(left), min(bottom), max(right), max(top)


def _largest(scales: Array | None) -> float:
    """Return how much larger than the first one the largest marker is."""
    return float(scales.max() / (scales[0] or 1.0)) if scales is not None and len(scales) else 1.0


def _is_panel(name: str) -> bool:
    return name.startswith("panel '")


def _overlap(one: Sequence[float], other: Sequence[float]) -> bool:
    return all(min(one[side + 2], other[side + 2]) - max(one[side], other[side]) > _TOUCHING for side in (0, 1))
