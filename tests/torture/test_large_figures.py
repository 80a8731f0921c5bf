"""Figures of very many marks, of every kind: each is drawn within a minute of the processor, into files one can use."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
import pytest
from attack import Attack
from matplotlib.figure import Figure as Canvas

from replicate.exhibits import Figure
from replicate.run.drawing import capture

MILLION = 10**6
X, Y = np.random.default_rng(1).normal(size=(2, MILLION))

LARGE: dict[str, Callable[[Canvas], object]] = {
    "scatter": lambda figure: figure.subplots().scatter(X, Y, s=1),
    "coloured scatter": lambda figure: figure.subplots().scatter(X, Y, s=np.abs(X), c=Y),
    "markers": lambda figure: figure.subplots().plot(X, Y, "."),
    "line": lambda figure: figure.subplots().plot(np.cumsum(X)),
    "mesh": lambda figure: figure.subplots().pcolormesh(X.reshape(1000, 1000)),
    "image": lambda figure: figure.subplots().imshow(X.reshape(1000, 1000)),
    "hexagons": lambda figure: figure.subplots().hexbin(X, Y, gridsize=200),
    "histogram": lambda figure: figure.subplots().hist(X, bins=2000),
    "lines": lambda figure: figure.subplots().plot(Y[:18_000].reshape(2, 9_000)),
}


def drawn(name: str) -> str:
    def on(canvas: Canvas) -> None:
        LARGE[name](canvas)

    begun = time.process_time()
    result = capture("lab", Figure("fig-1", "figure", "Large", on))
    seconds = time.process_time() - begun
    if seconds > 60:
        return f"took {seconds:.0f} s"
    largest = max(len(result.svg), len(result.png))
    return f"is a file of {largest:,} bytes" if largest > 5_000_000 else ""


@pytest.mark.parametrize("name", LARGE)
def test_it_is_drawn_in_time_and_space(attack: Attack, name: str) -> None:
    if not attack.everything:
        pytest.skip("long; make torture tries it")
    attack("large figures are drawn in time and space", [name], drawn)
