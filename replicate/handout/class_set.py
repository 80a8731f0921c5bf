"""A class set: one sheet per student, each with its own numbers, and one key for those who mark."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from replicate.errors import PaperDefinitionError, TemplateError
from replicate.exhibits import Paper
from replicate.exhibits.exercises import Exercises
from replicate.exhibits.results import Results
from replicate.handout.edition import edition
from replicate.handout.form import Form
from replicate.handout.marking_key import KeyRow, key_csv, key_pdf, key_rows
from replicate.handout.placing import exercises_of
from replicate.handout.printout import pdf
from replicate.handout.roster import file_stem
from replicate.verdicts.rows import VerdictRow


@dataclass(frozen=True)
class ClassSet:
    """The sheets of one paper for a class.

    Parameters
    ----------
    paper, results, verdicts
        What the handout is about; the paper has exercises whose numbers vary.
    solutions
        Whether the sheets show the solutions.
    """

    paper: Paper
    results: Results
    verdicts: Sequence[VerdictRow]
    solutions: bool = False

    def files(self, students: Sequence[str], seed: str) -> Iterator[tuple[str, bytes]]:
        """Yield the name and content of the key's files, then of each student's sheet.

        The same paper, seed and student give the same bytes, whoever else is in the class.

        Raises
        ------
        PaperDefinitionError
            If no draw satisfies what an exercise requires.
        TemplateError
            If a sheet cannot be set.
        """
        exercises = varying(self.paper)
        forms = {student: Form.of(self.paper.id, seed, student) for student in students}
        rows = [row for student, form in forms.items() for row in self._key(exercises, student, form)]
        yield f"{self.paper.id}-key.csv", key_csv(rows)
        yield f"{self.paper.id}-key.pdf", key_pdf(rows, self.paper, seed)
        shared: dict[str, Any] = {}
        for student, form in forms.items():
            yield self._name(file_stem(student)), self._sheet(form, shared)

    def again(self, form: Form) -> tuple[str, bytes]:
        """Return the name and content of one sheet, made again from its id."""
        varying(self.paper)
        return self._name(form.key), self._sheet(form, {})

    def _key(self, exercises: Exercises, student: str, form: Form) -> list[KeyRow]:
        try:
            return key_rows(exercises, student, form)
        except PaperDefinitionError as error:
            msg = f"{self.paper.id}, seed '{form.seed}', student '{student}': {error}"
            raise PaperDefinitionError(msg) from error

    def _name(self, stem: str) -> str:
        return f"{self.paper.id}-{stem}{'-solutions' if self.solutions else ''}.pdf"

    def _sheet(self, form: Form, shared: dict[str, Any]) -> bytes:
        document = edition(self.paper, self.results, self.verdicts, solutions=self.solutions, form=form, shared=shared)
        return pdf(document)


def varying(paper: Paper) -> Exercises:
    """Return the exercises of a paper.

    Raises
    ------
    TemplateError
        If the numbers of none of them vary.
    """
    exercises = exercises_of(paper)
    if not exercises.variations:
        msg = f"{paper.id}/handout.py: no exercise has numbers that vary, so all sheets would be the same"
        raise TemplateError(msg)
    return exercises
