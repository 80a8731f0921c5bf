"""What becomes of a drawn matplotlib figure: an SVG, a PNG, its curves as data and a description of its axes."""

from __future__ import annotations

import hashlib
import io
import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import pandas as pd

from replicate.figures import style
from replicate.figures.readback import read_panel

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Canvas

_LONGEST_NAME = 24


def read_figure(canvas: Canvas) -> tuple[pd.DataFrame, list[dict[str, Any]]]:
    """Return the curves of a drawn figure, and the description of its axes."""
    panels = [read_panel(name, axes) for name, axes in _panels(canvas)]
    rows = [row for rows, _ in panels for row in rows]
    frame = pd.DataFrame(rows, columns=["panel", "curve", "x", "y"])
    described = [description for _, description in panels]
    if described:
        described[0] |= _outside_the_axes(canvas)
    return frame.astype({"panel": object, "curve": object, "x": float, "y": float}), described


def _panels(canvas: Canvas) -> Iterator[tuple[str, Axes]]:
    """Name every axes by its title, or by its place where it has none that is short and plain.

    The name stands in every line of the data; one used again gets a number.
    """
    used: dict[str, int] = {}
    for place, axes in enumerate((axes for axes in canvas.axes if axes.get_visible()), start=1):
        title = axes.get_title() or axes.get_title(loc="left") or axes.get_title(loc="right")
        name = " ".join(title.split())
        if not name or len(name) > _LONGEST_NAME or "$" in name:
            name = f"panel {place}"
        used[name] = used.get(name, 0) + 1
        yield (name if used[name] == 1 else f"{name} ({used[name]})"), axes


def _outside_the_axes(canvas: Canvas) -> dict[str, Any]:
    """Describe texts and legends that belong to the figure as a whole; they are kept with the first panel."""
    title = canvas.get_suptitle()
    texts = [text.get_text() for text in canvas.texts if text.get_text() not in {"", title}]
    legends = [entry.get_text() for legend in canvas.legends for entry in legend.get_texts()]
    found: dict[str, Any] = {}
    if title:
        found["figure_title"] = title
    if texts:
        found["figure_texts"] = texts
    if legends:
        found["figure_legend"] = legends
    return found


def svg_text(canvas: Canvas, title: str) -> str:
    """Return a drawn figure as a transparent SVG without date and versions."""
    buffer = io.StringIO()
    unknown = dict.fromkeys(("Date", "Creator", "Format", "Type"))
    canvas.savefig(buffer, format="svg", transparent=True, metadata={**unknown, "Title": title})
    svg = _settled_ids(buffer.getvalue()).replace("#000000", style.INK)
    # matplotlib writes no fill for black shapes and texts: let them inherit the ink colour.
    return svg.replace("<g ", f'<g fill="{style.INK}" ', 1)


def _settled_ids(svg: str) -> str:
    """Name clips and markers by their order in the file.

    matplotlib names them by a hash of their coordinates, whose last bit depends on the order in which the layout solver
    happens to add: the same picture would have different bytes.
    """
    import matplotlib as mpl

    salt = mpl.rcParams["svg.hashsalt"] or ""
    names: dict[str, str] = {}

    def settled(match: re.Match[str]) -> str:
        order = f"{salt}/{len(names)}".encode()
        return names.setdefault(match[0], match[0][0] + hashlib.sha256(order).hexdigest()[:10])

    return re.sub(r"(?<=[\"#])[a-z][0-9a-f]{10}(?=[\")])", settled, svg)


def png_bytes(canvas: Canvas) -> bytes:
    """Return a drawn figure as a PNG on white, without versions."""
    buffer = io.BytesIO()
    canvas.savefig(buffer, format="png", dpi=style.PNG_DPI, facecolor="white", metadata={"Software": None})
    return buffer.getvalue()
