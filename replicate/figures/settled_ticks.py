"""Ticks found once: matplotlib looks for them whenever somebody asks where an axis is, ten times in one drawing.

Where the ticks of an axis are, what their labels say and the boxes around these follow from its limits, its place and
its locators. As long as all of these are what they were, so are the ticks.
"""

from __future__ import annotations

import operator
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from matplotlib.axis import XAxis, YAxis

from replicate.figures.attributes import attributes

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@contextmanager
def settled_ticks(figure: Figure) -> Iterator[None]:
    """Have the axes of a figure remember their ticks for the length of a ``with`` block, those of plain axes."""
    plain = [axis for axes in figure.axes for axis in (axes.xaxis, axes.yaxis) if type(axis) in {XAxis, YAxis}]
    ticks = [(axis, _Ticks(axis)) for axis in plain]
    found = [(axis, "_update_ticks", here.updated) for axis, here in ticks]
    around = [(axis, "_get_ticklabel_bboxes", here.boxes) for axis, here in ticks]
    with attributes([*found, *around]):
        yield


class _Ticks:
    """The ticks of an axis as they were found last, and what they followed from."""

    def __init__(self, axis: Any) -> None:
        self._axis = axis
        self._update, self._surround = axis._update_ticks, axis._get_ticklabel_bboxes  # noqa: SLF001
        self._numbers: tuple[float, ...] = ()
        self._things: tuple[Any, ...] = ()
        self._ticks: list[Any] = []
        self._boxes: tuple[Any, Any] | None = None

    def updated(self) -> list[Any]:
        """Return the ticks that are drawn, with places and labels up to date."""
        if not self._are_settled():
            self._ticks, self._boxes = self._update(), None
            self._numbers, self._things = self._place(), self._sources()
        return self._ticks

    def boxes(self, ticks: list[Any], renderer: Any) -> Any:
        """Return the boxes around the labels on either side."""
        if ticks is not self._ticks or not self._are_settled():
            return self._surround(ticks, renderer)
        if self._boxes is None or self._boxes[0] is not renderer:
            self._boxes = renderer, self._surround(ticks, renderer)
        return self._boxes[1]

    def _are_settled(self) -> bool:
        things = self._sources()
        same = len(things) == len(self._things) and all(map(operator.is_, things, self._things))
        return same and self._place() == self._numbers

    def _place(self) -> tuple[float, ...]:
        axes = self._axis.axes
        return (*axes.viewLim.extents, *axes.bbox.extents, axes.figure.dpi)

    def _sources(self) -> tuple[Any, ...]:
        """Return what decides on ticks; a formatter keeps the places that it labelled last, of whichever axis."""
        both = (self._axis.major, self._axis.minor)
        found = [(one.locator, one.formatter, _labelled(one.formatter)) for one in both]
        return (self._axis._scale, *found[0], *found[1])  # noqa: SLF001


def _labelled(formatter: Any) -> Any:
    own = vars(formatter)
    return own.get("_locs", own.get("locs"))  # older matplotlib has the latter
