"""How large a drawing may be, and what becomes of crowds: thousands of marks are pixels inside the SVG.

A figure beyond the limits is refused at once, before it is drawn: nobody could look at it, and a run would hang. Within
them, a picture is drawn in well under a minute. Marks that no eye could tell apart are not shapes of their own in the
SVG; texts, axes and curves stay sharp.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.collections import Collection
from matplotlib.image import _ImageBase
from matplotlib.lines import Line2D

from replicate.errors import FigureError
from replicate.figures.drawing import everything

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST_INCHES = 100.0
MOST_SQUARE_INCHES = 2_000.0
#: Lines, texts, shapes, collections and images.
MOST_ARTISTS = 10_000
#: With everything that axes consist of: ticks, labels, spines.
MOST_PARTS = 100_000
MOST_POINTS = 5_000_000
MOST_PIXELS = 100_000_000

#: A collection or a line of markers with more elements than this becomes pixels.
CROWD = 10_000


def within_limits(figure: Figure) -> None:
    """Check that a figure can be drawn in reasonable time and space, and have crowds of marks drawn as pixels.

    Raises
    ------
    FigureError
        If it is too large, or holds too much; the message says what is allowed.
    """
    width, height = (float(side) for side in figure.get_size_inches())
    if not (0 < width <= MOST_INCHES and 0 < height <= MOST_INCHES and width * height <= MOST_SQUARE_INCHES):
        allowed = f"{MOST_INCHES:g} inches each way, {MOST_SQUARE_INCHES:g} square inches"
        msg = f"the figure is {width:g} x {height:g} inches; allowed: {allowed}"
        raise FigureError(msg)
    artists = [artist for axes in figure.axes for artist in axes.get_children() if not _belongs_to_axes(artist, axes)]
    _demand(len(artists) + len(figure.texts) + len(figure.lines) + len(figure.patches), MOST_ARTISTS, "artists")
    parts = everything(figure)
    _demand(len(parts), MOST_PARTS, "parts, ticks and labels among them")
    _demand(sum(_points(artist) for artist in parts), MOST_POINTS, "points")
    _demand(sum(_pixels(artist) for artist in parts), MOST_PIXELS, "pixels in images")
    for artist in parts:
        if elements(artist) > CROWD:
            artist.set_rasterized(True)


def elements(artist: Artist) -> int:
    """Return how many marks an artist draws: points of a scatter, cells of a mesh, markers of a line."""
    if isinstance(artist, Collection):
        array = artist.get_array()
        return max(
            len(np.atleast_2d(artist.get_offsets())), _paths(artist), 0 if array is None else int(np.size(array))
        )
    if isinstance(artist, Line2D) and artist.get_marker() not in {None, "None", "none", "", " "}:
        return _points(artist)
    return 0


def _paths(collection: Collection) -> int:
    try:
        return len(collection.get_paths())
    except (AttributeError, NotImplementedError):
        return 0


def _points(artist: Artist) -> int:
    if isinstance(artist, Line2D):
        return len(np.atleast_1d(np.asarray(artist.get_xdata(orig=True), dtype=object)))
    return elements(artist)


def _pixels(artist: Artist) -> int:
    array: Any = artist.get_array() if isinstance(artist, _ImageBase) else None
    return 0 if array is None else int(np.prod(np.shape(array)[:2]))


def _belongs_to_axes(artist: Artist, axes: Any) -> bool:
    """Say whether an artist is a part that every axes has: spines, axis, title, background."""
    own: Iterable[Any] = (*axes.spines.values(), axes.patch, axes.title, getattr(axes, "xaxis", None))
    return any(artist is part for part in own) or artist in (getattr(axes, "yaxis", None), axes.get_legend())


def _demand(count: int, most: int, what: str) -> None:
    if count > most:
        msg = f"the figure draws {count:,} {what}; allowed: {most:,}"
        raise FigureError(msg)
