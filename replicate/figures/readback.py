"""Read curves back out of matplotlib axes.

Everything is returned in data coordinates, rounded to nine significant digits, with long curves thinned so that they
can be redrawn faithfully from at most `MOST_POINTS` points. What is too dense for that has an envelope beside it, and
very many scattered points have a digest.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from matplotlib.collections import Collection, LineCollection, PathCollection
from matplotlib.contour import ContourSet
from matplotlib.lines import Line2D
from matplotlib.path import Path
from matplotlib.projections.polar import PolarAxes

from replicate.figures.contours import covered, levels, without_specks
from replicate.figures.describe import describe, said_label
from replicate.figures.envelope import envelope
from replicate.figures.outlines import joined, scattered
from replicate.figures.polylines import THINNING, Points, simplify
from replicate.figures.scaling import finite
from replicate.figures.stream_parts import arrow_heads, joined_up
from replicate.figures.values import is_function

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.patches import Patch
    from matplotlib.transforms import Transform

    from replicate.figures.ink import Ink

#: A thinned curve has no more points than this, even if dropped ones then lie further away than `THINNING`.
MOST_POINTS = 400

#: The same for the lines of a stream plot, all together.
MOST_IN_STREAM = 2000

#: More scattered points than this are kept as a sample of them and a digest of all.
MOST_SCATTERED = 1200

#: Chords that stand for one Bezier curve; matplotlib's own subdivision works in pixels, not in data units.
CHORDS = 64

_DIGITS = 9
_FINE = 1e-8
# A curve that is longer than this, in axes, cannot be drawn with so few points; one that is drawn this well can.
_LONG, _COARSE = 60.0, 3e-4
_ALONG = np.linspace(0.0, 1.0, CHORDS + 1)[1:]
_END = np.array([1.0])

CurvePoint = tuple[str, str, float, float]
Kind = Literal["line", "points", "area"]


@dataclass(frozen=True)
class _Curve:
    """One artist; `error` is how far a point that thinning dropped may lie from the curve."""

    artist: Artist
    name: str
    kind: Kind
    points: Points
    error: float = 0.0
    special: Mapping[str, Any] = field(default_factory=dict)
    heads: Sequence[Artist] = ()


@dataclass
class Panel:
    """What one axes shows.

    Attributes
    ----------
    points
        Rows ``(panel, curve, x, y)`` in drawing order.
    description
        Everything else that has a name, ready for JSON, as in `replicate.figures.describe`; ``points`` and
        ``areas`` (names of the curves that are not lines), ``thinned`` (by name, how far a curve of very many points
        may lie from what was drawn, as a fraction of the axes), ``dense`` (their envelopes), ``clouds`` (digests of
        very many scattered points), ``labels`` (what labels cover of a contour) and ``streams`` (the number of
        arrow heads of a stream plot), where there are any.
    names
        The curve that each artist is, by the artist's identity.
    heads
        The curve whose arrow head each artist is, and the first of these heads, by the artist's identity.
    """

    points: list[CurvePoint] = field(default_factory=list)
    description: dict[str, Any] = field(default_factory=dict)
    names: dict[int, str] = field(default_factory=dict)
    heads: dict[int, tuple[str, Artist]] = field(default_factory=dict)


def read_panel(panel: str, axes: Axes, ink: Ink) -> Panel:
    """Read what one axes shows.

    Every line, scatter, filled area, contour and shape is a curve. It is named by its label, otherwise by its
    place ("line 2"). A row with ``nan`` for x and y is a break: the curve continues elsewhere. Artists placed
    in axes or figure coordinates only (not in data coordinates) are left out, as is what lies far outside the
    limits of the axes.

    Parameters
    ----------
    ink
        What the artists have left on the figure: one of which nothing can be seen is no curve, and no text.
    """
    axes.get_xlim(), axes.get_ylim()  # matplotlib settles automatic limits only when somebody asks
    read = Panel(description=describe(panel, axes, ink))
    special: dict[str, Any] = {"points": [], "areas": []}
    special |= {name: {} for name in ("thinned", "dense", "clouds", "labels", "streams")}
    used: dict[str, int] = {}
    for curve in _curves(axes):
        if len(curve.points) == 0 or not ink.shows(curve.artist):
            continue
        used[curve.name] = used.get(curve.name, 0) + 1
        unique = curve.name if used[curve.name] == 1 else f"{curve.name} ({used[curve.name]})"
        read.names.setdefault(id(curve.artist), unique)
        if isinstance(curve.artist, ContourSet):
            read.names[id(curve.artist)] = _name(curve.artist, "contours")
        read.points += [(panel, unique, float(x), float(y)) for x, y in _rounded(curve.points, axes)]
        if curve.kind != "line":
            special["points" if curve.kind == "points" else "areas"].append(unique)
        if curve.error > THINNING:
            special["thinned"][unique] = float(f"{curve.error:.2g}")
        for name, value in curve.special.items():
            special[name][unique] = value
        read.heads |= {id(arrow): (unique, curve.heads[0]) for arrow in curve.heads}
    read.description |= {name: value for name, value in special.items() if value}
    return read


def _curves(axes: Axes) -> Iterator[_Curve]:
    if not in_the_plane(axes):
        return
    for place, line in enumerate(_visible(axes.lines), start=1):
        yield _line(line, axes, f"line {place}")
    streams = arrow_heads(axes)
    for place, collection in enumerate(_visible(axes.collections), start=1):
        yield from _collection(collection, axes, place, streams.get(collection, ()))
    heads = {arrow for arrows in streams.values() for arrow in arrows}
    for place, patch in enumerate((one for one in _visible(axes.patches) if one not in heads), start=1):
        yield _Curve(patch, _name(patch, f"shape {place}"), "line", *_shape(patch, axes))


def in_the_plane(axes: Axes) -> bool:
    """Whether the coordinates of axes are x and y, or angle and radius; not those of a solid or of a globe."""
    return axes.name == "rectilinear" or isinstance(axes, PolarAxes)


def _visible(artists: Any) -> Iterator[Any]:
    return (artist for artist in artists if artist.get_visible())


def _name(artist: Artist, otherwise: str) -> str:
    return said_label(artist) or otherwise


def _line(line: Line2D, axes: Axes, otherwise: str) -> _Curve:
    name = _name(line, otherwise)
    line.recache()  # steps are part of the path
    path = line.get_path()
    if line.get_linestyle() in {"None", "none", "", " "}:
        data: Points = np.ma.filled(np.ma.asarray(line.get_xydata(), dtype=float), np.nan)
        return _scattered(line, name, _to_data(data, line.get_transform(), axes), axes)
    points = _to_data(np.ma.filled(np.ma.asarray(path.vertices, dtype=float), np.nan), line.get_transform(), axes)
    return _thinned_curve(line, name, "line", points, axes)


def _scattered(artist: Artist, name: str, points: Points, axes: Axes) -> _Curve:
    if len(points) <= MOST_SCATTERED:
        return _Curve(artist, name, "points", points)
    digest = scattered(_in_axes_units(points, axes))
    sample = points[:: -(-len(points) // MOST_POINTS)]
    return _Curve(artist, name, "points", sample, special={"clouds": digest})


def _thinned_curve(artist: Artist, name: str, kind: Kind, points: Points, axes: Axes) -> _Curve:
    units = _in_axes_units(points, axes)
    with np.errstate(invalid="ignore"):
        steps = np.abs(np.diff(np.clip(units, -1.0, 2.0), axis=0)).sum(axis=1)
    if len(points) > 4 * MOST_POINTS and np.nansum(steps) > _LONG:
        thin, error = _sample(points, units), 1.0  # there is no use in looking for the best few points
    else:
        thin, error = _thinned(points, axes)
    if error <= _COARSE:
        return _Curve(artist, name, kind, thin, error)
    function = kind == "line" and not isinstance(axes, PolarAxes) and is_function(units)
    return _Curve(artist, name, kind, thin, error, {"dense": envelope(units, function=function)})


def _sample(points: Points, units: Points) -> Points:
    """Return the lowest and the highest of every so many points, for a picture of a curve that is too dense."""
    step = -(-2 * len(points) // MOST_POINTS)
    with np.errstate(invalid="ignore"):
        heights = np.where(finite(units), units[:, 1], np.nan)
    kept = []
    for start in range(0, len(points), step):
        part = heights[start : start + step]
        if np.isfinite(part).any():
            kept += sorted({start + int(np.nanargmin(part)), start + int(np.nanargmax(part))})
    return points[kept]


def _collection(collection: Collection, axes: Axes, place: int, heads: Sequence[Artist]) -> Iterator[_Curve]:
    if isinstance(collection, ContourSet):
        base = _name(collection, "level")
        kind: Kind = "area" if collection.filled else "line"
        for index, (level, path) in enumerate(zip(levels(collection), collection.get_paths(), strict=False)):
            points = _to_data(_of_path(path), collection.get_transform(), axes)
            points = without_specks(points, _in_axes_units(points, axes))
            curve = _thinned_curve(collection, f"{base} {level}", kind, points, axes)
            labels = covered(collection, index, _in_axes_units(points, axes), axes)
            yield replace(curve, special={**curve.special, "labels": labels}) if labels else curve
    elif isinstance(collection, PathCollection):  # a scatter plot: the offsets are the data
        offsets: Points = np.ma.filled(np.ma.asarray(collection.get_offsets(), dtype=float), np.nan)
        points = _to_data(offsets, collection.get_offset_transform(), axes)
        yield _scattered(collection, _name(collection, f"points {place}"), points, axes)
    elif type(collection).__name__ in _OUTLINED or isinstance(collection, LineCollection):
        # Only what lies in data coordinates; polygons that are stamped at many places do not.
        if np.size(collection.get_offsets()) > 2:
            return
        lines = isinstance(collection, LineCollection)
        pieces = [_of_path(path) for path in collection.get_paths()]
        pieces = joined_up(pieces) if heads else pieces
        points = _to_data(joined(pieces), collection.get_transform(), axes)
        name = _name(collection, f"{'lines' if lines else 'area'} {place}")
        if heads:
            thin, error = _thinned(points, axes, MOST_IN_STREAM)
            yield _Curve(collection, name, "line", thin, error, {"streams": len(heads)}, heads)
            return
        yield _thinned_curve(collection, name, "line" if lines else "area", points, axes)


# Filled areas; matplotlib derives arrows, barbs and much more from polygons, which are not areas.
# `fill_between` has a class of its own since matplotlib 3.10.
_OUTLINED = {"PolyCollection", "FillBetweenPolyCollection"}


def _shape(patch: Patch, axes: Axes) -> tuple[Points, float]:
    in_patch = _of_path(patch.get_path())
    in_data = patch.get_patch_transform().transform(in_patch)
    return _thinned(_to_data(in_data, patch.get_data_transform(), axes), axes)


def _of_path(path: Path) -> Points:
    """Return the vertices of a path, Bezier curves as `CHORDS` chords, with a break between its pieces."""
    if path.codes is None:
        return np.asarray(path.vertices, dtype=float)
    pieces: list[list[Points]] = []
    segments: Any = path.iter_bezier(simplify=False)  # pairs of segment and code; the stub has the segments only
    for segment, code in segments:
        if code == Path.MOVETO:
            pieces.append([segment.control_points[:1]])
        else:  # a closing line ends where its piece began
            pieces[-1].append(segment(_ALONG if code in {Path.CURVE3, Path.CURVE4} else _END))
    return joined([np.vstack(piece) for piece in pieces])


def _to_data(points: Points, transform: Transform, axes: Axes) -> Points:
    """Return points in data coordinates, however they are turned or projected before they become that.

    A fraction of the axes is mapped through the limits. An artist with a coordinate that is neither has no place
    among the curves and comes back empty.
    """
    in_data = transform.contains_branch_seperately(axes.transData)
    if all(in_data):
        return np.asarray((transform - axes.transData).transform(points), dtype=float)
    in_axes = transform.contains_branch_seperately(axes.transAxes)
    if not any(in_data) or not all(data or fraction for data, fraction in zip(in_data, in_axes, strict=True)):
        return np.empty((0, 2))
    to_data = axes.transAxes + axes.transData.inverted()
    mapped = to_data.transform(points)
    return np.column_stack([points[:, i] if in_data[i] else mapped[:, i] for i in (0, 1)])


def _thinned(points: Points, axes: Axes, most: int = MOST_POINTS) -> tuple[Points, float]:
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
    if len(runs) > most:  # more pieces than points: a picture of some of them has to do
        runs = runs[:: -(-len(runs) // most)]
        return joined([points[run] for run in runs]), 1.0
    pieces, error = [], 0.0
    for run in runs:
        share = max(2, round(most * len(run) / total))
        kept, distance = simplify(unit[run], THINNING, share)
        pieces.append(points[run[kept]])
        error = max(error, distance)
    return joined(pieces), error


def _in_axes_units(points: Points, axes: Axes) -> Points:
    """Return positions as fractions of the axes' width and height, whatever the scales are."""
    with np.errstate(all="ignore"):
        if isinstance(axes, PolarAxes):
            return np.asarray((axes.transData - axes.transAxes).transform(points))
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
        # An axis that shows a small part of large values, as one of dates does, needs more digits.
        large = max(abs(limits[0]), abs(limits[1])) / span if linear else 1.0
        digits = _DIGITS + max(0, math.ceil(math.log10(max(large, 1.0) * _FINE * 10**_DIGITS)) - 1)
        rounded[:, i] = [float(f"{value:.{digits}g}") for value in column]
    return rounded + 0.0  # no negative zeros
