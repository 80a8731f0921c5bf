"""The figures of a key: what each student was to draw, for those who mark."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import partial

from replicate.exhibits import Figure
from replicate.exhibits.variants import Variation
from replicate.handout.drawings import picture
from replicate.handout.form import Form

_SIZE = (3.25, 1.3)  # inches: two beside each other, six below each other on a page


@dataclass(frozen=True)
class KeyFigure:
    """A figure of one student.

    Attributes
    ----------
    heading
        Of all figures of its kind.
    """

    heading: str
    student: str
    svg: bytes
    alt: str


def key_figures(variations: Mapping[str, Variation], forms: Mapping[str, Form], paper: str) -> Iterator[KeyFigure]:
    """Yield the figures that markers compare drawings with: of one kind after the other, for all students in order.

    Parameters
    ----------
    forms
        By student.
    """
    for name, variation in variations.items():
        for figure in (one for one in variation.figures.values() if one.in_key):
            heading = f"{variation.name}: {figure.title}"
            for student, form in forms.items():
                draw = partial(figure.draw, inputs=variation.drawn(form.draw))
                drawn = Figure(f"{name}-{form.key}", "figure", heading, draw, alt=figure.alt, size=_SIZE)
                yield KeyFigure(heading, student, picture(f"{paper}-key", drawn, "svg"), figure.alt)
