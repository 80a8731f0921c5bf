"""What the columns of the tables and curves in CSV are: label and unit without markup, panel by panel for a figure."""

from __future__ import annotations

import re
from collections.abc import Iterator

from replicate.exhibits import Figure, Paper, Table
from replicate.exhibits.results import FigureResult, Results, TableResult

COLUMN_COLUMNS = ("file", "panel", "column", "label", "unit")

_UNIT = re.compile(r"^(?P<label>.+?)\s*[\[(](?P<unit>[^\[\]()]{1,12})[\])]$")
_FONT = re.compile(r"\\(?:mathrm|mathit|mathbf|mathsf|text|operatorname|rm|bar|hat|tilde|left|right|[,;!: ])")
_FRACTION = re.compile(r"\\[dt]?frac\{([^{}]*)\}\{([^{}]*)\}")


def column_rows(paper: Paper, results: Results) -> Iterator[tuple[str, str, str, str, str]]:
    """Yield a row for every column of a paper's tables, and for both axes of every panel of its figures.

    The file is named without the reading, since all readings of a table have the same columns.
    """
    for exhibit in paper.exhibits.values():
        result = results.get((paper.id, exhibit.id))
        if isinstance(exhibit, Table) and isinstance(result, TableResult):
            first = next(iter(result.cells.values()), None)
            for column in exhibit.columns or (first.columns if first else ()):
                label = unmarked(exhibit.labels.get(column, column.replace("_", " ")))
                yield (
                    f"tables/{paper.id}/{exhibit.id}.*.csv",
                    "",
                    column,
                    label,
                    unmarked(exhibit.units.get(column, "")),
                )
        elif isinstance(exhibit, Figure) and isinstance(result, FigureResult):
            for panel in result.axes:
                for axis in "xy":
                    label, unit = _split(unmarked(panel.get(f"{axis}label", "")))
                    name = str(panel["panel"])
                    yield f"figures/{paper.id}/{exhibit.id}.csv", name, axis, label or axis, unit


def unmarked(text: str) -> str:
    r"""Return a label without Markdown and TeX.

    Examples
    --------
    >>> unmarked(r"I, $K_{Popt}$: *a*"), unmarked(r"$\frac{1}{\tau}$"), unmarked("$t$ (s)")
    ('I, K_Popt: a', '1/tau', 't (s)')
    """
    text = _FRACTION.sub(r"\1/\2", _FONT.sub("", text))
    return " ".join(re.sub(r"[$*`{}\\]", "", text).split())


def _split(label: str) -> tuple[str, str]:
    found = _UNIT.match(label)
    return (found["label"], found["unit"]) if found else (label, "")
