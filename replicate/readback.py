"""Read curves, limits, labels and texts back out of matplotlib axes.

Everything is returned in data coordinates, rounded to nine significant digits, with long curves thinned so
that they can be redrawn faithfully from at most `MOST_POINTS` points.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.collections import LineCollection, PathCollection
from matplotlib.contour import ContourSet
from matplotlib.lines import Line2D
from matplotlib.path import Path

from replicate.simplify import Points, simplify

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.collections import Collection
    from matplotlib.patches import Patch
    from matplotlib.transforms import Transform

#: A dropped point lies within this fraction of the axes' width or height from the thinned curve ...
TOLERANCE = 2e-5
#: ... unless the curve would need more points than this.
MOST_POINTS = 300

_DIGITS = 9
_BREAK = np.array([[np.nan, np.nan]])

CurvePoint = tuple[str, str, float, float]


def read_curves(panel: str, axes: Axes) -> list[CurvePoint]:
    """Return every line, scatter, filled area, contour and shape of an axes as ``(panel, curve, x, y)``.

    A curve is named by its label, otherwise by its place ("line 2"). A row with ``nan`` for x and y is a
    break: the curve continues elsewhere. Artists placed in axes or figure coordinates only (not in data
    coordinates) are left out, as is what lies far outside the limits of the axes.
    """
    axes.get_xlim(), axes.get_ylim()  # matplotlib settles automatic limits only when somebody asks
    rows: list[CurvePoint] = []
    used: dict[str, int] = {}
    for name, points in _curves(axes):
        if len(points) == 0:
            continue
        used[name] = used.get(name, 0) + 1
        unique = name if used[name] == 1 else f"{name} ({used[name]})"
        rows += [(panel, unique, float(x), float(y)) for x, y in _rounded(points, axes)]
    return rows


def describe(panel: str, axes: Axes) -> dict[str, Any]:
    """Return limits, scales, labels, title, legend entries and annotation texts of an axes.

    Returns
    -------
    dict
        ``panel, title, xlabel, ylabel, xscale, yscale, xlim, ylim, legend, texts``; ready for JSON. A text is
        ``{"text", "x", "y"}`` with its anchor in the coordinates it was placed in.
    """
    legend = axes.get_legend()
    return {
        "panel": panel,
        "title": axes.get_title() or axes.get_title(loc="left") or axes.get_title(loc="right"),
        "xlabel": axes.get_xlabel(),
        "ylabel": axes.get_ylabel(),
        "xscale": axes.get_xscale(),
        "yscale": axes.get_yscale(),
        "xlim": [_digits(limit) for limit in axes.get_xlim()],
        "ylim": [_digits(limit) for limit in axes.get_ylim()],
        "legend": [text.get_text() for text in legend.get_texts()] if legend else [],
        "texts": [_text(text) for text in axes.texts if text.get_text() and text.get_visible()],
    }


def _text(text: Any) -> dict[str, Any]:
    x, y = getattr(text, "xy", text.get_position())
    return {"text": text.get_text(), "x": _digits(x), "y": _digits(y)}


def _digits(value: Any) -> float | str:
    """Round a number to nine significant digits; a category or a date stays the text it is."""
    try:
        return float(f"{float(value):.{_DIGITS}g}")
    except (TypeError, ValueError):
        return str(value)


def _curves(axes: Axes) -> Iterator[tuple[str, Points]]:
    for place, line in enumerate(_visible(axes.lines), start=1):
        yield _name(line, f"line {place}"), _line(line, axes)
    for place, collection in enumerate(_visible(axes.collections), start=1):
        yield from _collection(collection, axes, place)
    for place, patch in enumerate(_visible(axes.patches), start=1):
        yield _name(patch, f"shape {place}"), _shape(patch, axes)


def _visible(artists: Any) -> Iterator[Any]:
    return (artist for artist in artists if artist.get_visible())


def _name(artist: Artist, otherwise: str) -> str:
    label = " ".join(str(artist.get_label()).split())
    return otherwise if not label or label.startswith("_") else label


def _line(line: Line2D, axes: Axes) -> Points:
    points = _to_data(np.asarray(line.get_xydata(), dtype=float), line.get_transform(), axes)
    has_line = line.get_linestyle() not in {"None", "none", "", " "}
    return _thinned(points, axes) if has_line else points


def _collection(collection: Collection, axes: Axes, place: int) -> Iterator[tuple[str, Points]]:
    if isinstance(collection, ContourSet):
        base = _name(collection, "level")
        for level, path in zip(collection.levels, collection.get_paths(), strict=False):
            yield f"{base} {level:.{_DIGITS}g}", _thinned(_of_path(path), axes)
    elif isinstance(collection, PathCollection):  # a scatter plot: the offsets are the data
        offsets: Points = np.ma.filled(np.ma.asarray(collection.get_offsets(), dtype=float), np.nan)
        yield _name(collection, f"points {place}"), _to_data(offsets, collection.get_offset_transform(), axes)
    else:
        kind = "lines" if isinstance(collection, LineCollection) else "area"
        pieces = [_of_path(path) for path in collection.get_paths()]
        points = _to_data(_joined(pieces), collection.get_transform(), axes)
        yield _name(collection, f"{kind} {place}"), _thinned(points, axes)


def _shape(patch: Patch, axes: Axes) -> Points:
    in_patch = _of_path(patch.get_path())
    in_data = patch.get_patch_transform().transform(in_patch)
    return _thinned(_to_data(in_data, patch.get_data_transform(), axes), axes)


def _of_path(path: Path) -> Points:
    """Return the vertices of a path, Bezier curves as short chords, with a break between its pieces."""
    if path.codes is None:
        return np.asarray(path.vertices, dtype=float)
    if np.isin(path.codes, (Path.CURVE3, Path.CURVE4)).any():
        return _joined([np.asarray(piece, dtype=float) for piece in path.to_polygons(closed_only=False)])
    pieces: list[Points] = []
    for vertices, code in path.iter_segments(curves=False, simplify=False):
        if code == Path.MOVETO:
            pieces.append(vertices[None, :])
        elif code == Path.CLOSEPOLY and pieces:
            pieces[-1] = np.vstack([pieces[-1], pieces[-1][:1]])
        elif pieces:
            pieces[-1] = np.vstack([pieces[-1], vertices.reshape(-1, 2)])
    return _joined(pieces)


def _joined(pieces: list[Points]) -> Points:
    separated = [part for piece in pieces if len(piece) for part in (_BREAK, piece)]
    return np.vstack(separated[1:]) if separated else np.empty((0, 2))


def _to_data(points: Points, transform: Transform, axes: Axes) -> Points:
    """Return points in data coordinates; a fraction of the axes is mapped through the limits.

    An artist with a coordinate that is neither has no place among the curves and comes back empty.
    """
    in_data = transform.contains_branch_seperately(axes.transData)
    if all(in_data):
        return points
    in_axes = transform.contains_branch_seperately(axes.transAxes)
    if not any(in_data) or not all(data or fraction for data, fraction in zip(in_data, in_axes, strict=True)):
        return np.empty((0, 2))
    to_data = axes.transAxes + axes.transData.inverted()
    mapped = to_data.transform(points)
    return np.column_stack([points[:, i] if in_data[i] else mapped[:, i] for i in (0, 1)])


def _thinned(points: Points, axes: Axes) -> Points:
    """Thin each unbroken piece, leaving out what lies more than half a width or height outside the axes."""
    if len(points) == 0:
        return points
    unit = _in_axes_units(points, axes)
    finite = np.logical_and.reduce(np.isfinite(np.hstack([points, unit])), axis=1)
    near = finite & np.logical_and.reduce(np.abs(unit - 0.5) <= 1.0, axis=1)
    # Keep the neighbours of visible points, so that a curve still leaves the picture in the right direction.
    wanted = finite & (near | np.r_[near[1:], False] | np.r_[False, near[:-1]])
    edges = np.flatnonzero(np.diff(np.r_[False, wanted, False].astype(int)))
    runs = [np.arange(start, end) for start, end in zip(edges[::2], edges[1::2], strict=True)]
    total = sum(len(run) for run in runs)
    pieces = []
    for run in runs:
        share = max(2, round(MOST_POINTS * len(run) / total))
        pieces.append(points[run[simplify(unit[run], TOLERANCE, share)]])
    return _joined(pieces)


def _in_axes_units(points: Points, axes: Axes) -> Points:
    """Return positions as fractions of the axes' width and height, whatever the scales are."""
    with np.errstate(all="ignore"):
        scaled = axes.transScale.transform(points)
        return np.asarray(axes.transLimits.transform(scaled))


def _rounded(points: Points, axes: Axes) -> Points:
    """Round to nine significant digits; what is rounding error next to the axis' span becomes zero."""
    rounded = np.empty_like(points)
    for i, limits in enumerate((axes.get_xlim(), axes.get_ylim())):
        span = abs(limits[1] - limits[0])
        linear = (axes.get_xscale(), axes.get_yscale())[i] == "linear"
        column = points[:, i]
        column = np.where(linear & (np.abs(column) < 1e-12 * span), 0.0, column)
        rounded[:, i] = [float(f"{value:.{_DIGITS}g}") for value in column]
    return rounded + 0.0  # no negative zeros
