"""Draw a figure exhibit off-screen: a paper's function draws on an ordinary matplotlib figure and knows no files."""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Canvas
from matplotlib.text import Text

from replicate.errors import PaperDefinitionError
from replicate.exhibits import Figure
from replicate.exhibits.results import FigureResult
from replicate.figures import capture as record_of
from replicate.figures.limits import within_limits
from replicate.figures.off_screen import Kind, curves_frame, pictures
from replicate.figures.style import style


def capture(paper: str, exhibit: Figure) -> FigureResult:
    """Draw a figure exhibit.

    Parameters
    ----------
    paper
        Id of the paper; with the exhibit's id it seeds the ids inside the SVG.

    Returns
    -------
    FigureResult
        SVG (transparent, ink and paper colours as in `replicate.figures.style`), PNG (white), curves and axes.

    Raises
    ------
    PaperDefinitionError
        If the function has drawn nothing on the figure.
    Exception
        Whatever the exhibit's own function raises.
    """
    with style(hashsalt=f"{paper}/{exhibit.id}"):
        canvas = _drawn(exhibit)
        record = record_of(canvas)
        svg, png = pictures(canvas, exhibit.title, ("svg", "png"))
        return FigureResult(
            paper=paper,
            exhibit=exhibit.id,
            svg=svg.decode(),
            png=png,
            curves=curves_frame(record),
            axes=[dict(panel) for panel in record.panels],
            figure=dict(record.figure),
        )


def _drawn(exhibit: Figure) -> Canvas:
    """Let an exhibit draw; what is empty or too large is refused, crowds of marks become pixels."""
    canvas = Canvas(figsize=exhibit.size)
    draw: Callable[..., Any] = exhibit.draw
    made = draw(canvas)
    if inspect.iscoroutine(made) or inspect.isgenerator(made):
        kind = "asynchronous" if inspect.iscoroutine(made) else "a generator"
        getattr(made, "close")()  # noqa: B009  -- both kinds have it; nothing of it has run
        msg = f"the function is {kind}, so nothing was drawn; expected: a plain function"
        raise PaperDefinitionError(msg)
    if isinstance(made, Canvas) and made is not canvas:
        msg = "the function returns a figure of its own; expected: something drawn on the figure given"
        raise PaperDefinitionError(msg)
    within_limits(canvas)
    _check_drawn(canvas)
    return canvas


def _check_drawn(canvas: Canvas) -> None:
    """Refuse a figure on which nothing is drawn: the function has drawn elsewhere, or forgot to."""
    blank = [_bare(axes) for axes in canvas.axes]
    others = [artist for artist in canvas.get_children() if artist is not canvas.patch and artist not in canvas.axes]
    if others or not all(blank):
        return
    if "matplotlib.pyplot" in sys.modules and sys.modules["matplotlib.pyplot"].get_fignums():
        msg = "the figure is empty, and pyplot has one of its own: draw on the figure given, axes = fig.subplots()"
    else:
        msg = "the figure is empty; expected: something drawn on the figure given, axes = fig.subplots()"
    raise PaperDefinitionError(msg)


def _bare(axes: Axes) -> bool:
    """Say whether axes hold nothing but themselves: frame, axis lines, and texts without words."""
    own = {axes.patch, axes.xaxis, axes.yaxis, *axes.spines.values()}
    return all(artist in own or (isinstance(artist, Text) and not artist.get_text()) for artist in axes.get_children())


def drawn_as(paper: str, exhibit: Figure, kinds: Sequence[Kind]) -> tuple[bytes, ...]:
    """Draw a figure without reading back what it shows; otherwise as `capture`.

    Raises
    ------
    PaperDefinitionError, Exception
        As `capture`.
    """
    with style(hashsalt=f"{paper}/{exhibit.id}"):
        return pictures(_drawn(exhibit), exhibit.title, kinds)


def no_figure(paper: str, exhibit: str, error: str) -> FigureResult:
    """Return the record of a figure that could not be drawn."""
    curves = pd.DataFrame({"panel": [], "curve": [], "x": np.empty(0), "y": np.empty(0)})
    return FigureResult(paper, exhibit, svg="", png=b"", curves=curves, axes=[], error=error)
