"""A class set: one sheet per student, each with its own numbers, one key for those who mark, one file of questions."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from replicate.errors import PaperDefinitionError, TemplateError
from replicate.exhibits import Paper
from replicate.exhibits.exercises import Exercises
from replicate.exhibits.results import Results
from replicate.handout.edition import Document, edition, without_solutions
from replicate.handout.form import Form
from replicate.handout.formats import BANKS, EDITIONS, named
from replicate.handout.marking_key import KeyRow, key_csv, key_pdf, key_rows
from replicate.handout.placing import exercises_of
from replicate.handout.questions import questions_of
from replicate.handout.roster import file_stem
from replicate.handout.sheet import Sheet
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
    sheet
        What a lecturer sets for all of them.
    file_format
        Of the sheets, or of the file of questions in their place.
    """

    paper: Paper
    results: Results
    verdicts: Sequence[VerdictRow]
    solutions: bool = False
    sheet: Sheet = field(default_factory=Sheet)
    file_format: str = "pdf"
    _shared: dict[str, Any] = field(default_factory=dict, repr=False)

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
        forms = self._forms(students, seed)
        rows = [row for student, form in forms.items() for row in self._key(exercises, student, form)]
        yield f"{self.paper.id}-key.csv", key_csv(rows)
        yield f"{self.paper.id}-key.pdf", key_pdf(rows, self.paper, seed)
        if self.file_format in EDITIONS:
            for student, form in forms.items():
                yield from self._sheet(file_stem(student), form)

    def bank(self, students: Sequence[str], seed: str, file_format: str) -> Iterator[tuple[str, bytes]]:
        """Yield the name and content of the file of questions: each exercise with the numbers of each student.

        Raises
        ------
        PaperDefinitionError
            If an answer does not exist.
        TemplateError
            If a text cannot be converted.
        """
        exercises = varying(self.paper)
        questions = [
            question
            for form in self._forms(students, seed).values()
            for question in questions_of(self._document(form), exercises, form)
        ]
        yield from named(BANKS[file_format](questions), self.paper.id).items()

    def again(self, form: Form) -> Iterator[tuple[str, bytes]]:
        """Yield the name and content of one sheet, made again from its id."""
        varying(self.paper)
        yield from self._sheet(form.key, form)

    def _forms(self, students: Sequence[str], seed: str) -> dict[str, Form]:
        return {student: Form.of(self.paper.id, seed, student, self.sheet.select) for student in students}

    def _key(self, exercises: Exercises, student: str, form: Form) -> list[KeyRow]:
        chosen = exercises.variations
        if self.sheet.select:
            on_sheet = {question.exercise for question in questions_of(self._document(form), exercises, form)}
            chosen = {name: variation for name, variation in chosen.items() if name in on_sheet}
        try:
            return key_rows(chosen, student, form)
        except PaperDefinitionError as error:
            msg = f"{self.paper.id}, seed '{form.seed}', student '{student}': {error}"
            raise PaperDefinitionError(msg) from error

    def _sheet(self, stem: str, form: Form) -> Iterator[tuple[str, bytes]]:
        document = self._document(form)
        made = EDITIONS[self.file_format](document if self.solutions else without_solutions(document))
        yield from named(made, f"{self.paper.id}-{stem}{'-solutions' if self.solutions else ''}").items()

    def _document(self, form: Form) -> Document:
        """Return a sheet with its solutions; it is made once."""
        key = f"document {form}"
        if key not in self._shared:
            self._shared[key] = edition(
                self.paper,
                self.results,
                self.verdicts,
                solutions=True,
                form=form,
                sheet=self.sheet,
                shared=self._shared,
            )
        document: Document = self._shared[key]
        return document


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
