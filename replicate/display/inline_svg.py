"""A drawn figure as inline SVG: responsive, accessible, and in the colours of its page."""

from __future__ import annotations

import html
import re
from collections.abc import Mapping, Sequence
from typing import Any

from replicate.figures.style import themed

_SVG_TAG = re.compile(r"<svg\b[^>]*>", re.DOTALL)
_VIEW_BOX = re.compile(r'viewBox="([^"]+)"')
# What an SVG file says about itself; in a page, the element's own title and description do.
_FOR_FILES = re.compile(r"<(metadata|title)\b.*?</\1>\s*", re.DOTALL)
# Nothing refers to groups by their ids, and every figure has the same ones.
_GROUP_ID = re.compile(r'<g id="[^"]*"')
_REFERENCE = re.compile(r'\bid="|href="#|url\(#')


def inline_svg(svg: str, id: str, title: str, description: str) -> str:
    """Return an SVG document as an element that can stand in a page.

    Parameters
    ----------
    svg
        The document as `replicate.figures.off_screen` leaves it.
    id
        Id of the element, unique on the page; all ids inside begin with it.
    title, description
        Plain text for `<title>` and `<desc>`, which say what the image shows to those who cannot see it.

    Returns
    -------
    str
        One `<svg role="img">` element in the page's colours; its width follows its container.

    Raises
    ------
    ValueError
        If the document has no `<svg>` element or no view box.
    """
    tag = _SVG_TAG.search(svg)
    view_box = _VIEW_BOX.search(tag[0]) if tag else None
    if tag is None or view_box is None:
        msg = f"{id}: the drawing is not an SVG document with a view box"
        raise ValueError(msg)
    body = svg[tag.end() : svg.rindex("</svg>")]
    body = _FOR_FILES.sub("", body)
    body = _GROUP_ID.sub("<g", body)
    body = _REFERENCE.sub(rf"\g<0>{id}-", body)
    # matplotlib's style sheet addresses every element; inside a page that would be every element of the page.
    body = body.replace('<style type="text/css">*{', f'<style type="text/css">#{id} *{{')
    width, height = (float(size) for size in view_box[1].split()[2:])
    return (
        f'<svg id="{id}" role="img" aria-labelledby="{id}-title {id}-desc" viewBox="{view_box[1]}" '
        f'fill="currentColor" style="aspect-ratio: {width:g} / {height:g}; --width: {width:g}">'
        f'<title id="{id}-title">{html.escape(title)}</title>'
        f'<desc id="{id}-desc">{html.escape(description)}</desc>{themed(body.strip())}</svg>'
    )


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
