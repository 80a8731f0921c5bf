"""What becomes of a drawn matplotlib figure: an SVG, a PNG, and its curves as a frame."""

from __future__ import annotations

import hashlib
import html
import io
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal

import numpy as np
import pandas as pd

from replicate.figures import style
from replicate.figures.one_layout import laid_out
from replicate.figures.record import Record

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Canvas

Kind = Literal["svg", "png"]

_HREF = re.compile(r"""\s(?:xlink:)?href\s*=\s*(?:"([^"]*)"|'([^']*)')""")
_ADDRESS = re.compile(r"#|https?://|mailto:|data:image/(png|jpeg);base64,", re.IGNORECASE)


def curves_frame(record: Record) -> pd.DataFrame:
    """Return the curves of a figure as a frame with the columns ``panel, curve, x, y``."""
    names = [name for name, points in record.curves.items() for _ in points]
    x, y = np.vstack([np.empty((0, 2)), *record.curves.values()]).T
    panel, curve = ([name[part] for name in names] for part in (0, 1))
    return pd.DataFrame({"panel": panel, "curve": curve, "x": x, "y": y}).astype({"panel": object, "curve": object})


def svg_text(canvas: Canvas, title: str) -> str:
    """Return a drawn figure as a transparent SVG without date and versions."""
    with laid_out(canvas):
        return _svg(canvas, title)


def pictures(canvas: Canvas, title: str, kinds: Sequence[Kind]) -> tuple[bytes, ...]:
    """Return a drawn figure as an SVG like `svg_text`'s, a PNG on white, or both for little more than one of them."""
    with laid_out(canvas):
        return tuple(_svg(canvas, title).encode() if kind == "svg" else _png(canvas) for kind in kinds)


def _svg(canvas: Canvas, title: str) -> str:
    buffer = io.StringIO()
    unknown = dict.fromkeys(("Date", "Creator", "Format", "Type"))
    canvas.savefig(buffer, format="svg", transparent=True, metadata={**unknown, "Title": title})
    svg = _safe(_settled_ids(buffer.getvalue())).replace("#000000", style.INK)
    # matplotlib writes no fill for black shapes and texts: let them inherit the ink colour.
    return svg.replace("<g ", f'<g fill="{style.INK}" ', 1)


def _png(canvas: Canvas) -> bytes:
    buffer = io.BytesIO()
    canvas.savefig(buffer, format="png", dpi=style.PNG_DPI, facecolor="white")
    return buffer.getvalue()


def _safe(svg: str) -> str:
    """Drop links that a page must not carry; matplotlib writes whatever `Artist.set_url` was given.

    What stays: places in the drawing itself, web pages and mail addresses, and the pixels of an image.

    Examples
    --------
    >>> _safe('<a xlink:href="javascript:x()"><use xlink:href="#m1"/></a>')
    '<a><use xlink:href="#m1"/></a>'
    """

    def kept(match: re.Match[str]) -> str:
        address = html.unescape(match[1] if match[1] is not None else match[2]).strip()
        return match[0] if _ADDRESS.match(address) else ""

    return _HREF.sub(kept, svg)


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
