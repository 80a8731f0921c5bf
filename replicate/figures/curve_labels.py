"""Write the names of curves beside the curves or on them, where a reader cannot take one for another's.

Geometry is that of the grid on which the axes stand, and the width of a name is estimated from its letters: neither
depends on fonts or on a layout engine, so that names do not move from one version of matplotlib to the next.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from replicate.figures.style import PAPER

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

Array = NDArray[np.float64]

_GAP = 3.0  # points between a curve and its name
_STEP = 1.5  # points between the places of a curve at which others must not be
_PLACES = 80  # of a name along a curve
_LETTER = 0.52  # mean width of a letter, of the size of the type
_EDGE = 2.0  # points that a name keeps from the edge of the axes
_CLEAR = 30.0  # points beyond which other curves are no matter
_NEARER = 1.6  # how many times nearer a name must be to its curve than to any other

_COMMAND = re.compile(r"\\(?:mathrm|mathit|mathbf|text|operatorname|hat|bar|tilde|frac|left|right)\b|[${}^_]")
_SYMBOL = re.compile(r"\\[a-zA-Z]+|\\.")


@dataclass(frozen=True)
class _Box:
    """Where a name would stand, in points from the lower left corner of the axes."""

    centre: Array
    half: Array

    def distances(self, points: Array) -> Array:
        """Return how far points are from the box, zero inside."""
        return np.asarray(np.hypot(*np.maximum(np.abs(points - self.centre) - self.half, 0.0).T))

    def overlaps(self, other: _Box) -> bool:
        """Return whether two boxes are too close to each other."""
        return bool(np.all(np.abs(self.centre - other.centre) <= self.half + other.half + _GAP))


def label_curves(axes: Axes, *, size: float = 9.5) -> bool:
    """Write the labels of curves beside or on them, in their colours, if there is a place for each.

    Parameters
    ----------
    axes
        With all their curves and their final limits.
    size
        Of the type, in points.

    Returns
    -------
    bool
        Whether it could be done. If not, nothing was written, and the axes need a legend.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().subplots()
    >>> lines = axes.plot([0, 1], [0, 1], label="ZN"), axes.plot([0, 1], [0, 0.2], label="PA")
    >>> label_curves(axes), sorted(text.get_text() for text in axes.texts)
    (True, ['PA', 'ZN'])
    """
    scale = _size(axes)
    wanted = [line for line in axes.get_lines() if _named(line)]
    courses = {line: _course(line, axes, scale) for line in axes.get_lines() if line.get_visible()}
    choices = {line: _choices(line, courses, scale, _half(str(line.get_label()), size)) for line in wanted}
    found: dict[Line2D, tuple[float, _Box]] = {}
    for line in sorted(wanted, key=lambda line: len(choices[line])):
        free = [choice for choice in choices[line] if not any(choice[1].overlaps(box) for _, box in found.values())]
        if not free:
            return False
        found[line] = max(free, key=lambda choice: choice[0])
    for line, (score, box) in found.items():
        _write(axes, line, box.centre / scale, size, on=score < 0.0)
    return True


def _named(line: Line2D) -> bool:
    return line.get_visible() and line.get_linestyle() != "None" and not str(line.get_label()).startswith("_")


def _write(axes: Axes, line: Line2D, place: Array, size: float, *, on: bool) -> None:
    """Write a name, and say in the drawing whose it is; one that stands on its curve interrupts it."""
    figure: Any = axes.figure.canvas.figure
    number = sum(str(artist.get_gid()).endswith("-name") for one in figure.axes for artist in one.texts) + 1
    line.set_gid(f"curve-{number}")
    x, y = (round(float(share), 3) for share in place)
    axes.text(
        x,
        y,
        str(line.get_label()),
        transform=axes.transAxes,
        color=line.get_color(),
        fontsize=size,
        ha="center",
        va="center",
        gid=f"curve-{number}-name",
        bbox={"facecolor": PAPER, "edgecolor": "none", "pad": 0.5} if on else None,
    )


def _size(axes: Axes) -> Array:
    """Return width and height of axes in points, as their grid has them."""
    figure: Any = axes.figure.canvas.figure
    spec = axes.get_subplotspec()
    place = axes.get_position(original=True) if spec is None else spec.get_position(figure)
    size = np.array([place.width, place.height]) * figure.get_size_inches() * 72.0
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()  # asking for limits settles those that follow data
    if axes.get_aspect() == 1.0 and axes.get_adjustable() == "box":
        units = np.abs([right - left, high - low])
        size = units * np.min(size / units)
    return np.asarray(size, dtype=float)


def _course(line: Line2D, axes: Axes, scale: Array) -> Array:
    """Return points all along a curve, in points from the corner of the axes; not a number where it is interrupted."""
    shares = (line.get_transform() + axes.transAxes.inverted()).transform(np.asarray(line.get_xydata(), dtype=float))
    way: Array = np.clip(shares, -1.0, 2.0) * scale  # what lies far outside is of no matter, and may be infinite
    if len(way) < 2:
        return way
    lengths = np.hypot(*np.diff(way, axis=0).T)
    along = np.concatenate([[0.0], np.cumsum(np.nan_to_num(lengths))])
    if along[-1] == 0.0:
        return way[:1]
    at = np.linspace(0.0, along[-1], max(2, int(along[-1] / _STEP) + 1))
    keep = np.concatenate([[True], np.diff(along) > 0.0])
    return np.column_stack([np.interp(at, along[keep], column) for column in way[keep].T])


def _half(label: str, size: float) -> Array:
    """Return half the width and height of a name."""
    letters = len(_SYMBOL.sub("m", _COMMAND.sub("", label)))
    return np.array([0.5 * _LETTER * size * letters + 1.0, 0.6 * size])


def _choices(line: Line2D, courses: dict[Line2D, Array], scale: Array, half: Array) -> list[tuple[float, _Box]]:
    """Return where the name of a curve can stand, the better the larger the number: negative on the curve itself."""
    own = courses[line]
    others = np.concatenate([[[np.inf, np.inf]], *(course for one, course in courses.items() if one is not line)])
    found = []
    for place in np.unique(np.linspace(1, len(own) - 2, _PLACES).astype(int)) if len(own) > 2 else []:
        ahead = own[place + 1] - own[place - 1]
        length = float(np.hypot(*ahead))
        if not length > 0.0:
            continue
        normal = np.array([-ahead[1], ahead[0]]) / length
        for side in (normal, -normal):
            box = _Box(own[place] + side * (np.abs(side) @ half + _GAP), half)
            if np.any(box.centre - half < _EDGE) or np.any(box.centre + half > scale - _EDGE):
                continue
            apart = float(np.nanmin(box.distances(own)))
            clear = float(np.nanmin(box.distances(others)))
            if apart >= 0.5 * _GAP and clear >= _NEARER * apart + 1.0:
                found.append((min(clear, _CLEAR), box))
        box = _Box(own[place], half)
        inside = np.all(box.centre - half > _EDGE) and np.all(box.centre + half < scale - _EDGE)
        clear = float(np.nanmin(box.distances(others)))
        if inside and clear >= 1.0 and np.ptp(own[box.distances(own) == 0.0], axis=0).max() <= 2.2 * half.max():
            found.append((min(clear, _CLEAR) - 2.0 * _CLEAR, box))
    return found
