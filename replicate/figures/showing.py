"""Whether anything can be seen of a part, as far as its record says."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from replicate.figures.colours import is_seen

Part = Mapping[str, Any]

_MARGIN = 0.02  # of the axes: boxes are rounded, and a text may be longer than its letters are counted


def shows(part: Part) -> bool:
    """Whether anything of a part can be seen: it has a colour, and is not clipped away.

    Examples
    --------
    >>> line = {"draws": "path", "edge": "#ff0000", "width": 1.0}
    >>> shows({"marks": [line], "box": [0.1, 0.1, 0.9, 0.9]}), shows({"marks": [line], "box": [2.0, 0.1, 3.0, 0.9]})
    (True, False)
    """
    marks = part["marks"]
    inked = bool(part.get("field")) or any(
        mark["draws"] == "image" or "hatch" in mark or any(map(is_seen, (mark.get("edge"), mark.get("face"))))
        for mark in marks
    )
    return inked and not (_is_clipped(part) and _is_outside(part.get("box")))


def hidden_names(axes: Mapping[str, Any]) -> set[str]:
    """Return the names of the parts of a panel of which its record says that nothing can be seen."""
    return {str(part["name"]) for part in axes.get("parts", ()) if not shows(part)}


def _is_clipped(part: Part) -> bool:
    """Whether nothing of a part is drawn outside the axes."""
    if any(mark["draws"] == "text" for mark in part["marks"]):
        return bool(part.get("properties", {}).get("clipping") == "to the axes")
    return all("clip" not in mark for mark in part["marks"])


def _is_outside(box: Any) -> bool:
    return box is not None and any(box[side] > 1.0 + _MARGIN or box[side + 2] < -_MARGIN for side in (0, 1))
