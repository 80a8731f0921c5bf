"""A drawing carries no link that runs anything, whatever was set on its artists."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import pytest
from matplotlib.figure import Figure

from replicate.figures.off_screen import svg_text

HREF = "{http://www.w3.org/1999/xlink}href"


def links(url: str) -> list[str]:
    canvas = Figure(figsize=(2.0, 2.0))
    axes = canvas.subplots()
    (line,) = axes.plot([0.0, 1.0], [0.0, 1.0], gid='a"><script>x()</script>')
    line.set_url(url)
    axes.set_title("<script>x()</script>", url=url)
    axes.scatter([0.0, 1.0], [0.0, 1.0], urls=[url, url])
    root = ET.fromstring(svg_text(canvas, "</title><script>x()</script>"))  # noqa: S314  -- written by us
    assert not [element for element in root.iter() if element.tag.endswith("}script")]
    found = [value for element in root.iter() for name, value in element.attrib.items() if name in (HREF, "href")]
    return [value for value in found if not value.startswith("#")]


@pytest.mark.parametrize(
    "url",
    [
        *("javascript:x()", " JavaScript:x()", "java\nscript:x()", "vbscript:x"),
        *("data:text/html,<script>x()</script>", "file:///etc/passwd", "../x.html"),
    ],
)
def test_links_that_run_something_are_dropped(url: str) -> None:
    assert links(url) == []


@pytest.mark.parametrize("url", ["https://example.org/a?b=1&c=2", "http://example.org", "mailto:a@example.org"])
def test_links_to_pages_stay(url: str) -> None:
    assert set(links(url)) == {url}


def test_pixels_stay() -> None:
    canvas = Figure(figsize=(2.0, 2.0))
    canvas.subplots().imshow([[0.0, 1.0], [1.0, 0.0]])
    assert 'href="data:image/png;base64,' in svg_text(canvas, "")
