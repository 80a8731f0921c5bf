"""How a stored figure drew its curves: the colours, dashes and widths of the paper's figure, from its record."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def look_of(panel: Mapping[str, Any], curve: str) -> dict[str, Any]:
    """Return the look of a curve as keywords of matplotlib's `plot`; empty if the record does not hold it.

    Parameters
    ----------
    panel
        Description of the axes, as in `replicate.figures.record`.

    Examples
    --------
    >>> mark = {"draws": "path", "edge": "#0072b2", "width": 2.0, "dash": [0.0, 3.6, 2.7]}
    >>> look_of({"parts": [{"name": "y", "marks": [mark]}]}, "y")
    {'color': '#0072b2', 'linewidth': 2.0, 'linestyle': (0.0, (3.6, 2.7))}
    >>> look_of({"parts": []}, "y")
    {}
    """
    marks = (mark for part in panel.get("parts", ()) if part["name"] == curve for mark in part["marks"])
    mark: Mapping[str, Any] = next(marks, {})
    edge, width, dash = (mark.get(name) for name in ("edge", "width", "dash"))
    if not isinstance(edge, str) or not isinstance(width, float | int):
        return {}  # no line, or many in one mark
    look: dict[str, Any] = {"color": edge, "linewidth": float(width), "linestyle": "-"}
    if isinstance(dash, list) and len(dash) > 2 and all(isinstance(length, float | int) for length in dash):
        look["linestyle"] = (float(dash[0]), tuple(float(length) for length in dash[1:]))
    return look
