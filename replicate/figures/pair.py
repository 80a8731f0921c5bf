"""A curve in two states of a figure, and how they differ."""

from __future__ import annotations

from dataclasses import dataclass

from replicate.figures.distance import Distances
from replicate.figures.polylines import Points
from replicate.figures.sameness import Axes
from replicate.figures.values import ValueDifference


@dataclass(frozen=True)
class Pair:
    """A curve in both states, and how they differ.

    Attributes
    ----------
    before, after
        In data coordinates.
    values
        For functions of x.
    distance
        Of the new curve from the accepted one, then the other way round; empty for functions of x whose values
        tell enough.
    words, size
        How it differs where its points were too many to keep.
    """

    axes: Axes  # the accepted description of the panel: all fractions are of these axes
    name: str
    before: Points
    after: Points
    moved: bool
    tolerance: float
    values: ValueDifference | None = None
    distance: tuple[Distances, ...] = ()
    words: str = ""
    size: float = 0.0
