"""A drawn figure as inline SVG: responsive, accessible, small, and in the colours of its page."""

from __future__ import annotations

import html
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any
from xml.etree import ElementTree as ET

from replicate.display.live_curves import mark_curves, tag
from replicate.display.numbers import minus_signs
from replicate.display.repeated_labels import SHARED, share_labels
from replicate.display.unmarked import unmarked
from replicate.figures.style import themed

# What an SVG file says about itself; in a page, the element's own title and description do.
_FOR_FILES = {"metadata", "title"}
_REFERENCE = re.compile(r"url\(#")
_COORDINATE = re.compile(r"-?\d+\.\d{3,}")
_SPACE = re.compile(r"\s+")
# matplotlib draws letters of a hundred units and scales them to their size, upside down.
_LETTERS = re.compile(r"scale\((\d*\.\d+) -\1\)")
_XLINK = "{http://www.w3.org/1999/xlink}href"


def inline_svg(svg: str, id: str, title: str, description: str, axes: Sequence[Mapping[str, Any]] = ()) -> str:
    """Return an SVG document as an element that can stand in a page.

    Parameters
    ----------
    svg
        The document as `replicate.figures.off_screen` leaves it.
    id
        Id of the element, unique on the page; all ids inside begin with it.
    title, description
        Texts for `<title>` and `<desc>`, which say what the image shows to those who cannot see it; their markup is
        left out.
    axes
        What its axes hold; with it the curves are marked, so that a script can read values off them.

    Returns
    -------
    str
        One `<svg role="img">` element in the page's colours; its width follows its container, and with `--width` and
        `--type`, the size of its smallest letters, a page can say how far. Coordinates are rounded to a hundredth of
        a point.

    Raises
    ------
    ValueError
        If the document has no `<svg>` element or no view box.
    """
    try:
        root = ET.fromstring(svg, parser=ET.XMLParser(target=ET.TreeBuilder(insert_comments=True)))  # noqa: S314 -- drawn here
    except ET.ParseError as error:
        msg = f"{id}: the drawing is not an SVG document: {error}"
        raise ValueError(msg) from error
    view_box = root.get("viewBox")
    if tag(root) != "svg" or view_box is None:
        msg = f"{id}: the drawing is not an SVG document with a view box"
        raise ValueError(msg)
    mark_curves(root, axes)
    share_labels(root)
    body = "".join(text for child in root for text in _written(child, id))
    width, height = (float(size) for size in view_box.split()[2:])
    sizes = [100.0 * float(scale) for scale in _LETTERS.findall(body)]
    smallest = f"; --type: {min(sizes):g}" if sizes else ""
    return (
        f'<svg id="{id}" role="img" aria-labelledby="{id}-title {id}-desc" viewBox="{view_box}" '
        f'fill="currentColor" style="aspect-ratio: {width:g} / {height:g}; --width: {width:g}{smallest}">'
        f'<title id="{id}-title">{_said(title)}</title>'
        f'<desc id="{id}-desc">{_said(description)}</desc>{themed(body)}</svg>'
    )


def _said(text: str) -> str:
    return html.escape(minus_signs(unmarked(text)))


def _name(tag: str) -> str:
    return tag.rpartition("}")[2]


def _written(element: ET.Element, id: str) -> Iterator[str]:
    """Write an element and what is in it: without comments, without groups that change nothing."""
    name = tag(element)
    if not name or name in _FOR_FILES:
        return
    attributes = dict(_attributes(element, name, id))
    content = "".join(text for child in element for text in _written(child, id))
    text = html.escape(element.text or "", quote=False)
    if name == "style":
        # matplotlib's style sheet addresses every element; inside a page that would be every element of the page.
        text = text.replace("*{", f"#{id} *{{", 1)
    elif name not in {"text", "tspan"}:
        text = text.strip()
    if name == "g" and not attributes:
        yield content
        return
    if name in {"g", "defs"} and not content:
        return
    opening = "".join([name, *(f' {key}="{html.escape(value)}"' for key, value in attributes.items())])
    yield f"<{opening}>{text}{content}</{name}>" if text or content else f"<{opening}/>"


def _attributes(element: ET.Element, name: str, id: str) -> Iterator[tuple[str, str]]:
    for key, value in element.items():
        if key == SHARED:
            yield "id", f"{id}-{value}"
        elif key == "id":
            if name != "g":  # nothing refers to groups by their ids, and every figure has the same ones
                yield key, f"{id}-{value}"
        elif key == _XLINK:
            yield "xlink:href", f"#{id}-{value[1:]}" if value.startswith("#") else value
        elif key in {"d", "x", "y"}:
            yield key, _SPACE.sub(" ", _COORDINATE.sub(_rounded, value)).strip()
        else:
            yield _name(key), _REFERENCE.sub(f"url(#{id}-", value)


def _rounded(match: re.Match[str]) -> str:
    text = f"{float(match[0]):.2f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def description(alt: str, axes: Sequence[Mapping[str, Any]]) -> str:
    """Return the figure's alternative text; one without is described by what its axes hold.

    Examples
    --------
    >>> axes = {"title": "", "xlabel": "t", "ylabel": "y", "xlim": [0, 9], "ylim": [0, 1]}
    >>> description("", [axes | {"legend": ["PA", "ZN"]}])
    'y from 0 to 1 over t from 0 to 9: PA, ZN.'
    """
    if alt:
        return alt
    sentences = []
    for panel in axes:
        named = [f"{panel[f'{axis}label'] or axis} from {_range(panel[f'{axis}lim'])}" for axis in "yx"]
        name = f"{panel['title']}: " if panel["title"] else ""
        curves = f": {', '.join(panel['legend'])}" if panel["legend"] else ""
        sentences.append(f"{name}{' over '.join(named)}{curves}.")
    return " ".join(sentences)


def _range(limits: list[float]) -> str:
    return f"{limits[0]:g} to {limits[1]:g}"
