"""Settings that change a picture, but nothing that a renderer is asked to draw: said only where they are uncommon."""

from __future__ import annotations

import zlib
from collections.abc import Iterable
from typing import Any

import numpy as np
from matplotlib.image import AxesImage
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from matplotlib.offsetbox import TextArea
from matplotlib.text import Annotation, Text

from replicate.figures.legend_words import HANDLES, LEGEND_SIZES, OUTSIDE
from replicate.figures.style_numbers import style_numbers

#: matplotlib's own, so that records hold only what differs from them.
_LINE_SPACINGS = (1.2, "normal")  # until 3.10, and since
_LABEL_SPACING = 0.5
_FRAME = "Round"
_NO_MARKERS = {"None", "none", " ", ""}
_LONGEST = 40


def uncommon(artist: Any) -> dict[str, Any]:
    """Return such settings of a line, a text, a legend or an image by their names; most artists have none."""
    match artist:
        case Text():
            return _of_text(artist)
        case Legend():
            return _of_legend(artist)
        case AxesImage():
            return _of_image(artist)
        case Line2D() if _has_markers(artist):
            every = artist.get_markevery()
            return {"choice of markers": "all" if every is None else _shortened(str(every))}
    return {}


def path_effects(artists: Iterable[Any]) -> dict[str, Any]:
    """Return the path effects of artists that are one part, such as the labels of an axis, each once."""
    effects = [effect for artist in artists for effect in getattr(artist, "get_path_effects", list)() or ()]
    said = dict.fromkeys(f"{type(effect).__name__} {style_numbers(effect)}".strip() for effect in effects)
    return {"effects": list(said)} if said else {}


def _has_markers(line: Line2D) -> bool:
    marker: object = line.get_marker()  # a text, or points or a path without a hash
    return not (marker is None or (isinstance(marker, str) and marker in _NO_MARKERS))


def _shortened(text: str) -> str:
    words = " ".join(text.split())
    return words if len(words) <= _LONGEST else f"{words[:_LONGEST]}… ({zlib.crc32(words.encode()):08x})"


def _of_text(text: Text) -> dict[str, Any]:
    found: dict[str, Any] = {}
    words = text.get_text()
    if "\n" in words:  # how the lines of one text stand to each other
        lines = getattr(text, "_multialignment", None)
        spacing = getattr(text, "_linespacing", "normal")
        found |= {"alignment of the lines": str(lines)} if lines else {}
        found |= {"line spacing": round(float(spacing), 3)} if spacing not in _LINE_SPACINGS else {}
    if text.get_wrap():
        found["line breaks"] = "where there is no room"
    if words.count("$") > 1 and not text.get_parse_math():
        found["mathematics"] = "as it is written"
    if text.get_usetex():
        found["typesetting"] = "TeX"
    if isinstance(text, Annotation) and text.arrow_patch is None and str(text.anncoords).startswith("offset"):
        found["offset"] = [round(float(part), 2) for part in text.xyann]  # in points; an arrow tells it otherwise
    if text.get_rotation() % 360.0:
        found["turning"] = "about its anchor" if text.get_rotation_mode() == "anchor" else "about its box"
    return found


def _of_legend(legend: Legend) -> dict[str, Any]:
    found: dict[str, Any] = {words: round(float(getattr(legend, name)), 3) for name, words in LEGEND_SIZES.items()}
    found[HANDLES] = _side_of_handles(legend)
    if getattr(legend, "axes", None) is None:  # a legend of a figure
        found[OUTSIDE] = str(getattr(legend, "_outside_loc", None) or "none")
    if getattr(legend, "_mode", None) == "expand":
        found["mode"] = "expanded"
    if abs(legend.labelspacing - _LABEL_SPACING) > 1e-9:
        found["spacing"] = round(float(legend.labelspacing), 3)
    if legend.get_alignment() != "center":
        found["alignment"] = str(legend.get_alignment())
    if not legend.get_frame_on():
        return found | {"frame": "none"}
    frame = type(legend.get_frame().get_boxstyle()).__name__  # type: ignore[attr-defined]
    return found | ({"frame": frame} if frame != _FRAME else {})


def _side_of_handles(legend: Legend) -> str:
    """Return whether the handles stand before or behind their words."""
    columns: Any = getattr(getattr(legend, "_legend_handle_box", None), "get_children", list)()
    entries = columns[0].get_children() if columns else []
    parts = entries[0].get_children() if entries else []
    return "behind their words" if parts and isinstance(parts[0], TextArea) else "before their words"


def _of_image(image: AxesImage) -> dict[str, Any]:
    axes: Any = image.axes
    if axes is None or image.get_transform() == axes.transData:
        return {}
    in_data = image.get_transform().contains_branch(axes.transData)
    moved = image.get_transform() - (axes.transData if in_data else axes.transAxes)
    found: dict[str, Any] = {} if in_data else {"coordinates": "fractions of the axes"}
    if not moved.is_affine:
        return found | {"transform": type(image.get_transform()).__name__}
    matrix = np.asarray(moved.get_matrix(), dtype=float)[:2]
    same = np.allclose(matrix, np.eye(3)[:2])
    return found if same else found | {"transform": [float(f"{part:.4g}") for part in matrix.ravel()]}
