"""What a command asks for, made in a guarded process: code of papers and lecturers runs there, and nowhere else."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

from replicate.exhibits import Paper
from replicate.exhibits.results import Results
from replicate.handout.artist import Artist
from replicate.handout.build import handouts
from replicate.handout.class_set import ClassSet, varying
from replicate.handout.edition import AT_ONCE
from replicate.handout.exercise_heads import check_sheet
from replicate.handout.form import Form
from replicate.handout.formats import BANKS, SLIDES
from replicate.handout.own_exercises import OwnExercise, own_exercises
from replicate.handout.sheet import Sheet
from replicate.handout.stress import stressed
from replicate.run.guarded import tell
from replicate.run.units import loaded
from replicate.verdicts.rows import VerdictRow


@dataclass(frozen=True)
class Order:
    """What is to be made, in values that can be sent to a process.

    Attributes
    ----------
    packages
        Of the papers; of a class set, one.
    sheet
        What is set for all sheets, but for exercises of a lecturer's own.
    exercises
        Folders of these.
    file_format
        As `replicate.handout.formats` names them.
    solutions
        The editions: without solutions, with them, or both.
    students, seed
        Of a class set.
    again
        The form of one sheet to be made again.
    """

    packages: tuple[str, ...]
    sheet: Sheet
    exercises: tuple[Path, ...] = ()
    file_format: str = "pdf"
    solutions: tuple[bool, ...] = (False, True)
    students: tuple[str, ...] = ()
    seed: str = ""
    again: Form | None = None

    @property
    def varies(self) -> bool:
        """Whether the numbers are drawn."""
        return bool(self.students) or self.again is not None


def check_order(order: Order) -> Iterator[None]:
    """Refuse what cannot be made, before anything is computed; yields nothing.

    Raises
    ------
    ReplicateError
        If an exercise fails, or a selection or points do not go with the text.
    """
    for paper, sheet in _opened(order):
        if order.varies:
            varying(paper, sheet.own)
        if order.file_format != SLIDES:
            check_sheet(paper, sheet)
    yield from ()


def stress_test(order: Order, draws: int) -> Iterator[str]:
    """Yield a line on each answer to each exercise whose numbers vary; `stressed` says more."""
    for paper, sheet in _opened(order):
        check_sheet(paper, sheet)
        for variation in varying(paper, sheet.own).variations.values():
            yield from stressed(variation, draws)


def make(order: Order, results: Results, verdicts: Sequence[VerdictRow]) -> Iterator[tuple[str, bytes]]:
    """Yield the name and content of each file, and `tell` for a class set how many sheets of how many are done.

    Raises
    ------
    ReplicateError
        As `ClassSet` and `handouts`.
    """
    opened = _opened(order)
    if not order.varies:
        papers = [paper for paper, _ in opened]
        yield from handouts(
            papers, results, verdicts, solutions=order.solutions, file_format=order.file_format, sheet=opened[0][1]
        )
        return
    ((paper, sheet),) = opened
    class_set = ClassSet(paper, results, verdicts, order.solutions == (True,), sheet, order.file_format, _tell_progress)
    if order.again is not None:
        yield from class_set.again(order.again)
        return
    bank = order.file_format if order.file_format in BANKS else "moodle"  # what can be imported is in every set
    with Artist(paper.package, order.exercises) as artist:
        if len(order.students) > AT_ONCE:  # otherwise its process would not have begun before all is drawn
            class_set = replace(class_set, artist=artist)
        yield from class_set.files(order.students, order.seed, bank)


def _tell_progress(done: int, total: int) -> None:
    tell((done, total))


def _opened(order: Order) -> list[tuple[Paper, Sheet]]:
    sheet = replace(order.sheet, own=_own(order.exercises))
    return [(loaded(package), sheet) for package in order.packages]


@cache
def _own(folders: tuple[Path, ...]) -> tuple[OwnExercise, ...]:
    return tuple(one for folder in folders for one in own_exercises(folder))
