"""How the charts draw loci: as Bezier curves that stay smooth at any zoom, with their labels on them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from replicate.papers.krajewski.loci import Locus

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.path import Path

Array = NDArray[np.float64]

CURVE_ERROR = 1e-6  # of the width and height of a curve; a page of 1000 mm would show it as 1 micrometre
FIRST_SEGMENTS = 8


def bezier_path(loci: Sequence[Locus], *, closed: bool = False) -> Path:
    """Return consecutive loci as one path of cubic Bezier curves.

    Each segment has the exact end points and derivatives of the locus, and is halved until its middle lies on
    the locus.
    """
    from matplotlib.path import Path

    vertices: list[Array] = []
    codes: list[np.uint8] = []
    for locus in loci:
        u = breakpoints(locus)
        points, slopes = locus.curve(u)
        third = (np.diff(u) / 3.0)[:, None] * np.ones(2)
        cubic = np.stack([points[:-1] + third * slopes[:-1], points[1:] - third * slopes[1:], points[1:]], axis=1)
        if not vertices:
            vertices.append(points[:1])
            codes.append(Path.MOVETO)
        elif not np.allclose(points[0], vertices[-1][-1], rtol=0.0, atol=1e-9):
            vertices.append(points[:1])
            codes.append(Path.LINETO)
        vertices.append(cubic.reshape(-1, 2))
        codes += [Path.CURVE4] * (3 * len(cubic))
    if closed:
        vertices.append(vertices[0])
        codes.append(Path.CLOSEPOLY)
    return Path(np.vstack(vertices), codes)


def breakpoints(locus: Locus) -> Array:
    """Return parameters between which one cubic with the locus' derivatives follows it to `CURVE_ERROR`."""
    u = np.linspace(0.0, 1.0, FIRST_SEGMENTS + 1)
    while True:
        points, slopes = locus.curve(u)
        middle = 0.5 * (u[1:] + u[:-1])
        h = np.diff(u)[:, None]
        cubic = 0.5 * (points[:-1] + points[1:]) + h / 8.0 * (slopes[:-1] - slopes[1:])
        size = np.maximum(np.ptp(points, axis=0), 1e-12)
        worse = np.max(np.abs(cubic - locus.curve(middle)[0]) / size, axis=1) > CURVE_ERROR
        if not worse.any() or u.size > 2000:
            return u
        u = np.sort(np.concatenate([u, middle[worse]]))


def draw_locus(axes: Axes, loci: Locus | Sequence[Locus], label: str, **style: Any) -> None:
    """Draw one locus, or the pieces of one, under a name that the curve's data will carry."""
    from matplotlib.patches import PathPatch

    pieces = [loci] if isinstance(loci, Locus) else loci
    style = {"linewidth": 1.6, "capstyle": "butt"} | style
    axes.add_patch(PathPatch(bezier_path(pieces), fill=False, label=label, **style))


def fill_loci(axes: Axes, loci: Sequence[Locus], label: str, **style: Any) -> None:
    """Fill the region that consecutive loci enclose."""
    from matplotlib.patches import PathPatch

    axes.add_patch(PathPatch(bezier_path(loci, closed=True), linewidth=0.0, label=label, **style))


def label_locus(axes: Axes, locus: Locus, u: float, text: str, color: Any, **style: Any) -> None:
    """Write a label on a locus at parameter u, along its tangent, on a patch of the page's colour."""
    import matplotlib as mpl

    paper = mpl.rcParams["legend.facecolor"]  # the colour of the page in the project's style
    (point,), (slope,) = locus.curve(np.array([u]))
    angle = float(np.degrees(np.arctan2(slope[1], slope[0])))
    # never upside down, and steep labels all read upwards: as seen on the page, where the axes' scales differ
    scale = np.ptp(axes.get_xlim()), np.ptp(axes.get_ylim())
    if not -80.0 < np.degrees(np.arctan2(slope[1] / scale[1], slope[0] / scale[0])) <= 100.0:
        angle -= 180.0 * np.sign(angle)
    box = {
        "boxstyle": "round,pad=0.12,rounding_size=0.3",
        "facecolor": "white" if paper == "inherit" else paper,
        "edgecolor": "none",
    }
    options: dict[str, Any] = {
        "rotation": angle,
        "rotation_mode": "anchor",
        "transform_rotates_text": True,
        "ha": "center",
        "va": "center",
        "fontsize": 9,
        "bbox": box,
        "clip_on": True,
        "zorder": 3,
    } | style
    axes.text(float(point[0]), float(point[1]), text, color=color, **options)


def mark_point(axes: Axes, a: float, b: float, text: str, offset: tuple[float, float], **style: Any) -> None:
    """Mark a point of the plane with a dot and a name beside it."""
    axes.plot([a], [b], "o", color=axes.xaxis.label.get_color(), markersize=4.5, label=text, zorder=4)
    axes.annotate(text, (a, b), xytext=offset, textcoords="offset points", fontsize=10, zorder=4, **style)


def plane(axes: Axes, a: tuple[float, float], b: tuple[float, float], title: str = "") -> None:
    """Prepare axes of the (a, b) plane: limits, names and the two axes of the plane."""
    axes.set_xlim(*a)
    axes.set_ylim(*b)
    axes.set_xlabel("$a = K K_I T$")
    axes.set_ylabel("$b = K K_P$")
    axes.set_title(title)
    axes.axhline(0.0, color="0.5", linewidth=0.7, zorder=0)


def inside(locus: Locus, a: tuple[float, float], b: tuple[float, float], fraction: float) -> float | None:
    """Return the parameter at a fraction of the longest part of a locus inside a box; ``None`` if none is."""
    u = np.linspace(0.0, 1.0, 2001)
    x, y = locus.curve(u)[0].T
    within = (x >= a[0]) & (x <= a[1]) & (y >= b[0]) & (y <= b[1])
    edges = np.flatnonzero(np.diff(np.concatenate([[False], within, [False]]).astype(int)))
    runs = [(start, end - 1) for start, end in zip(edges[::2], edges[1::2], strict=True)]
    if not runs:
        return None
    start, end = max(runs, key=lambda run: run[1] - run[0])
    length = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x) / (a[1] - a[0]), np.diff(y) / (b[1] - b[0])))])
    target = length[start] + fraction * (length[end] - length[start])
    return float(np.interp(target, length, u))
