"""Draw a figure exhibit off-screen: a paper's function draws on an ordinary matplotlib figure and knows no files."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.figure import Figure as Canvas

from replicate.exhibits import Figure
from replicate.exhibits.results import FigureResult
from replicate.figures import capture as record_of
from replicate.figures.limits import check_limits, rasterise_crowds
from replicate.figures.off_screen import curves_frame, png_bytes, svg_text
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
    Exception
        Whatever the exhibit's own function raises.
    """
    with style(hashsalt=f"{paper}/{exhibit.id}"):
        canvas = Canvas(figsize=exhibit.size)
        exhibit.draw(canvas)
        check_limits(canvas)
        rasterise_crowds(canvas)
        record = record_of(canvas)
        return FigureResult(
            paper=paper,
            exhibit=exhibit.id,
            svg=svg_text(canvas, exhibit.title),
            png=png_bytes(canvas),
            curves=curves_frame(record),
            axes=[dict(panel) for panel in record.panels],
            figure=dict(record.figure),
        )


def no_figure(paper: str, exhibit: str, error: str) -> FigureResult:
    """Return the record of a figure that could not be drawn."""
    curves = pd.DataFrame({"panel": [], "curve": [], "x": np.empty(0), "y": np.empty(0)})
    return FigureResult(paper, exhibit, svg="", png=b"", curves=curves, axes=[], error=error)
