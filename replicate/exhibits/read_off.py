"""Points read off a printed figure: drawn over our curve, and judged like a table within their reading error.

``printed/<figure>.csv`` holds them, one line for each::

    point,curve,x,y,x_error,y_error
    p1,ZN,1.5,1.24,0.05,0.02
    p2,ZN,3.0,1.02,0.05,0.02

``curve`` is the label of the curve in our drawing. A column ``panel`` names the axes by their title where several have
a curve of that label. A curve is what is drawn: straight between its points as the axes are scaled, or a staircase, or
a line across the axes. Errors are those of reading the page: half the width within which the point surely lies.
"""

from __future__ import annotations

import csv
import functools
import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.resources.abc import Traversable
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

from replicate.errors import PaperDefinitionError, PrintedFileError, listed
from replicate.exhibits.file_names import display_name
from replicate.exhibits.numerals import parse_number
from replicate.plain_text import read_text

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D
    from numpy.typing import NDArray

COLUMN = "y"
LABEL = "read off the original"

_NEEDED = ("point", "curve", "x", "y", "x_error", "y_error")
_NUMBERS = ("x", "y", "x_error", "y_error")

Draw = Callable[["Figure"], Any]  # what a wrong one returns is for others to refuse


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
    file: str = ""
    line: int = 0

    @property
    def height(self) -> float:
        """``y`` as a number."""
        return float(parse_number(self.y) or 0)


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
    columns = [column.strip() for column in reader.fieldnames or ()]
    reader.fieldnames = columns
    if not set(_NEEDED) <= set(columns) <= {*_NEEDED, "panel"} or len(set(columns)) < len(columns):
        msg = f"{name}:1: the columns are {','.join(columns) or 'missing'}; expected: {','.join(_NEEDED)} (and panel)"
        raise PrintedFileError(msg)
    points: dict[str, Point] = {}
    for row in reader:
        if None in row:
            count = len(columns) + len(row[None])
            msg = (
                f"{name}:{reader.line_num}: has {count} cells, the header has {len(columns)}; "
                "numbers have decimal points, and a text with a comma stands in quotes"
            )
            raise PrintedFileError(msg)
        point = _point(name, reader.line_num, row)
        if point.id in points:
            msg = f"{name}:{reader.line_num}: point '{point.id}' appears twice"
            raise PrintedFileError(msg)
        points[point.id] = point
    if not points:
        msg = f"{name}:1: holds no point"
        raise PrintedFileError(msg)
    return list(points.values())


def _point(file: str, line: int, row: dict[str, str]) -> Point:
    place = f"{file}:{line}"
    numbers = {}
    cells = {column: (row.get(column) or "").strip() for column in (*_NEEDED, "panel")}
    for column in _NUMBERS:
        number = parse_number(cells[column])
        if number is None or (column.endswith("_error") and number < 0):
            needed = "a number that is not negative" if column.endswith("_error") else "a number"
            msg = f"{place}: column '{column}': '{cells[column]}' is not {needed}"
            raise PrintedFileError(msg)
        numbers[column] = float(number)
    if not cells["point"]:
        msg = f"{place}: column 'point' is blank; expected: a name"
        raise PrintedFileError(msg)
    of_reading = numbers["x_error"], numbers["y_error"]
    return Point(cells["point"], cells["curve"], numbers["x"], cells["y"], *of_reading, cells["panel"], file, line)


def with_points(draw: Draw, points: Sequence[Point]) -> Draw:
    """Return a function that draws the figure and the points over it."""

    @functools.wraps(draw)
    def drawn(fig: Figure) -> object:
        made = draw(fig)
        if not any(axes.has_data() for axes in fig.axes):
            return made  # an empty figure is refused as such
        panels: dict[Axes, list[Point]] = {}
        for point in points:
            panels.setdefault(_curve_of(fig, point)[0], []).append(point)
        for axes, found in panels.items():
            x, y, x_error, y_error = zip(*((one.x, one.height, one.x_error, one.y_error) for one in found), strict=True)
            marks, *_ = axes.errorbar(x, y, yerr=y_error, xerr=x_error, fmt="ko", ms=3, elinewidth=0.8)
            marks.set_label(LABEL)  # not the container's, which the data of the figure does not show
        return made

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
        If there is no curve of a point's label, or several.
    """
    import pandas as pd
    from matplotlib.figure import Figure

    fig = Figure(figsize=size)
    draw(fig)
    rows = {point.id: _value_at(*_curve_of(fig, point), point) for point in points}
    return pd.DataFrame({COLUMN: rows}, index=list(rows))


def _value_at(axes: Axes, line: Line2D, point: Point) -> float | None:
    """Look for the value where the scales of the axes are linear: there a curve is straight between its points."""
    import numpy as np
    from matplotlib.cbook import STEP_LOOKUP_MAP

    scale = axes.transScale
    data = line.get_transform() == axes.transData
    to_scale = scale if data else line.get_transform() - (axes.transLimits + axes.transAxes)
    xy = np.asarray(to_scale.transform(np.asarray(line.get_xydata(), dtype=float)))
    steps = np.column_stack(STEP_LOOKUP_MAP[line.get_drawstyle()](*xy.T))
    (left, target), (right, _) = scale.transform(
        [(point.x - point.x_error, point.height), (point.x + point.x_error, point.height)]
    )
    found = _nearest(steps, left, right, target)
    return None if found is None else float(scale.inverted().transform((left, found))[1])


def _nearest(xy: NDArray, left: float, right: float, target: float) -> float | None:  # type: ignore[type-arg]
    """Return the height of a polyline, between two places of x, that is nearest to a target."""
    import numpy as np

    found: float | None = None
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


def _curve_of(fig: Figure, point: Point) -> tuple[Axes, Line2D]:
    """Return the one curve that has a point's label, and its axes."""
    panels = [axes for axes in fig.axes if not point.panel or axes.get_title() == point.panel]
    lines = [(axes, line) for axes in panels for line in axes.lines if line.get_label() == point.curve]
    if len(lines) == 1:
        return lines[0]
    place = f"{point.file}:{point.line}: point '{point.id}'"
    if len(lines) > 1:
        titles = ", ".join(dict.fromkeys(f"'{axes.get_title()}'" for axes, _ in lines))
        msg = f"{place}: {len(lines)} curves are '{point.curve}'; name the panel in a column 'panel': {titles}"
        raise PaperDefinitionError(msg)
    known = sorted({str(line.get_label()) for axes in panels for line in axes.lines} - {LABEL})
    curves = listed(label for label in known if not label.startswith("_"))
    where = f" in the panel '{point.panel}'" if point.panel else ""
    msg = f"{place}: there is no curve '{point.curve}'{where}; curves: {curves}"
    raise PaperDefinitionError(msg)
