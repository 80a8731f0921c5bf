"""Answers checked in a notebook that does not hold them: they are computed anew from the form.

>>> from replicate.handout.checking import Checker
>>> check = Checker("bayhan")
>>> check("pade-phase", {"low": 0.21})
low: off by 180 %
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from replicate.errors import ReplicateError
from replicate.exhibits.variants import Answer, Variation
from replicate.handout.form import Form
from replicate.handout.own_exercises import BESIDE, PROGRAM, own_variation
from replicate.handout.placing import exercises_of
from replicate.run.library import Library
from replicate.run.project import find_project

if TYPE_CHECKING:
    from matplotlib.figure import Figure as MatplotlibFigure

    from replicate.exhibits import Figure

_NEAR = 0.01  # of the axes: how far a curve on a grid of one's own may be


class Checker:
    """Checks the answers to one form of a paper's exercises.

    Parameters
    ----------
    paper
        Its id.
    form
        The id of the form; without one, the numbers that all share.
    folders
        That hold papers, besides those of the project and the bundled ones.
    own
        Names of a lecturer's own exercises, whose programs are in the folder ``exercises`` of the current one.

    Raises
    ------
    ReplicateError
        If there is no such paper, or the form is of another.
    """

    def __init__(self, paper: str, form: str = "", folders: tuple[str, ...] = (), own: tuple[str, ...] = ()) -> None:
        self.form = Form.read(form) if form else None
        if self.form is not None and self.form.paper != paper:
            msg = f"the form '{form}' is of the paper '{self.form.paper}', not of '{paper}'"
            raise ReplicateError(msg)
        library = Library(find_project(), tuple(Path(folder) for folder in folders), True)
        self.exercises = exercises_of(library.paper(paper))
        self.own = own

    def __call__(self, exercise: str, answers: Mapping[str, float | None]) -> None:
        """Say for each answer whether it is right; what is ``None`` is not answered yet.

        Raises
        ------
        ReplicateError
            If there is no such exercise, or no such answer to it.
        """
        found = self._answers(exercise)
        for name, stated in answers.items():
            if name not in found:
                msg = f"exercise '{exercise}' has no answer '{name}'; allowed: {', '.join(found)}"
                raise ReplicateError(msg)
            print(f"{name}: {'not answered yet' if stated is None else verdict(found[name], float(stated))}")  # noqa: T201

    def plot(self, name: str, figure: MatplotlibFigure) -> None:
        """Say whether a figure shows the curves of a figure of the solution.

        Raises
        ------
        ReplicateError
            If the handout has no such figure.
        """
        if name not in self.exercises.figures:
            msg = f"the handout has no figure '{name}'; allowed: {', '.join(self.exercises.figures) or 'none'}"
            raise ReplicateError(msg)
        print(*(_other_curves(self.exercises.figures[name], figure) or ["right"]), sep="\n")  # noqa: T201

    def _answers(self, exercise: str) -> Mapping[str, Answer]:
        variation = _own(exercise) if exercise in self.own else self.exercises.variations.get(exercise)
        if variation is None:
            known = ", ".join([*self.exercises.variations, *self.own])
            msg = f"no exercise '{exercise}' has numbers to check; allowed: {known}"
            raise ReplicateError(msg)
        return variation.answers(variation.drawn(self.form.draw) if self.form else variation.original)


@cache
def _own(exercise: str) -> Variation:
    program = Path(BESIDE) / exercise / PROGRAM
    if not program.is_file():
        msg = f"'{exercise}' is checked with the file {program.as_posix()}, which is not beside the notebook"
        raise ReplicateError(msg)
    return own_variation(program, exercise)


def _other_curves(solution: Figure, stated: MatplotlibFigure) -> list[str]:
    """Return which curves of the solution a figure lacks, or has elsewhere; its axes, colours and more are its own."""
    from matplotlib.figure import Figure as Canvas

    from replicate.figures import capture, compare

    drawn, record = Canvas(figsize=solution.size), capture(stated)
    solution.draw(drawn)
    if not record.panels:
        return ["the figure has no axes"]
    return [
        difference.text
        for difference in compare(capture(drawn), record).differences
        if difference.kind == "removed" or (difference.kind == "curve" and (difference.size or 0.0) > _NEAR)
    ]


def verdict(answer: Answer, stated: float) -> str:
    """Return what a stated answer deserves.

    Examples
    --------
    >>> answer = Answer(0.3, digits=2, carried=(0.31,))
    >>> [verdict(answer, stated) for stated in (0.301, 0.31, 0.33)]
    ['right', 'right but rounded too early', 'off by 10 %']
    """
    if Answer(answer.value, digits=answer.digits, tolerance=answer.tolerance).accepts(stated):
        return "right"
    if answer.accepts(stated):
        return "right but rounded too early"
    off = abs(stated - answer.value)
    if answer.value == 0.0:
        return f"off by {off:.2g}"
    return f"off by {float(f'{100.0 * off / abs(answer.value):.2g}'):g} %"
