"""Drawings of any size: drawn within a minute, or refused with what is allowed."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
import pytest
from matplotlib.figure import Figure as Canvas
from matplotlib.image import FigureImage

from replicate.errors import FigureError
from replicate.exhibits import Figure
from replicate.exhibits.results import FigureResult
from replicate.figures.limits import CROWD, MOST_ARTISTS, MOST_POINTS
from replicate.run.drawing import capture

MILLION = 10**6
_RANDOM = np.random.default_rng(1)
X, Y = _RANDOM.normal(size=(2, MILLION))

Draw = Callable[[Canvas], object]


def drawn(draw: Draw, size: tuple[float, float] = (6.4, 4.0)) -> FigureResult:
    def on(canvas: Canvas) -> None:
        draw(canvas)

    return capture("lab", Figure("fig-1", "figure", "Large", on, size=size))


REFUSED: dict[str, tuple[Draw, str]] = {
    "inches": (lambda figure: figure.set_size_inches(1000, 1000), r"is 1000 x 1000 inches; allowed: 100 inches each"),
    "area": (lambda figure: figure.set_size_inches(99, 99), "2000 square inches"),
    "nothing": (lambda figure: figure.set_size_inches(0, 4), "is 0 x 4 inches"),
    "lines": (
        lambda figure: figure.subplots().plot(np.zeros((2, MOST_ARTISTS + 1))),
        r"draws 10,0\d\d artists; allowed: 10,000",
    ),
    "points": (
        lambda figure: figure.subplots().plot(np.broadcast_to(X[:1], MOST_POINTS + 1)),
        r"draws 5,000,\d\d\d points; allowed: 5,000,000",
    ),
    "pixels": (
        lambda figure: figure.add_artist(image_of(figure, 20_000)),
        "draws 400,000,000 pixels in images; allowed",
    ),
}


def image_of(figure: Canvas, side: int) -> FigureImage:
    image = FigureImage(figure)
    image._A = np.broadcast_to(np.uint8(1), (side, side))  # type: ignore[attr-defined]
    return image


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_too_large_is_refused_with_what_is_allowed(name: str) -> None:
    draw, said = REFUSED[name]
    with pytest.raises(FigureError, match=said):
        drawn(draw)


def test_a_million_points_are_drawn_in_time_and_space() -> None:
    begun = time.process_time()
    result = drawn(lambda figure: figure.subplots().scatter(X, Y, s=1))
    assert time.process_time() - begun < 60
    assert len(result.svg) < 1_000_000
    assert len(result.curves) < 20_000


def test_a_size_from_the_paper_has_the_same_limit() -> None:
    with pytest.raises(FigureError, match="is 1000 x 4 inches"):
        drawn(lambda figure: figure.subplots(), size=(1000, 4))


def test_a_crowd_becomes_pixels_and_a_few_marks_stay_shapes() -> None:
    few, many = (
        drawn(lambda figure, n=n: figure.subplots().scatter(X[:n], Y[:n], label="cloud")).svg  # type: ignore[misc]
        for n in (CROWD, CROWD + 1)
    )
    assert few.count("<use ") > CROWD
    assert "<image " not in few
    assert many.count("<use ") < 500
    assert "<image " in many


def test_the_same_crowd_is_the_same_bytes() -> None:
    one, other = (drawn(lambda figure: figure.subplots().plot(X[:20_000], Y[:20_000], ".")) for _ in range(2))
    assert (one.svg, one.png) == (other.svg, other.png)
