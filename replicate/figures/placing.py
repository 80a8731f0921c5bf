"""Where axes stand before a layout engine moves them by the size of their texts.

A figure that has been drawn once carries the places that its layout engine gave it, which depend on the fonts. Here
every axes goes back to the place that its grid gives it, and a colour bar to one side of the axes it belongs to.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from matplotlib.figure import SubplotParams
from matplotlib.transforms import Bbox

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Of a colour bar: its distance from the axes and its width, as fractions of theirs.
_PAD, _WIDTH = 0.05, 0.05
# Where matplotlib puts them.
_TITLES = {"_suptitle": ("y", 0.98), "_supxlabel": ("y", 0.01), "_supylabel": ("x", 0.02)}


@contextmanager
def without_layout(figure: Figure) -> Iterator[None]:
    """Put axes where their grids have them, for the length of a ``with`` block."""
    before = [(axes, axes.get_position(original=True), axes.get_position()) for axes in figure.axes]
    figures = [figure, *_below(figure)]
    kept = [part.subplotpars for part in figures]
    outlines = [(part, part.bbox_relative.frozen()) for part in figures[1:]]
    titles = [(text, text.get_position(), end) for part in figures for text, end in _titles(part)]
    try:
        for part in figures:
            part.subplotpars = SubplotParams()
        for part, _ in outlines:
            part._redo_transform_rel_fig()  # noqa: SLF001  -- back to what its grid says
        for text, _, (axis, end) in titles:
            getattr(text, f"set_{axis}")(end)
        for axes in figure.axes:
            spec = axes.get_subplotspec()
            parent: Any = axes.get_figure()
            if spec is not None:
                axes._set_position(spec.get_position(parent))  # type: ignore[attr-defined]  # noqa: SLF001
        for axes in figure.axes:
            place = _beside_its_axes(axes)
            if place is not None:
                axes._set_position(place)  # type: ignore[attr-defined]  # noqa: SLF001
        yield
    finally:
        for part, parameters in zip(figures, kept, strict=True):
            part.subplotpars = parameters
        for part, outline in outlines:
            part._redo_transform_rel_fig(outline)  # noqa: SLF001
        for text, position, _ in titles:
            text.set_position(position)
        for axes, original, active in before:
            axes._set_position(original, which="original")  # type: ignore[attr-defined]  # noqa: SLF001
            axes._set_position(active, which="active")  # type: ignore[attr-defined]  # noqa: SLF001


def _titles(figure: Any) -> Iterator[tuple[Any, tuple[str, float]]]:
    """Yield the title and the labels of a figure, as far as nobody said where they are, and where they begin."""
    for name, place in _TITLES.items():
        text = getattr(figure, name, None)
        if text is not None and getattr(text, "_autopos", False):
            yield text, place


def _below(figure: Any) -> list[Any]:
    found = list(getattr(figure, "subfigs", ()))
    return [part for child in found for part in (child, *_below(child))]


def _beside_its_axes(axes: Any) -> Bbox | None:
    """Return where a colour bar stands that the layout engine would place; ``None`` for other axes."""
    about = getattr(axes, "_colorbar_info", None)
    if about is None or axes.get_subplotspec() is not None:
        return None
    box = Bbox.union([parent.get_position(original=True) for parent in about["parents"]])
    shrink = about.get("shrink", 1.0)
    if about["location"] in {"left", "right"}:
        left = box.x1 + _PAD * box.width if about["location"] == "right" else box.x0 - (_PAD + _WIDTH) * box.width
        return Bbox.from_bounds(
            left, box.y0 + (1.0 - shrink) / 2.0 * box.height, _WIDTH * box.width, shrink * box.height
        )
    low = box.y1 + _PAD * box.height if about["location"] == "top" else box.y0 - (_PAD + _WIDTH) * box.height
    return Bbox.from_bounds(box.x0 + (1.0 - shrink) / 2.0 * box.width, low, shrink * box.width, _WIDTH * box.height)
