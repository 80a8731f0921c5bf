"""Mark the curves of a drawing, so that a page can read values off them and switch them on and off.

matplotlib names its groups by kind (``axes_1``, ``line2d_7``, ``legend_1``) and writes the text of a legend as a
comment beside its outlines. That is enough to tell which line is which curve: a line belongs to the legend entry that
is drawn in the same style, and of several in one style, to the one in its place. A name beside its curve says whose it
is by its id (`replicate.figures.curve_labels`).
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import Any
from xml.etree import ElementTree as ET

_NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
_SCALES = {"linear", "log"}
_LINE = re.compile(r"line2d_|curve-\d+$")
_NAME = re.compile(r"(curve-\d+)-name")

_Look = tuple[str, ...]


def mark_curves(root: ET.Element, panels: Sequence[Mapping[str, Any]]) -> None:
    """Add ``data-`` attributes to a drawing.

    Parameters
    ----------
    root
        The drawing, with the ids that matplotlib gives; it is changed.
    panels
        Descriptions of its axes, in the order of the drawing. Nothing is marked if they are not as many.

    Notes
    -----
    Axes get ``data-box`` (left, top, right and bottom edge in the drawing's units) and ``data-x``, ``data-y`` (limits
    and scale); a curve gets ``data-curve`` with its name, which is empty if no legend has it or nobody can tell; the
    parts of a legend entry get ``data-legend``. A legend beside the axes speaks for all that have none of their own.
    """
    groups = [element for element in root.iter() if _id(element).startswith("axes_")]
    if len(groups) != len(panels):
        return
    beside = [entry for group in root.iter() if groups and groups[0] in list(group) for entry in _legend(group)]
    for group, panel in zip(groups, panels, strict=True):
        box = _box(group)
        if box is None or "polar" in panel or not {panel.get("xscale"), panel.get("yscale")} <= _SCALES:
            continue
        lines = [(line, path) for line in group if (path := _line(line)) is not None]
        names = _names([_look(path) for _, path in lines], list(_legend(group)) or beside)
        own = dict(_written(group))
        for (line, _), name in zip(lines, names, strict=True):
            line.set("data-curve", own.get(_id(line), name))
        if lines:
            group.set("data-box", " ".join(f"{edge:g}" for edge in box))
            for axis in "xy":
                low, high = panel[f"{axis}lim"]
                group.set(f"data-{axis}", f"{low:.9g} {high:.9g} {panel[f'{axis}scale']}")


def _id(element: ET.Element) -> str:
    return element.get("id") or ""


def _line(group: ET.Element) -> ET.Element | None:
    """Return the path of a line without markers."""
    paths = list(group)
    if not _LINE.match(_id(group)) or len(paths) != 1 or tag(paths[0]) != "path":
        return None
    return paths[0] if "stroke:" in paths[0].get("style", "") else None


def tag(element: ET.Element) -> str:
    """Return the name of an element without its namespace; empty for a comment, whose "tag" is a function."""
    name: object = element.tag
    return name.rpartition("}")[2] if isinstance(name, str) else ""


def _look(path: ET.Element) -> _Look:
    """Return what tells curves apart: colour, dashes and width."""
    parts = dict(part.strip().partition(":")[::2] for part in path.get("style", "").split(";"))
    return tuple(
        parts.get(name, "").strip() for name in ("stroke", "stroke-dasharray", "stroke-width", "stroke-opacity")
    )


def _names(looks: Sequence[_Look], entries: Sequence[tuple[_Look, str]]) -> list[str]:
    """Return the names of lines.

    Examples
    --------
    >>> _names([("red",), ("blue",), ("red",), ("grey",)], [(("red",), "a"), (("blue",), "b"), (("red",), "c")])
    ['a', 'b', 'c', '']
    """
    by_look: dict[_Look, list[str]] = {}
    for look, name in entries:
        by_look.setdefault(look, []).append(name)
    counts = Counter(looks)
    # One name for all lines of a look, or one for each; of any other number nobody can tell which is whose.
    left = {
        look: iter(names * counts[look] if len(names) == 1 else names)
        for look, names in by_look.items()
        if len(names) in {1, counts[look]}
    }
    return [next(left[look]) if look in left else "" for look in looks]


def _box(axes: ET.Element) -> tuple[float, float, float, float] | None:
    patch = next((path for group in axes if _id(group).startswith("patch_") for path in group), None)
    numbers = [float(number) for number in _NUMBER.findall(patch.get("d", ""))] if patch is not None else []
    if len(numbers) < 8:
        return None
    return min(numbers[::2]), min(numbers[1::2]), max(numbers[::2]), max(numbers[1::2])


def _legend(parent: ET.Element) -> Iterator[tuple[_Look, str]]:
    """Yield looks and names of the entries of legends in a group: a handle stands before its text."""
    for legend in (group for group in parent if _id(group).startswith("legend_")):
        handle: ET.Element | None = None
        for part in legend:
            text = _said(part)
            if _line(part) is not None:
                handle = part
            elif text and handle is not None:
                path = _line(handle)
                assert path is not None  # noqa: S101  -- it was when it became the handle
                for piece in (handle, part):
                    piece.set("data-legend", text)
                yield _look(path), text
                handle = None


def _written(axes: ET.Element) -> Iterator[tuple[str, str]]:
    """Yield ids and names of the curves whose names stand beside them."""
    for part in axes:
        if found := _NAME.fullmatch(_id(part)):
            part.set("data-legend", _said(part))
            yield found[1], _said(part)


def _said(part: ET.Element) -> str:
    """Return the text of a group, which matplotlib writes as a comment beside its outlines."""
    return next((str(child.text).strip() for child in part if not tag(child)), "")
