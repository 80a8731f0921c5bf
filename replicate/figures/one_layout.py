"""Lay a figure out once and draw it twice, as shapes and as pixels.

matplotlib lays a figure out anew for every file, because each kind measures texts in its own way: pixels with hinted
letters, shapes with outlines. Here texts are outlines in both, so that their sizes are the same and one layout serves.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.backend_bases import RendererBase
from matplotlib.backends.backend_agg import FigureCanvasAgg, RendererAgg
from matplotlib.backends.backend_mixed import MixedModeRenderer
from matplotlib.backends.backend_svg import RendererSVG
from matplotlib.figure import Figure
from PIL import Image

from replicate.figures.settled_ticks import settled_ticks
from replicate.figures.text_outlines import POINTS, Outlines

EFFORT = 3  # of 9, of the compression; the default, 6, takes half as much time again for a tenth less
OPAQUE = 255

_OUTLINES = Outlines()


class _Pixels(RendererAgg):
    """Draws pixels, texts as the outlines of their letters."""

    def __init__(self, width: float, height: float, dpi: float) -> None:
        super().__init__(width, height, dpi)  # type: ignore[no-untyped-call]
        self._text2path = _OUTLINES

    def draw_text(self, *arguments: Any, **options: Any) -> None:
        RendererBase.draw_text(self, *arguments, **options)

    def draw_tex(self, *arguments: Any, **options: Any) -> None:
        RendererBase.draw_tex(self, *arguments, **options)

    def get_text_width_height_descent(self, s: str, prop: Any, ismath: Any) -> tuple[float, float, float]:
        width, height, descent = _OUTLINES.get_text_width_height_descent(s, prop, ismath)
        scale = self.dpi / POINTS
        return width * scale, height * scale, descent * scale

    def _get_font_height_metrics(self, prop: Any) -> tuple[float | None, float | None, float | None]:
        return _OUTLINES.line_height(prop, self.dpi)


class _Shapes(RendererSVG):
    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)  # type: ignore[no-untyped-call]
        self._text2path = _OUTLINES

    def _get_font_height_metrics(self, prop: Any) -> tuple[float | None, float | None, float | None]:
        return _OUTLINES.line_height(prop, POINTS)


class _Canvas(FigureCanvasAgg):
    """Writes PNG and SVG."""

    _pixels: _Pixels | None = None

    def get_renderer(self) -> _Pixels:
        width, height = self.get_width_height(physical=True)
        here, dpi = self._pixels, self.figure.dpi
        if here is None or (here.width, here.height, here.dpi) != (width, height, dpi):
            self._pixels = here = _Pixels(width, height, dpi)
        return here

    def print_png(self, file: Any, **_: Any) -> None:  # type: ignore[override]
        """Write to an open file, without versions; as matplotlib's own, but that what is opaque has no opacities."""
        super().draw()  # type: ignore[no-untyped-call]
        drawn: Any = self.get_renderer()
        pixels = np.asarray(drawn.buffer_rgba())
        image = Image.fromarray(pixels)
        if (pixels[..., 3] == OPAQUE).all():
            image = image.convert("RGB")
        image.save(file, format="png", dpi=(self.figure.dpi, self.figure.dpi), compress_level=EFFORT)

    def print_svg(self, file: Any, *, metadata: Any = None, **_: Any) -> None:
        """Write to an open text file; as matplotlib's own, but for the renderer."""
        dpi, self.figure.dpi = self.figure.dpi, POINTS
        width, height = self.figure.get_size_inches()
        shapes = _Shapes(width * POINTS, height * POINTS, file, image_dpi=dpi, metadata=metadata)
        renderer: Any = MixedModeRenderer(self.figure, width, height, dpi, shapes)  # type: ignore[no-untyped-call]
        self.figure.draw(renderer)
        renderer.finalize()


@contextmanager
def laid_out(figure: Figure) -> Iterator[None]:
    """Place the parts of a figure; inside the ``with`` block, saving it as SVG or PNG only draws."""
    engine, canvas, dpi = figure.get_layout_engine(), figure.canvas, figure.dpi
    _OUTLINES.settle()
    _Canvas(figure)  # which makes itself the figure's
    try:
        # A file that has been saved leaves the figure with the layout engine of the settings: none, for this while.
        with (
            mpl.rc_context({"figure.autolayout": False, "figure.constrained_layout.use": False}),
            settled_ticks(figure),
        ):
            if engine is not None:
                figure.dpi = POINTS
                with suppress(ValueError):  # as `Figure.draw` does
                    engine.execute(figure)
                figure.dpi = dpi
                figure.set_layout_engine(None)
            yield
    finally:
        figure.dpi = dpi
        figure.set_canvas(canvas)
        if engine is not None:
            figure.set_layout_engine(engine)
