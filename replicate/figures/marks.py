"""What the renderer was asked to draw, as marks: plain data in fractions of a box, ready for JSON.

A mark says what is drawn (``draws``), how it looks and where it lies. Its fields:

- ``edge``, ``face``: colours, ``#rrggbb`` or ``#rrggbbaa``; left out where there is no line or no fill
- ``width``, ``dash``, ``cap``, ``join``: of the line, lengths in points
- ``hatch``, ``sketch``, ``clip`` (left out if clipped to the axes, ``none`` if not clipped)
- ``outline``: where its lines run; ``symbol``: the shape of a marker in inches, ``places`` where it is drawn and
  ``scale`` how large; ``symbols``, where each of many points has its own
- ``inside``: the box around it, in points, in a drawing that is packed with texts, such as the handle of a legend
- ``texts``, ``size``, ``angle``, ``align``, ``weight``, ``slant`` of texts and ``at``, where they are anchored;
  ``image``, the mean colours of its blocks, and the corners of a picture

A field with one value for each of many items holds a list, or a digest if it would be long.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.collections import PathCollection
from matplotlib.offsetbox import AuxTransformBox, DrawingArea, OffsetImage

from replicate.figures.digests import MOST_VALUES, Array, line_waves, rounded, values_digest
from replicate.figures.outlines import OUTLINE_TOLERANCE, flattened, joined, outline, scattered
from replicate.figures.polylines import Points
from replicate.figures.recorder import DPI, Drawn
from replicate.figures.scaling import finite

Mark = dict[str, Any]

_SAME_BOX = 1e-3
_DECIMALS = 3
_COARSE = 5e-3
_BLOCKS = 8
# The box that the outline of a marker is a fraction of, in points.
_INCH = 72.0
# A tenth of a point.
_FINE = 1.4e-3
_WIDE = 2.0
_ALIGNED = "left baseline"


@dataclass(frozen=True)
class Box:
    """A rectangle in pixels: the axes of what is drawn, or the whole figure."""

    left: float
    bottom: float
    width: float
    height: float

    @classmethod
    def of(cls, extents: Sequence[float]) -> Box:
        """Return the box with these ends: left, bottom, right, top."""
        left, bottom, right, top = (float(end) for end in extents)
        return cls(left, bottom, (right - left) or 1.0, (top - bottom) or 1.0)

    def units(self, pixels: Any) -> Array:
        """Return pixels as fractions of the box."""
        corner, size = (self.left, self.bottom), (self.width, self.height)
        return np.asarray((np.asarray(pixels, dtype=float) - corner) / size)


def marks_of(
    calls: Sequence[Drawn], box: Box, *, where: bool = True, loose: bool = False, outlined: bool = True
) -> list[Mark]:
    """Return marks; what is drawn one after the other with the same look becomes one of them.

    Parameters
    ----------
    where
        Whether places matter. Those of a thing that follows a text do not.
    loose
        Whether they are compared with a wide tolerance only: then fewer points are kept.
    outlined
        Whether it matters where lines run. Those of a curve are compared as data.
    """
    marks: list[Mark] = []
    lines: list[list[Points]] = []
    inside: list[list[Points]] = []
    for drawn in calls:
        look = _look(drawn, box)
        corners = drawn.kind in {"mesh", "triangles"} or drawn.offsets is not None
        if drawn.kind in {"text", "image"}:
            points = np.asarray(drawn.extra["place" if drawn.kind == "text" else "corners"], dtype=float).reshape(-1, 2)
        elif drawn.offsets is None:
            points = joined([flattened(path) for path in drawn.paths])
        elif len(drawn.paths) > 1:  # shapes of their own, each at its place
            corners = False
            points = joined([flattened(drawn.paths[i % len(drawn.paths)]) + at for i, at in enumerate(drawn.offsets)])
        else:
            points = drawn.offsets
        if not (marks and marks[-1]["look"] == look and drawn.kind != "image"):
            marks.append({"look": look, "corners": corners, "texts": []})
            lines.append([])
            inside.append([])
        lines[-1].append(box.units(points))
        inside[-1] += _in_drawing(drawn, points)
        if drawn.kind == "text":
            marks[-1]["texts"].append(drawn.extra["text"])
    tolerance = _COARSE if loose else OUTLINE_TOLERANCE
    return [
        _mark(mark, points, tolerance, where=where, outlined=outlined) | _reach(drawing)
        for mark, points, drawing in zip(marks, lines, inside, strict=True)
    ]


def _in_drawing(drawn: Drawn, points: Points) -> list[Points]:
    """Return where something lies inside a drawing that is packed with texts, in points: nothing there follows them."""
    for artist in reversed(drawn.artists):
        if isinstance(artist, DrawingArea | AuxTransformBox):
            origin = artist.offset_transform.transform((0.0, 0.0))
        elif isinstance(artist, OffsetImage):
            origin = points[0]
        else:
            continue
        return [(points - origin) * _INCH / DPI]
    return []


def _reach(points: list[Points]) -> Mark:
    """Return the box around what lies inside a drawing: left, bottom, right, top."""
    there = [part[finite(part)] for part in points]
    if not any(map(len, there)):
        return {}
    together = np.vstack(there)
    return {"inside": [round(float(end), 2) for end in (*together.min(axis=0), *together.max(axis=0))]}


def _mark(mark: Mark, points: list[Points], tolerance: float, *, where: bool, outlined: bool) -> Mark:
    found: Mark = dict(mark["look"])
    if mark["texts"]:
        found["texts"] = mark["texts"]
        if where:
            found["at"] = [rounded(place[0], 5) for place in points]
    elif found["draws"] == "image":
        if where:
            found["at"] = [rounded(corner, 5) for corner in points[0]]
    elif mark["corners"]:
        if where:
            found["places"] = scattered(np.vstack(points))
    elif where and outlined:
        found["outline"] = outline(joined(points), tolerance=tolerance)
    return found


def _look(drawn: Drawn, box: Box) -> Mark:
    """Return how something looks, wherever it is."""
    mark: Mark = {"draws": drawn.kind}
    if drawn.kind == "text":
        return mark | _text(drawn)
    if drawn.kind == "image":
        return mark | _image(drawn) | _clip(drawn, box)
    mark |= _lines(drawn) | _clip(drawn, box)
    faces = _colours(drawn.faces)
    if faces is not None:
        mark["face"] = faces
    if drawn.kind == "mesh":
        mark["size"] = list(drawn.extra["size"])
    if drawn.offsets is not None and len(drawn.paths) == 1:
        mark |= _symbol(drawn) | _scale(drawn)
    elif drawn.offsets is not None and isinstance(drawn.artists[-1], PathCollection):
        mark |= _many_symbols(drawn) | _scale(drawn)
    return mark


def _lines(drawn: Drawn) -> Mark:
    edges = _colours(drawn.edges)
    widths = np.asarray(drawn.widths, dtype=float)
    mark: Mark = {}
    if drawn.sketch:
        mark["sketch"] = rounded(drawn.sketch)
    if drawn.hatch:
        mark["hatch"] = drawn.hatch
    if edges is None or not widths.any():
        return mark
    mark |= {"edge": edges, "width": _values(widths)}
    dashes = [_dash(pattern) for pattern in drawn.dashes]
    if any(dashes):
        mark["dash"] = dashes[0] if all(dash == dashes[0] for dash in dashes) else dashes[:MOST_VALUES]
    if widths.max() >= _WIDE:  # the ends of thin lines cannot be seen
        mark |= {"cap": drawn.cap, "join": drawn.join}
    return mark


def _dash(pattern: Any) -> list[float]:
    offset, lengths = pattern
    if lengths is None or not len(lengths):
        return []
    return [round(float(value), _DECIMALS) for value in (offset or 0.0, *lengths)]


def _clip(drawn: Drawn, box: Box) -> Mark:
    if drawn.clip_path is not None:
        return {"clip": outline(box.units(flattened(drawn.clip_path)))}
    if drawn.clip_box is None:
        return {"clip": "none"}
    ends = box.units(np.reshape(drawn.clip_box, (2, 2))).ravel()
    if np.abs(ends - [0.0, 0.0, 1.0, 1.0]).max() <= _SAME_BOX:
        return {}
    return {"clip": outline(ends[[0, 1, 2, 1, 2, 3, 0, 3, 0, 1]].reshape(-1, 2))}


def _symbol(drawn: Drawn) -> Mark:
    """Describe the shape of a marker in inches, of unit size if it has many sizes."""
    scales = drawn.scales if drawn.scales is not None and len(drawn.scales) else np.ones(1)
    points = flattened(drawn.paths[0]) / (float(scales[0]) or 1.0)
    points *= 1.0 if drawn.scales is not None else 72.0 / DPI
    largest = float(scales.max()) * 72.0 / DPI if drawn.scales is not None else 1.0
    return {"symbol": outline(points / _INCH, tolerance=_FINE / (largest or 1.0))}


def _many_symbols(drawn: Drawn) -> Mark:
    """Describe the shapes of points that have one each, as seaborn draws them, all of unit size."""
    scales = drawn.scales if drawn.scales is not None and len(drawn.scales) else np.ones(1)
    each = [_weighed(flattened(path) / (float(scales[i % len(scales)]) or 1.0)) for i, path in enumerate(drawn.paths)]
    count = 0 if drawn.offsets is None else len(drawn.offsets)
    return {"symbols": values_digest(np.array([each[i % len(each)] for i in range(count)]))}


def _weighed(points: Points) -> Array:
    there = finite(points)
    both = there[:-1] & there[1:]
    return line_waves(points[:-1][both], points[1:][both])


def _scale(drawn: Drawn) -> Mark:
    return {} if drawn.scales is None else {"scale": _values(drawn.scales * 72.0 / DPI)}


def _text(drawn: Drawn) -> Mark:
    font = drawn.extra["font"]
    mark: Mark = {"size": round(float(font.get_size_in_points()), 2)}
    colour = _colours(drawn.edges[:1] if len(drawn.edges) else np.array([[0.0, 0.0, 0.0, 1.0]]))
    mark = mark if colour is None else {"edge": colour, **mark}
    weight, slant = font.get_weight(), font.get_style()
    if weight not in {"normal", "regular", 400}:
        mark["weight"] = str(weight)
    if slant != "normal":
        mark["slant"] = str(slant)
    if drawn.extra["angle"] % 360.0:
        mark["angle"] = round(drawn.extra["angle"] % 360.0, 2)
    if drawn.extra.get("align", _ALIGNED) != _ALIGNED:
        mark["align"] = drawn.extra["align"]
    return mark


def _image(drawn: Drawn) -> Mark:
    """Describe a picture by the mean colours of blocks, with colours weighed by how opaque they are."""
    image = drawn.extra["image"].astype(float) / 255.0
    image[..., :3] *= image[..., 3:]
    rows = np.array_split(image, min(_BLOCKS, image.shape[0]), axis=0)
    means = [
        [block.mean(axis=(0, 1)) for block in np.array_split(row, min(_BLOCKS, image.shape[1]), axis=1)] for row in rows
    ]
    return {"image": [[[round(float(part), 3) for part in cell] for cell in row] for row in means]}


def _colours(colours: Array) -> Any:
    """Return one colour, a list or a digest; ``None`` if nothing can be seen."""
    if not len(colours) or not colours[:, 3].any():
        return None
    if len(colours) == 1 or np.abs(colours - colours[0]).max() < 1e-3:
        return hexed(colours[0])
    if len(colours) <= MOST_VALUES:
        return [hexed(colour) for colour in colours]
    return values_digest(colours)


def hexed(colour: Array) -> str:
    """Return a colour as text.

    Examples
    --------
    >>> import numpy as np
    >>> hexed(np.array([1.0, 0.5, 0.0, 1.0])), hexed(np.array([1.0, 0.5, 0.0, 0.5]))
    ('#ff8000', '#ff800080')
    """
    parts = [round(255.0 * float(part)) for part in np.clip(colour, 0.0, 1.0)]
    return "#" + "".join(f"{part:02x}" for part in (parts if parts[3] < 255 else parts[:3]))


def _values(values: Array) -> Any:
    if len(values) == 1 or np.ptp(values) <= 1e-9 * abs(values[0]):
        return round(float(values[0]), _DECIMALS)
    if len(values) <= MOST_VALUES:
        return [round(float(value), _DECIMALS) for value in values]
    return values_digest(values)
