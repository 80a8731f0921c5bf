"""What the exercises of a handout need: answers and figures, computed when the handout is built.

A paper with a handout may have a module ``handout.py`` beside its ``handout.md``. It makes one `Exercises`
object named ``exercises`` and registers functions with it; the text asks for them by name. Nothing that an
answer says is typed into the text.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from replicate.errors import PaperDefinitionError
from replicate.exhibits.drawn import Figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure as MatplotlibFigure

Answer = Mapping[str, float | str]


@dataclass
class Exercises:
    """Answers and figures of one handout, by name.

    Attributes
    ----------
    answers
        Functions that compute an answer.
    figures
        Figures drawn for the handout.

    Examples
    --------
    >>> exercises = Exercises()
    >>> @exercises.answer("square")
    ... def square() -> Answer:
    ...     return {"of_three": 3.0**2}
    >>> exercises.answers["square"]()
    {'of_three': 9.0}
    """

    answers: dict[str, Callable[[], Answer]] = field(default_factory=dict)
    figures: dict[str, Figure] = field(default_factory=dict)

    def answer(self, name: str) -> Callable[[Callable[[], Answer]], Callable[[], Answer]]:
        """Register the decorated function as an answer: named numbers (or words) for the text.

        Parameters
        ----------
        name
            By which the text asks for it.

        Raises
        ------
        PaperDefinitionError
            If the name is taken.
        """

        def register(compute: Callable[[], Answer]) -> Callable[[], Answer]:
            if name in self.answers:
                msg = f"handout: answer '{name}' is defined twice"
                raise PaperDefinitionError(msg)
            self.answers[name] = compute
            return compute

        return register

    def figure(
        self, name: str, title: str, *, alt: str, size: tuple[float, float] = (6.4, 3.0)
    ) -> Callable[[Callable[[MatplotlibFigure], None]], Callable[[MatplotlibFigure], None]]:
        """Register the decorated function as a figure; it draws on an empty matplotlib figure.

        Parameters
        ----------
        name
            By which the text asks for it.
        title
            The title inside the file of the drawing.
        alt
            What the figure shows, in words, for those who cannot see it.
        size
            Width and height in inches.

        Raises
        ------
        PaperDefinitionError
            If the name is taken.
        """

        def register(draw: Callable[[MatplotlibFigure], None]) -> Callable[[MatplotlibFigure], None]:
            if name in self.figures:
                msg = f"handout: figure '{name}' is defined twice"
                raise PaperDefinitionError(msg)
            self.figures[name] = Figure(name, "figure", title, draw, alt=alt, size=size)
            return draw

        return register
