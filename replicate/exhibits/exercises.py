"""What the exercises of a handout need: answers and figures, computed when the handout is built.

A paper with a handout may have a module ``handout.py`` beside its ``handout.md``. It makes one `Exercises`
object named ``exercises`` and registers functions with it; the text asks for them by name. Nothing that an
answer says is typed into the text.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from random import Random
from typing import TYPE_CHECKING

from replicate.errors import PaperDefinitionError
from replicate.exhibits.drawn import Figure
from replicate.exhibits.variants import Answers, Inputs, Variation, VariedFigure

if TYPE_CHECKING:
    from matplotlib.figure import Figure as MatplotlibFigure

Values = Mapping[str, float | str]


@dataclass
class Exercises:
    """Answers and figures of one handout, by name.

    Attributes
    ----------
    answers
        Functions that compute an answer.
    figures
        Figures drawn for the handout.
    variations
        Exercises whose numbers vary from student to student.

    Examples
    --------
    >>> exercises = Exercises()
    >>> @exercises.answer("square")
    ... def square() -> Values:
    ...     return {"of_three": 3.0**2}
    >>> exercises.answers["square"]()
    {'of_three': 9.0}
    """

    answers: dict[str, Callable[[], Values]] = field(default_factory=dict)
    figures: dict[str, Figure] = field(default_factory=dict)
    variations: dict[str, Variation] = field(default_factory=dict)

    def answer(self, name: str) -> Callable[[Callable[[], Values]], Callable[[], Values]]:
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

        def register(compute: Callable[[], Values]) -> Callable[[], Values]:
            if name in self.answers or name in self.variations:
                msg = f"handout: answer '{name}' is defined twice"
                raise PaperDefinitionError(msg)
            self.answers[name] = compute
            return compute

        return register

    def vary(
        self,
        name: str,
        *,
        original: Inputs,
        variant: Callable[[Random], Inputs],
        requires: Mapping[str, Callable[[Inputs], bool]],
        shown: Callable[[Inputs], Values] = lambda _: {},
        stated: str = "",
        figures: Mapping[str, VariedFigure] | None = None,
        files: Callable[[Inputs], Mapping[str, str]] = lambda _: {},
    ) -> Callable[[Callable[[Inputs], Answers]], Callable[[Inputs], Answers]]:
        """Register the decorated function as the answers to an exercise whose numbers vary.

        Parameters
        ----------
        name
            By which the text asks for ``inputs(name)`` and ``answer(name)``.
        original
            The numbers of the handout that all share.
        variant
            Draws inputs.
        requires
            What inputs must satisfy, by the words that name it; they are drawn anew until they do.
        shown
            Computes what else the text says about inputs, for ``answer(name)``.
        stated
            A sentence for sheets that are marked by the key: how to round, for ``stated(name)``.
        figures
            Figures of the inputs, by name.
        files
            Computes files that go with a sheet, by the ends of their names, say ``step-test.csv``.

        Raises
        ------
        PaperDefinitionError
            If a name is taken.
        """

        def register(compute: Callable[[Inputs], Answers]) -> Callable[[Inputs], Answers]:
            if name in self.answers or name in self.variations:
                msg = f"handout: answer '{name}' is defined twice"
                raise PaperDefinitionError(msg)
            taken = [one for one in figures or () if one in self._figure_names()]
            if taken:
                msg = f"handout: figure '{taken[0]}' is defined twice"
                raise PaperDefinitionError(msg)
            self.variations[name] = Variation(
                name, original, variant, compute, requires, shown, stated, figures or {}, files
            )
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
            if name in self._figure_names():
                msg = f"handout: figure '{name}' is defined twice"
                raise PaperDefinitionError(msg)
            self.figures[name] = Figure(name, "figure", title, draw, alt=alt, size=size)
            return draw

        return register

    def _figure_names(self) -> set[str]:
        return {*self.figures, *(name for variation in self.variations.values() for name in variation.figures)}
