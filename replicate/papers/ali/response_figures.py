"""The figures with responses, 1 to 8: records of what each shows, and their registration with the paper."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from replicate.papers.ali import paper

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class ResponseFigure:
    """One figure: id, title, how it is drawn, and what is said of it; the size is in inches."""

    id: str
    title: str
    draw: Callable[[Figure], None]
    caption: str
    alt: str
    size: tuple[float, float] = (7.4, 3.4)


def add_figures(figures: Iterable[ResponseFigure]) -> None:
    """Add the figures to the paper, in the order given."""
    for figure in figures:
        paper.figure(figure.id, figure.title, caption=figure.caption, alt=figure.alt, size=figure.size)(figure.draw)
