"""What things are called in the files of the data: columns, panels, curves and drawings, all without markup."""

from __future__ import annotations

import html
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from replicate.display.labels import key_text
from replicate.display.unmarked import unmarked
from replicate.exhibits import Figure, Paper, Table
from replicate.exhibits.results import FigureResult, Results, TableResult

if TYPE_CHECKING:
    import pandas as pd

COLUMN_COLUMNS = ("file", "panel", "column", "label", "unit")

_UNIT = re.compile(r"^(?P<label>.+?)\s*[\[(](?P<unit>[^\[\]()]{1,12})[\])]$")
_TITLE = re.compile("(?<=title>)[^<]+(?=</)")
_LONGEST_NAME = 60  # it stands in every line of the data


def column_rows(paper: Paper, results: Results) -> Iterator[tuple[str, str, str, str, str]]:
    """Yield a row for every column of a paper's tables, and for both axes of every panel of its figures.

    The file is named without the reading, since all readings of a table have the same columns.
    """
    for exhibit in paper.exhibits.values():
        result = results.get((paper.id, exhibit.id))
        if isinstance(exhibit, Table) and isinstance(result, TableResult):
            first = next(iter(result.cells.values()), None)
            for column in exhibit.columns or (first.columns if first else ()):
                label = unmarked(exhibit.labels.get(column, key_text(column)))
                yield (
                    f"tables/{paper.id}/{exhibit.id}.*.csv",
                    "",
                    column,
                    label,
                    unmarked(exhibit.units.get(column, "")),
                )
        elif isinstance(exhibit, Figure) and isinstance(result, FigureResult):
            names = _panel_names(result.axes)
            for panel in result.axes:
                for axis in "xy":
                    label, unit = _split(unmarked(panel.get(f"{axis}label", "")))
                    yield f"figures/{paper.id}/{exhibit.id}.csv", names[panel["panel"]], axis, label or axis, unit


def named_curves(result: FigureResult) -> pd.DataFrame:
    """Return the curves of a figure with names that say what they are: titles of panels, and labels without markup."""
    panels, curves = _panel_names(result.axes), result.curves
    labels = _told_apart({name: name for name in curves["curve"]})
    return curves.assign(
        panel=[panels.get(name, name) for name in curves["panel"]], curve=[labels[name] for name in curves["curve"]]
    )


def named_drawing(svg: str) -> str:
    r"""Return a drawing whose titles, of the document and in its metadata, have no markup.

    Examples
    --------
    >>> named_drawing(r"<svg><title>Against $\omega_p$, $p &lt; 1$</title></svg>")
    '<svg><title>Against ω_p, p &lt; 1</title></svg>'
    """
    return _TITLE.sub(lambda found: html.escape(unmarked(html.unescape(found[0]))), svg)


def _panel_names(axes: Iterable[Mapping[str, Any]]) -> dict[str, str]:
    """Return, by the name that a figure's record uses, the title of a panel."""
    return _told_apart({panel["panel"]: panel.get("title", "") for panel in axes})


def _told_apart(texts: Mapping[str, str]) -> dict[str, str]:
    """Return, by name, a text without markup; the name where there is none that is short and belongs to it alone.

    Examples
    --------
    >>> _told_apart({"panel 1": "$G_{1}$", "panel 2": "", "panel 3": "low", "panel 4": "*low*"})
    {'panel 1': 'G_1', 'panel 2': 'panel 2', 'panel 3': 'panel 3', 'panel 4': 'panel 4'}
    """
    plain = {name: unmarked(text) for name, text in texts.items()}
    used = Counter(plain.values())
    return {name: text if 0 < len(text) <= _LONGEST_NAME and used[text] == 1 else name for name, text in plain.items()}


def _split(label: str) -> tuple[str, str]:
    found = _UNIT.match(label)
    return (found["label"], found["unit"]) if found else (label, "")
