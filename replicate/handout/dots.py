"""A table as a figure: a line for each row, on it a ring for what is printed and dots for what readings compute."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from replicate.display.tables import Cell, TableView
from replicate.errors import TemplateError
from replicate.exhibits import Figure
from replicate.exhibits.numerals import MINUS

if TYPE_CHECKING:
    from matplotlib.figure import Figure as MatplotlibFigure

_MARKERS = ("o", "s", "^", "D", "v")


@dataclass(frozen=True)
class Series:
    """The dots of one colour: a column as printed, or as one reading computes it.

    Attributes
    ----------
    reading
        Its id; empty for what is printed.
    """

    label: str
    column: str
    reading: str


@dataclass(frozen=True)
class DotChoice:
    """What of a table the figure shows; no rows or columns given means all.

    Attributes
    ----------
    readings
        Reading ids with their words; with several columns only one.
    labels
        Words for rows and columns.
    printed
        Words for what is printed; empty if it is not shown.
    axis
        Words for the axis; empty for those of the column.
    """

    columns: Sequence[str]
    rows: Sequence[str]
    readings: Mapping[str, str]
    labels: Mapping[str, str]
    printed: str
    axis: str
    log: bool


def dot_figure(view: TableView, choice: DotChoice, name: str, size: tuple[float, float]) -> Figure:
    """Return the figure, not drawn yet.

    Raises
    ------
    TemplateError
        If a row, column or reading does not exist, or there is nothing to show.
    """
    known = {"column": view.columns, "row": [row for row, _ in view.rows], "reading": [one.id for one in view.readings]}
    for what, wanted in (("column", choice.columns), ("row", choice.rows), ("reading", list(choice.readings))):
        for key in wanted:
            if key not in known[what]:
                msg = f"there is no {what} '{key}'; allowed: {', '.join(known[what]) or 'none'}"
                raise TemplateError(msg)
    columns, rows = choice.columns or view.columns, choice.rows or known["row"]
    cells = {(row, key): cell for row, found in view.rows for key, cell in zip(view.columns, found, strict=True)}
    labels = {**view.table.labels, **choice.labels}
    shown = [(one, _points(one, rows, cells)) for one in _series(columns, choice, labels)]
    if not any(points for _, points in shown):
        msg = "there is no number to show"
        raise TemplateError(msg)
    axis = choice.axis or (labels.get(columns[0], columns[0]) if len(columns) == 1 else "")

    def draw(fig: MatplotlibFigure) -> None:
        _draw(fig, shown, [labels.get(row, row) for row in rows], axis, log=choice.log)

    words = ", ".join(one.label for one, _ in shown)
    alt = f"Dots for each of {len(rows)} rows of the table, {axis or 'several quantities'}: {words}."
    return Figure(name, "figure", view.table.title, draw, alt=alt.replace("$", ""), size=size)


def _series(columns: Sequence[str], choice: DotChoice, labels: Mapping[str, str]) -> list[Series]:
    several = len(columns) > 1
    found = []
    for column in columns:
        words = labels.get(column, column)
        if choice.printed:
            found.append(Series(f"{words}, {choice.printed}" if several else choice.printed, column, ""))
        for reading, label in choice.readings.items():
            found.append(Series(words if several and len(choice.readings) == 1 else label, column, reading))
    return found


def _points(series: Series, rows: Sequence[str], cells: Mapping[tuple[str, str], Cell]) -> list[tuple[float, int]]:
    """Return value and place of the dots of a series; a row without a number has none."""
    found = []
    for place, row in enumerate(rows):
        cell = cells[row, series.column]
        texts = (
            [cell.printed]
            if not series.reading
            else [value.full for value in cell.values if value.reading.id == series.reading]
        )
        for text in texts:
            try:
                number = float(text.replace(MINUS, "-"))
            except ValueError:
                continue
            if math.isfinite(number):
                found.append((number, place))
    return found


def _draw(
    fig: MatplotlibFigure,
    shown: Sequence[tuple[Series, list[tuple[float, int]]]],
    rows: Sequence[str],
    axis: str,
    *,
    log: bool,
) -> None:
    axes = fig.subplots()
    colours, markers, rings = itertools.count(), itertools.cycle(_MARKERS), itertools.cycle(_MARKERS)
    for series, points in shown:
        values, places = [value for value, _ in points], [place for _, place in points]
        if not series.reading:  # as a ring, in which a dot that agrees lies
            axes.plot(
                values, places, next(rings), color="0.35", markerfacecolor="none", markersize=10, label=series.label
            )
        else:
            axes.plot(
                values, places, next(markers), color=f"C{next(colours)}", markersize=5, label=series.label, alpha=0.9
            )
    axes.set(yticks=range(len(rows)), yticklabels=rows, ylim=(len(rows) - 0.4, -0.6), xlabel=axis)
    axes.margins(x=0.03)
    axes.grid(visible=True)
    if log:
        from matplotlib.ticker import LogLocator, NullFormatter

        axes.set_xscale("log")
        axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axes.xaxis.set_major_formatter("{x:g}")
        axes.xaxis.set_minor_formatter(NullFormatter())
    if len(shown) > 1:
        fig.legend(loc="outside upper center", ncols=len(shown))
