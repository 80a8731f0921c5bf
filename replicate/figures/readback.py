"""Read curves, limits, labels and texts back out of matplotlib axes.

Everything is returned in data coordinates, rounded to nine significant digits, with long curves thinned so
that they can be redrawn faithfully from at most `MOST_POINTS` points.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from matplotlib.collections import LineCollection, PathCollection
from matplotlib.contour import ContourSet
from matplotlib.lines import Line2D
from matplotlib.path import Path

from replicate.figures.polylines import Points, simplify

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.collections import Collection
    from matplotlib.patches import Patch
    from matplotlib.transforms import Transform

#: A dropped point lies within this fraction of the axes' width or height from the thinned curve ...
TOLERANCE = 5e-5
#: ... unless the curve would need more points than this.
MOST_POINTS = 400

#: Chords that stand for one Bezier curve; matplotlib's own subdivision works in pixels, not in data units.
CHORDS = 64

_DIGITS = 9
_BREAK = np.array([[np.nan, np.nan]])
_ALONG = np.linspace(0.0, 1.0, CHORDS + 1)[1:]
_END = np.array([1.0])

CurvePoint = tuple[str, str, float, float]
Kind = Literal["line", "points", "area"]


@dataclass(frozen=True)
class _Curve:
    """One artist; `error` is how far a point that thinning dropped may lie from the curve."""

    name: str
    kind: Kind
    points: Points
    error: float = 0.0


def read_panel(panel: str, axes: Axes) -> tuple[list[CurvePoint], dict[str, Any]]:
    """Return what one axes shows: its curves as ``(panel, curve, x, y)``, and the description of everything else.

    Every line, scatter, filled area, contour and shape is a curve. It is named by its label, otherwise by its
    place ("line 2"). A row with ``nan`` for x and y is a break: the curve continues elsewhere. Artists placed
    in axes or figure coordinates only (not in data coordinates) are left out, as is what lies far outside the
    limits of the axes.

    Returns
    -------
    curves
        Rows in drawing order.
    description
        ``panel, title, xlabel, ylabel, xscale, yscale, xlim, ylim, legend, texts``; ready for JSON. A text is
        ``{"text", "x", "y"}`` with its anchor in data coordinates, or with ``"in": "axes"`` in fractions of the
        axes. Only where it applies: ``aspect`` ("equal"), ``hidden`` (axes that are switched off), ``points``
        and ``areas`` (names of the curves that are no lines), and ``thinned`` (by name, how far a curve of
        very many points may lie from what was drawn, as a fraction of the axes).
    """
    axes.get_xlim(), axes.get_ylim()  # matplotlib settles automatic limits only when somebody asks
    rows: list[CurvePoint] = []
    special: dict[str, Any] = {"points": [], "areas": [], "thinned": {}}
    used: dict[str, int] = {}
    for curve in _curves(axes):
        if len(curve.points) == 0:
            continue
        used[curve.name] = used.get(curve.name, 0) + 1
        unique = curve.name if used[curve.name] == 1 else f"{curve.name} ({used[curve.name]})"
        rows += [(panel, unique, float(x), float(y)) for x, y in _rounded(curve.points, axes)]
        if curve.kind != "line":
            special["points" if curve.kind == "points" else "areas"].append(unique)
        if curve.error > TOLERANCE:
            special["thinned"][unique] = float(f"{curve.error:.2g}")
    return rows, _describe(panel, axes) | {name: value for name, value in special.items() if value}


def _describe(panel: str, axes: Axes) -> dict[str, Any]:
    legend = axes.get_legend()
    description: dict[str, Any] = {
        "panel": panel,
        "title": axes.get_title() or axes.get_title(loc="left") or axes.get_title(loc="right"),
        "xlabel": axes.get_xlabel(),
        "ylabel": axes.get_ylabel(),
        "xscale": axes.get_xscale(),
        "yscale": axes.get_yscale(),
        "xlim": [_digits(limit) for limit in axes.get_xlim()],
        "ylim": [_digits(limit) for limit in axes.get_ylim()],
        "legend": [text.get_text() for text in legend.get_texts()] if legend else [],
        "texts": [_text(text, axes) for text in axes.texts if text.get_text() and text.get_visible()],
    }
    if axes.get_aspect() != "auto":
        description["aspect"] = "equal"
    if not axes.axison:
        description["hidden"] = True
    return description


def _text(text: Any, axes: Axes) -> dict[str, Any]:
    x, y = getattr(text, "xy", text.get_position())
    coordinates = getattr(text, "xycoords", text.get_transform())
    fraction = coordinates in ("axes fraction", axes.transAxes)
    return {"text": text.get_text(), "x": _digits(x), "y": _digits(y)} | ({"in": "axes"} if fraction else {})


def _digits(value: Any) -> float | str:
    """Round a number to nine significant digits; a category or a date stays the text it is."""
    try:
        return float(f"{float(value):.{_DIGITS}g}")
    except (TypeError, ValueError):
        return str(value)


def _curves(axes: Axes) -> Iterator[_Curve]:
    for place, line in enumerate(_visible(axes.lines), start=1):
        yield _line(line, axes, f"line {place}")
    for place, collection in enumerate(_visible(axes.collections), start=1):
        yield from _collection(collection, axes, place)
    for place, patch in enumerate(_visible(axes.patches), start=1):
        yield _Curve(_name(patch, f"shape {place}"), "line", *_shape(patch, axes))


def _visible(artists: Any) -> Iterator[Any]:
    return (artist for artist in artists if artist.get_visible())


def _name(artist: Artist, otherwise: str) -> str:
    label = " ".join(str(artist.get_label()).split())
    return otherwise if not label or label.startswith("_") else label


def _line(line: Line2D, axes: Axes, otherwise: str) -> _Curve:
    name = _name(line, otherwise)
    points = _to_data(np.asarray(line.get_xydata(), dtype=float), line.get_transform(), axes)
    if line.get_linestyle() in {"None", "none", "", " "}:
        return _Curve(name, "points", points)
    return _Curve(name, "line", *_thinned(points, axes))


def _collection(collection: Collection, axes: Axes, place: int) -> Iterator[_Curve]:
    if isinstance(collection, ContourSet):
        base = _name(collection, "level")
        kind: Kind = "area" if collection.filled else "line"
        for level, path in zip(collection.levels, collection.get_paths(), strict=False):
            yield _Curve(f"{base} {level:.{_DIGITS}g}", kind, *_thinned(_of_path(path), axes))
    elif isinstance(collection, PathCollection):  # a scatter plot: the offsets are the data
        offsets: Points = np.ma.filled(np.ma.asarray(collection.get_offsets(), dtype=float), np.nan)
        points = _to_data(offsets, collection.get_offset_transform(), axes)
        yield _Curve(_name(collection, f"points {place}"), "points", points)
    else:
        lines = isinstance(collection, LineCollection)
        pieces = [_of_path(path) for path in collection.get_paths()]
        points = _to_data(_joined(pieces), collection.get_transform(), axes)
        name = _name(collection, f"{'lines' if lines else 'area'} {place}")
        yield _Curve(name, "line" if lines else "area", *_thinned(points, axes))


def _shape(patch: Patch, axes: Axes) -> tuple[Points, float]:
    in_patch = _of_path(patch.get_path())
    in_data = patch.get_patch_transform().transform(in_patch)
    return _thinned(_to_data(in_data, patch.get_data_transform(), axes), axes)


def _of_path(path: Path) -> Points:
    """Return the vertices of a path, Bezier curves as `CHORDS` chords, with a break between its pieces."""
    if path.codes is None:
        return np.asarray(path.vertices, dtype=float)
    pieces: list[list[Points]] = []
    segments: Any = path.iter_bezier()  # pairs of segment and code; matplotlib's stub has the segments only
    for segment, code in segments:
        if code == Path.MOVETO:
            pieces.append([segment.control_points[:1]])
        else:  # a closing line ends where its piece began
            pieces[-1].append(segment(_ALONG if code in {Path.CURVE3, Path.CURVE4} else _END))
    return _joined([np.vstack(piece) for piece in pieces])


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


def _thinned(points: Points, axes: Axes) -> tuple[Points, float]:
    """Thin each unbroken piece, leaving out what lies more than half a width or height outside the axes.

    Returns
    -------
    points, error
        The largest distance of a dropped point from what is left, as a fraction of the axes.
    """
    if len(points) == 0:
        return points, 0.0
    unit = _in_axes_units(points, axes)
    finite = np.logical_and.reduce(np.isfinite(np.hstack([points, unit])), axis=1)
    near = finite & np.logical_and.reduce(np.abs(unit - 0.5) <= 1.0, axis=1)
    # Keep the neighbours of visible points, so that a curve still leaves the picture in the right direction.
    wanted = finite & (near | np.r_[near[1:], False] | np.r_[False, near[:-1]])
    edges = np.flatnonzero(np.diff(np.r_[False, wanted, False].astype(int)))
    runs = [np.arange(start, end) for start, end in zip(edges[::2], edges[1::2], strict=True)]
    total = sum(len(run) for run in runs)
    pieces, error = [], 0.0
    for run in runs:
        share = max(2, round(MOST_POINTS * len(run) / total))
        kept, distance = simplify(unit[run], TOLERANCE, share)
        pieces.append(points[run[kept]])
        error = max(error, distance)
    return _joined(pieces), error


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
