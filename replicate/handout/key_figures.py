"""Figures for those who mark: what a student was to draw, for the whole class, many to a page of the key."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from replicate.exhibits import Figure
from replicate.exhibits.variants import Variation, VariedFigure
from replicate.handout.drawings import picture
from replicate.handout.form import Form
from replicate.handout.letters import can_be_set

if TYPE_CHECKING:
    from matplotlib.figure import Figure as MatplotlibFigure

_COLUMNS, _ROWS = 2, 6  # of a page
_PAGE = (6.7, 9.2)  # inches
_ROOM = {"left": 0.13, "right": 0.97, "bottom": 0.42, "top": 0.96}  # for the labels around the axes
_NAME = 0.13  # of a panel's height, above its figure
_LONGEST = 34  # letters of a name above a figure


@dataclass(frozen=True)
class KeyPage:
    """A page of figures: a heading, the drawing, and its words."""

    heading: str
    svg: bytes
    alt: str


def key_pages(variations: Mapping[str, Variation], forms: Mapping[str, Form], paper: str) -> Iterator[KeyPage]:
    """Yield the figures that markers compare drawings with, for all students in their order.

    Parameters
    ----------
    forms
        By student.
    """
    for name, variation in variations.items():
        for figure in (one for one in variation.figures.values() if one.in_key):
            students, size = list(forms.items()), _COLUMNS * _ROWS
            for start in range(0, len(students), size):
                yield _page(f"{name}-{start}", variation, figure, students[start : start + size], paper)


def _page(
    id: str, variation: Variation, figure: VariedFigure, forms: Sequence[tuple[str, Form]], paper: str
) -> KeyPage:
    heading = f"{variation.name}: {figure.title}"
    names = [student if can_be_set(student) else form.key for student, form in forms]

    def draw(fig: MatplotlibFigure) -> None:
        fig.set_layout_engine("none")  # all panels alike: nothing to be weighed
        fig.subplotpars.update(**_ROOM)
        parts = fig.subfigures(_ROWS, _COLUMNS, squeeze=False).ravel()
        for part, name, (_, form) in zip(parts, names, forms, strict=False):
            head, body = part.subfigures(2, 1, height_ratios=[_NAME, 1.0 - _NAME])
            figure.draw(body, inputs=variation.drawn(form.draw))
            head.text(_ROOM["left"], 0.1, name[:_LONGEST], fontsize=8, fontweight="bold", parse_math=False)

    alt = f"{figure.alt} One for each of: {', '.join(names)}."
    page = Figure(id, "figure", heading, draw, alt=alt, size=_PAGE)
    return KeyPage(heading, picture(f"{paper}-key", page, "svg"), alt)
