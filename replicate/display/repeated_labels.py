"""Labels that a drawing writes several times: outlined once, shown again by a reference.

Half the elements of a figure with many panels are the letters of its ticks, and most ticks read "0", "1" or "0.5".
"""

from __future__ import annotations

import re
from xml.etree import ElementTree as ET

from replicate.display.live_curves import tag

#: Attribute of an element that `share_labels` refers to: the id it needs.
SHARED = "shared"

_SVG = "{http://www.w3.org/2000/svg}"
_XLINK = "{http://www.w3.org/1999/xlink}href"
_PLACE = re.compile(r"translate\((-?[\d.]+) (-?[\d.]+)\) (.*)")

_Key = tuple[str, ...]


def share_labels(root: ET.Element) -> None:
    """Replace every label that has been written before by a reference to the first of its kind.

    Parameters
    ----------
    root
        The drawing as matplotlib writes it, each label a group of letters behind ``translate(x y)``; it is changed.

    Examples
    --------
    >>> label = '<g transform="translate({}) scale(0.1 -0.1)"><use xlink:href="#one"/><use xlink:href="#zero"/></g>'
    >>> names = 'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"'
    >>> root = ET.fromstring(f"<svg {names}>{label.format('10 20')}{label.format('35 20')}</svg>")
    >>> share_labels(root)
    >>> len(root[0]), root[0].get("shared"), root[1].attrib
    (2, 'label-1', {'{http://www.w3.org/1999/xlink}href': '#label-1', 'x': '25', 'y': '0'})
    """
    first: dict[_Key, tuple[ET.Element, float, float]] = {}
    for element in root.iter(f"{_SVG}g"):
        found = _PLACE.fullmatch(element.get("transform", ""))
        letters = [child for child in element if tag(child) not in {"", "defs"}]
        if found is None or not letters or any(tag(child) != "use" for child in letters):
            continue
        x, y = float(found[1]), float(found[2])
        own = [f"{name}={value}" for name, value in element.items() if name != "transform"]
        shown = [f"{child.get(_XLINK)} {child.get('transform')} {child.get('x')} {child.get('y')}" for child in letters]
        label, left, top = first.setdefault((found[3], *own, *shown), (element, x, y))
        if label is element or len(letters) < len(list(element)):  # this one also defines letters
            continue
        name = label.get(SHARED) or f"label-{sum(1 for one, _, _ in first.values() if one.get(SHARED)) + 1}"
        label.set(SHARED, name)
        element.clear()
        element.tag = f"{_SVG}use"
        element.attrib |= {_XLINK: f"#{name}", "x": f"{x - left:.6g}", "y": f"{y - top:.6g}"}
