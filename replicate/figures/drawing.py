"""Draw a figure on the recording renderer, and leave it as it was found."""

from __future__ import annotations

import functools
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING, Any

from matplotlib.text import Annotation, Text

from replicate.figures.attributes import attributes
from replicate.figures.placing import without_layout
from replicate.figures.recorder import DPI, Drawn, RecordingRenderer
from replicate.figures.settled_ticks import settled_ticks

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@contextmanager
def recorded(figure: Figure) -> Iterator[list[Drawn]]:
    """Yield everything that is drawn, in order; inside the block the axes are where they were drawn.

    The layout engine is switched off, because it places axes by the size of their texts, and so is the figure's own
    resolution. A first pass settles what artists decide while they draw.
    """
    width, height = figure.get_size_inches()
    renderer = RecordingRenderer(width * DPI, height * DPI)
    with _on_canvas(figure, renderer), renderer.drawing(figure), settled_ticks(figure):
        figure.draw(renderer)
        renderer.recording = True
        with _attributed(figure, renderer):
            figure.draw(renderer)
        yield renderer.drawn


@contextmanager
def _on_canvas(figure: Figure, renderer: RecordingRenderer) -> Iterator[None]:
    engine, dpi, canvas = figure.get_layout_engine(), figure.dpi, figure.canvas
    with ExitStack() as stack:
        if engine is not None:
            stack.callback(figure.set_layout_engine, engine)
            figure.set_layout_engine("none")
            if type(engine).__name__ != "PlaceHolderLayoutEngine":
                stack.enter_context(without_layout(figure))
        stack.callback(figure._set_dpi, dpi, forward=False)  # type: ignore[attr-defined]  # noqa: SLF001
        figure._set_dpi(DPI, forward=False)  # type: ignore[attr-defined]  # noqa: SLF001  -- no window changes its size
        # Artists may ask the canvas for a renderer, and animations begin unless a file is being saved.
        stack.enter_context(attributes([(canvas, "get_renderer", lambda: renderer), (canvas, "_is_saving", True)]))
        yield
        for artist in everything(figure):
            if isinstance(artist, Text) and getattr(artist, "_renderer", None) is renderer:
                artist._renderer = None  # type: ignore[attr-defined]  # noqa: SLF001  -- the next one asks anew


@contextmanager
def _attributed(figure: Figure, renderer: RecordingRenderer) -> Iterator[None]:
    """Let every artist of a figure tell the renderer when it draws."""
    telling = [(one, "draw", _telling(one, renderer)) for one in everything(figure) if one is not figure]
    with attributes(telling):
        yield


def _telling(artist: Artist, renderer: RecordingRenderer) -> Any:
    original = artist.draw

    @functools.wraps(original)
    def draw(*arguments: Any, **options: Any) -> Any:
        with renderer.drawing(artist):
            return original(*arguments, **options)

    return draw


def everything(figure: Figure) -> list[Artist]:
    """Return a figure and all artists in it, each once, also the boxes and arrows that belong to texts."""
    found: dict[int, Artist] = {}
    waiting: list[Artist] = [figure]
    while waiting:
        artist = waiting.pop()
        if id(artist) in found:
            continue
        found[id(artist)] = artist
        children = [*artist.get_children(), *parasites(artist)]
        if isinstance(artist, Text):
            children += [part for part in (artist.get_bbox_patch(), _arrow(artist)) if part is not None]
        waiting += children
    return list(found.values())


def parasites(artist: Artist) -> Sequence[Axes]:
    """Return the axes of `mpl_toolkits` that live on others, which draw their artists for them."""
    return getattr(artist, "parasites", ())


def _arrow(text: Text) -> Any:
    return text.arrow_patch if isinstance(text, Annotation) else None
