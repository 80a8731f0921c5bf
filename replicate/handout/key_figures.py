"""The figures of a key: what each student was to draw, for those who mark."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from replicate.exhibits.variants import Variation
from replicate.handout.drawings import DrawnLater, Wanted
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
    form: Form
    drawing: DrawnLater


def key_figures(variations: Mapping[str, Variation], forms: Mapping[str, Form], paper: str) -> Iterator[KeyFigure]:
    """Yield the figures that markers compare drawings with: of one kind after the other, for all students in order.

    Parameters
    ----------
    forms
        By student.
    """
    for name, variation in variations.items():
        for key, figure in variation.figures.items():
            if not figure.in_key:
                continue
            heading = f"{variation.name}: {figure.title}"
            for student, form in forms.items():
                id = f"{name}-{form.key}"
                wanted = Wanted(f"{paper}-key", id, name, key, form.draw, heading, _SIZE)
                yield KeyFigure(heading, student, form, DrawnLater(wanted, figure.alt, 1.0, variations))
