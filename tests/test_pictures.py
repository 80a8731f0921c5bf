"""What is remembered while a figure is drawn changes nothing in its picture, and saves what it is there to save."""

from __future__ import annotations

import io
from contextlib import nullcontext
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.textpath import TextToPath
from matplotlib.ticker import MaxNLocator, ScalarFormatter
from PIL import Image

from replicate.figures import capture, drawing, one_layout
from replicate.figures.off_screen import pictures
from replicate.figures.style import PNG_DPI
from replicate.figures.text_outlines import Outlines


class _Widening(Artist):
    """Changes the limits of its axes while it is drawn, and what a locator looks for."""

    def draw(self, renderer: Any) -> None:
        axes: Any = self.axes
        axes.set_xlim(0.0, axes.get_xlim()[1] + 7.0)
        super().draw(renderer)


def _eventful() -> Figure:
    """Return a figure whose ticks depend on what another axis has done, or change while they are drawn."""
    figure = Figure(figsize=(7.0, 6.0), layout="constrained")
    (first, second), (third, fourth) = figure.subplots(2, 2)
    shared = ScalarFormatter()
    for axes, height in ((first, 3e-9), (second, 4e7)):
        axes.plot([0.0, 1.0], [0.0, height])
        axes.yaxis.set_major_formatter(shared)  # keeps the offset of the axis that used it last
        axes.set_title("title")
    third.plot([-1.0, 2.0], [-3.0, 5.0])
    third.spines.bottom.set_position(("data", 0.0))
    third.twinx().semilogy([-1.0, 2.0], [1.0, 1e5])
    third.minorticks_on()
    fourth.plot([0.0, 10.0], [1.0, 2.0])
    fourth.add_artist(_Widening())
    fourth.set_aspect(3.0)
    figure.align_labels()
    return figure


def test_a_picture_with_settled_ticks_is_the_picture_of_matplotlib(monkeypatch: pytest.MonkeyPatch) -> None:
    with mpl.rc_context({"svg.hashsalt": "salt"}):
        drawn, record = pictures(_eventful(), "title", ("svg", "png")), capture(_eventful()).to_json()
        for module in (one_layout, drawing):
            monkeypatch.setattr(module, "settled_ticks", lambda _: nullcontext())
        assert drawn == pictures(_eventful(), "title", ("svg", "png"))
        assert record == capture(_eventful()).to_json()


def test_ticks_are_looked_for_once_as_long_as_the_axes_stay_where_they_are() -> None:
    asked = []
    figure = Figure()
    axes = figure.subplots()

    class Counting(MaxNLocator):
        def __call__(self) -> Any:
            asked.append(tuple(axes.bbox.extents))
            return super().__call__()

    axes.plot([0.0, 1.0], [0.0, 1.0])
    axes.xaxis.set_major_locator(Counting())
    axes.set_title("title")
    pictures(figure, "title", ("svg", "png"))
    assert len(asked) == len(set(asked))
    assert axes.xaxis.__dict__.get("_update_ticks") is None


@pytest.mark.parametrize("text", ["0.25", "Überschwingen", r"$\tau/\omega_0^2$", ""])
@pytest.mark.parametrize("size", [7.0, 12.0])
def test_outlines_are_those_of_matplotlib(text: str, size: float) -> None:
    ours, font, math = Outlines(), FontProperties(family=["STIXGeneral", "DejaVu Sans"], size=size), "$" in text
    for _ in range(2):
        ours.settle()
        vertices, codes = ours.get_text_path(font, text, math)
        expected, kinds = TextToPath().get_text_path(font, text, math)
        np.testing.assert_array_equal(np.reshape(vertices, (-1, 2)), np.reshape(expected, (-1, 2)))
        np.testing.assert_array_equal(codes, kinds)
        size_of = (font, math)
        assert ours.get_text_width_height_descent(text, *size_of) == TextToPath().get_text_width_height_descent(
            text, *size_of
        )


@pytest.mark.parametrize(("alpha", "mode"), [(1.0, "RGB"), (0.5, "RGBA")])
def test_a_png_has_opacities_only_where_there_are_some(alpha: float, mode: str) -> None:
    figure = _eventful()
    figure.patch.set_alpha(alpha)
    (content,) = pictures(figure, "title", ("png",))
    with Image.open(io.BytesIO(content)) as drawn:
        assert drawn.mode == mode
        assert drawn.info.keys() == {"dpi"}
        assert drawn.info["dpi"] == pytest.approx((PNG_DPI, PNG_DPI), rel=1e-4)
        grey = np.asarray(drawn.convert("L"))
    assert grey.min() < 50  # something is drawn
    assert np.median(grey) == 255  # on white
