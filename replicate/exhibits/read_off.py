"""Points read off a printed figure: drawn over our curve, and judged like a table within their reading error.

``printed/<figure>.csv`` holds them, one line for each::

    point,curve,x,y,x_error,y_error
    p1,ZN,1.5,1.24,0.05,0.02
    p2,ZN,3.0,1.02,0.05,0.02

``curve`` is the label of the curve in our drawing. A column ``panel`` names the axes by their title where several have
a curve of that label. Errors are those of reading the page: half the width within which the point surely lies.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.resources.abc import Traversable
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

from replicate.errors import PaperDefinitionError, PrintedFileError
from replicate.exhibits.file_names import display_name
from replicate.exhibits.numerals import parse_number
from replicate.plain_text import read_text

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

COLUMN = "y"
LABEL = "read off the original"

_NEEDED = ("point", "curve", "x", "y", "x_error", "y_error")
_NUMBERS = ("x", "y", "x_error", "y_error")

Draw = Callable[["Figure"], None]


@dataclass(frozen=True)
class Point:
    """A point read off the original; ``y`` is kept as text, as every printed value is."""

    id: str
    curve: str
    x: float
    y: str
    x_error: float
    y_error: float
    panel: str = ""
    line: int = 0


def read_points(path: Traversable | Path) -> list[Point]:
    """Read the points of a figure.

    Raises
    ------
    PrintedFileError
        If the file cannot be read, a column is missing, a cell is not a number, or a point appears twice.
    """
    name = display_name(path)
    text = read_text(path, name, PrintedFileError)
    reader = csv.DictReader(io.StringIO(text, newline=""))
    columns = reader.fieldnames or ()
    if not set(_NEEDED) <= set(columns) <= {*_NEEDED, "panel"}:
        msg = f"{name}:1: the columns are {','.join(columns) or 'missing'}; expected: {','.join(_NEEDED)} (and panel)"
        raise PrintedFileError(msg)
    points: dict[str, Point] = {}
    for row in reader:
        point = _point(f"{name}:{reader.line_num}", row, reader.line_num)
        if point.id in points:
            msg = f"{name}:{reader.line_num}: point '{point.id}' appears twice"
            raise PrintedFileError(msg)
        points[point.id] = point
    if not points:
        msg = f"{name}:1: holds no point"
        raise PrintedFileError(msg)
    return list(points.values())


def _point(place: str, row: dict[str, str], line: int) -> Point:
    cells = {column: (row.get(column) or "").strip() for column in (*_NEEDED, "panel")}
    for column in _NUMBERS:
        number = parse_number(cells[column])
        if number is None or (column.endswith("_error") and number < 0):
            needed = "a number that is not negative" if column.endswith("_error") else "a number"
            msg = f"{place}: column '{column}': '{cells[column]}' is not {needed}"
            raise PrintedFileError(msg)
    if not cells["point"]:
        msg = f"{place}: column 'point' is blank; expected: a name"
        raise PrintedFileError(msg)
    return Point(
        cells["point"],
        cells["curve"],
        float(cells["x"]),
        cells["y"],
        float(cells["x_error"]),
        float(cells["y_error"]),
        cells["panel"],
        line,
    )


def with_points(draw: Draw, points: Sequence[Point]) -> Draw:
    """Return a function that draws the figure and the points over it."""

    def drawn(fig: Figure) -> None:
        draw(fig)
        labelled: set[object] = set()
        for point in points:
            axes = _axes_of(fig, point)
            label = "_nolegend_" if axes in labelled else LABEL
            labelled.add(axes)
            axes.errorbar(
                [point.x], [float(point.y)], yerr=point.y_error, xerr=point.x_error, fmt="ko", ms=3, lw=0.8, label=label
            )

    return drawn


def values_at(draw: Draw, points: Sequence[Point], size: tuple[float, float]) -> pd.DataFrame:
    """Return the curve's value for each point: of those within the reading error of x, the one nearest to the point.

    Parameters
    ----------
    size
        Of the figure, in inches.

    Raises
    ------
    PaperDefinitionError
        If there is no curve of a point's label.
    """
    import pandas as pd
    from matplotlib.figure import Figure

    fig = Figure(figsize=size)
    draw(fig)
    rows = {point.id: _value_at(_axes_of(fig, point), point) for point in points}
    return pd.DataFrame({COLUMN: rows}, index=list(rows))


def _value_at(axes: Axes, point: Point) -> float | None:
    import numpy as np

    line = next(line for line in axes.lines if line.get_label() == point.curve)
    xy = np.asarray(line.get_xydata(), dtype=float)
    return _nearest(xy, point)


def _nearest(xy: NDArray, point: Point) -> float | None:  # type: ignore[type-arg]
    """Return the height of the polyline that is nearest to the point within the reading error of x."""
    import numpy as np

    left, right = point.x - point.x_error, point.x + point.x_error
    found: float | None = None
    target = float(point.y)
    for (x1, y1), (x2, y2) in pairwise(xy):
        if not np.isfinite([x1, y1, x2, y2]).all() or max(x1, x2) < left or min(x1, x2) > right:
            continue
        if x1 == x2:
            low, high = sorted((y1, y2))
        else:
            ends = [y1 + (y2 - y1) * (min(max(x, min(x1, x2)), max(x1, x2)) - x1) / (x2 - x1) for x in (left, right)]
            low, high = sorted(ends)
        value = float(min(max(target, low), high))
        if found is None or abs(value - target) < abs(found - target):
            found = value
    return found


def _axes_of(fig: Figure, point: Point) -> Axes:
    panels = [axes for axes in fig.axes if not point.panel or axes.get_title() == point.panel]
    for axes in panels:
        if any(line.get_label() == point.curve for line in axes.lines):
            return axes
    known = sorted({str(line.get_label()) for axes in panels for line in axes.lines} - {LABEL})
    curves = ", ".join(f"'{label}'" for label in known if not label.startswith("_")) or "none"
    msg = f"point '{point.id}': there is no curve '{point.curve}'; curves: {curves}"
    raise PaperDefinitionError(msg)
