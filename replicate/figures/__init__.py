"""Compare what figures show, as data and in words: curves, axes, texts, colours and everything else that is drawn.

>>> from replicate.figures import capture, compare
>>> from matplotlib.figure import Figure
>>> accepted = Figure()
>>> lines = accepted.subplots().plot([0.0, 1.0], [0.0, 1.0], label="ZN")
>>> changed = Figure()
>>> lines = changed.subplots().plot([0.0, 1.0], [0.0, 1.0], "--", label="ZN")
>>> compare(capture(accepted), capture(changed)).changes
["curve 'ZN' is dashed now (was solid)"]

Knows no paper, and imports what it needs when it is needed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.figures.record import Record

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from replicate.figures.comparing import Comparison

__all__ = ["Record", "capture", "compare"]


def capture(figure: Figure) -> Record:
    """Return the record of a figure: what it shows, without the pixels.

    Parameters
    ----------
    figure
        Any figure of matplotlib, of any size and on any canvas; it stays as it is.

    Raises
    ------
    FigureError
        If it is not a figure.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> figure = Figure()
    >>> lines = figure.subplots().plot([0.0, 1.0], [2.0, 3.0], label="output")
    >>> capture(figure).curves["panel 1", "output"].tolist()
    [[0.0, 2.0], [1.0, 3.0]]
    """
    from replicate.figures.capturing import record_of

    return record_of(figure)


def compare(accepted: Record, new: Record) -> Comparison:
    """Compare two records of a figure.

    Parameters
    ----------
    accepted, new
        What the figure showed, and what it shows now.

    Returns
    -------
    Comparison
        ``changes`` is a list of texts of one line each, empty if nothing that can be seen differs.

    Raises
    ------
    FigureRecordError
        If a record cannot be compared.
    """
    from replicate.figures.comparing import compare_records

    return compare_records(accepted, new)
