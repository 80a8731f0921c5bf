"""Contours: their levels, pieces too small to be seen, and what labels cover.

matplotlib puts a label where its contour is straightest, and cuts out as much of it as the label is wide. Another font,
or rounding, moves both along the curve. So the places that labels cover are kept, and a contour is compared elsewhere.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from replicate.figures.polylines import THINNING, Points, distance_to_segments
from replicate.figures.scaling import finite

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.contour import ContourSet
    from matplotlib.text import Text

_LETTER = 0.3  # half the width of a letter, of the size of the type
_SPACE = 8.0  # points between a label and its contour, on each side
_WIDER = 1.4  # than these, in some fonts
_ON = 2.0  # points from the middle of a label to a contour that it does not interrupt
_INCH = 72.0


def levels(contours: ContourSet) -> list[str]:
    """Return the level of each line, or from which level on each area is filled."""
    found = [f"{level:.9g}" for level in contours.levels]
    below = contours.filled and contours.extend in {"min", "both"}
    return [f"below {found[0]}", *found] if below and found else found


def without_specks(points: Points, units: Points) -> Points:
    """Leave out pieces too small to be seen: rounding decides whether a level that is an extremum has one.

    Parameters
    ----------
    points, units
        The same points in data coordinates and as fractions of the axes.
    """
    found = points.copy()
    edges = np.flatnonzero(np.diff(np.r_[False, finite(units), False].astype(int)))
    for start, end in zip(edges[::2], edges[1::2], strict=True):
        if np.ptp(units[start:end], axis=0).max() < THINNING:
            found[start:end] = np.nan
    return found


def covered(contours: ContourSet, place: int, units: Points, axes: Axes) -> list[list[float]]:
    """Return the ellipses inside which labels interrupt the contour of a level.

    Parameters
    ----------
    place
        Which of the levels it is.
    units
        The contour as it is drawn, as fractions of the axes.

    Returns
    -------
    list of list of float
        Centre and half axes of each, ``[x, y, width, height]``, as fractions of the axes; none if no label of this
        level interrupts it.
    """
    figure: Any = axes.figure.canvas.figure
    size = np.array([axes.bbox.width, axes.bbox.height]) * _INCH / figure.dpi
    found, apart = [], 0.0
    texts: Sequence[Any] = getattr(contours, "labelTexts", ())
    # A label knows its colour, which stands for its level.
    colours = getattr(contours, "labelCValues", ()), getattr(contours, "labelCValueList", ())
    places = dict(zip(colours[1], getattr(contours, "labelIndiceList", ()), strict=False))
    for text, colour in zip(texts, colours[0], strict=False):
        if places.get(colour) != place:
            continue
        centre = axes.transAxes.inverted().transform(text.get_transform().transform(text.get_position()))
        reach = _WIDER * (_LETTER * text.get_fontsize() * len(text.get_text()) + _SPACE)
        found.append([round(float(part), 5) for part in (*centre, *(reach / size))])
        apart = max(apart, _apart(centre * size, units * size))
    return found if apart > _ON else []


def placed_by_hand(text: Text, axes: Axes) -> bool:
    """Whether somebody said near which place a label of a contour shall stand."""
    owner: Any = next((one for one in axes.collections if text in getattr(one, "labelTexts", ())), None)
    return getattr(owner, "labelManual", False) is not False


def _apart(point: Points, line: Points) -> float:
    there = finite(line)
    both = there[:-1] & there[1:]
    if not both.any():
        return np.inf
    return float(distance_to_segments(point[None], line[:-1][both], line[1:][both]).min())


def uncovered(points: Points, ellipses: Sequence[Sequence[float]]) -> Points:
    """Return the points that no label covers.

    Examples
    --------
    >>> import numpy as np
    >>> uncovered(np.array([[0.5, 0.5], [0.5, 0.9]]), [[0.5, 0.4, 0.2, 0.2]]).tolist()
    [[0.5, 0.9]]
    """
    for x, y, width, height in ellipses:
        points = points[((points - (x, y)) ** 2 / (width**2, height**2)).sum(axis=1) > 1.0]
    return points


def interrupted_words(one: Mapping[str, Any], other: Mapping[str, Any], name: str) -> str:
    """Return what changed about labels that interrupt a curve; empty if nothing did, or an earlier version wrote it.

    Parameters
    ----------
    one, other
        The axes of the accepted and the new state.
    """
    before, after = (axes.get("labels", {}).get(name, []) for axes in (one, other))
    if name in one.get("loose", ()):
        return "" if after else "is accepted as one that labels interrupt, which it is not"
    if bool(before) != bool(after):
        return f"is {'now' if after else 'no longer'} interrupted by its labels"
    widest = 2.0 * max((max(ellipse[2:]) for ellipse in after), default=0.0)
    if len(before) > 2 * len(after) or any(max(ellipse[2:]) > widest for ellipse in before):
        return "is accepted as one that labels interrupt further than they do"
    return ""
