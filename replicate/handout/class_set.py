"""A class set: one sheet per student, each with its own numbers, one key for those who mark, one file of questions."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import islice
from typing import TYPE_CHECKING, Any

from replicate.errors import PaperDefinitionError, TemplateError
from replicate.exhibits import Paper
from replicate.exhibits.exercises import Exercises
from replicate.exhibits.results import Results
from replicate.exhibits.variants import Variation
from replicate.handout.artist import Artist
from replicate.handout.drawings import Drawing, have_drawn
from replicate.handout.edition import AT_ONCE, Document, editions, without_solutions
from replicate.handout.form import Form
from replicate.handout.formats import BANKS, EDITIONS, PICTURES, named
from replicate.handout.key_figures import KeyFigure, key_figures
from replicate.handout.marking_key import KeyRow, key_csv, key_pdf, key_rows
from replicate.handout.own_exercises import OwnExercise, with_own
from replicate.handout.placing import exercises_of
from replicate.handout.questions import Question, drawings_in, questions_of
from replicate.handout.roster import file_stem
from replicate.handout.sheet import Sheet
from replicate.verdicts.rows import VerdictRow

if TYPE_CHECKING:
    from replicate.figures.off_screen import Kind


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
    progress
        Is given how many sheets of how many are done.
    artist
        Draws pictures of sheets, questions and key meanwhile; without one, they are drawn before a batch is set.
    """

    paper: Paper
    results: Results
    verdicts: Sequence[VerdictRow]
    solutions: bool = False
    sheet: Sheet = field(default_factory=Sheet)
    file_format: str = "pdf"
    progress: Callable[[int, int], None] = lambda *_: None
    artist: Artist | None = None
    _shared: dict[str, Any] = field(default_factory=dict, repr=False)

    def files(self, students: Sequence[str], seed: str, bank: str = "") -> Iterator[tuple[str, bytes]]:
        """Yield the name and content of the key's files, of each student's sheet, and of the file of questions.

        The same paper, seed and student give the same bytes, whoever else is in the class.

        Parameters
        ----------
        bank
            Format of the file of questions: each exercise with the numbers of each student. Empty for none.

        Raises
        ------
        PaperDefinitionError
            If no draw satisfies what an exercise requires, or an answer does not exist.
        TemplateError
            If a sheet cannot be set.
        """
        exercises = varying(self.paper, self.sheet.own)
        forms = {student: Form.of(self.paper.id, seed, student, self.sheet.select) for student in students}
        chosen = self._on_sheet(exercises, next(iter(forms.values()), None))
        rows = self._key(chosen, forms)
        yield f"{self.paper.id}-key.csv", key_csv(rows)
        figures = list(key_figures(chosen, forms, self.paper.id))
        for student, form in forms.items():
            yield from self._data(exercises, file_stem(student), form)
        questions: list[Question] | None = [] if bank else None
        sheets = self._sheets(forms.values(), exercises, questions, figures)
        if self.file_format in EDITIONS:
            yield from self._written([file_stem(student) for student in students], sheets)
        else:
            for number, _ in enumerate(sheets, start=1):
                self.progress(number, len(forms))
        yield f"{self.paper.id}-key.pdf", key_pdf(rows, self.paper, seed, figures)
        if questions is not None:
            yield from named(BANKS[bank](questions), self.paper.id).items()

    def again(self, form: Form) -> Iterator[tuple[str, bytes]]:
        """Yield the name and content of one sheet, made again from its id."""
        exercises = varying(self.paper, self.sheet.own)
        yield from self._data(exercises, form.key, form)
        yield from self._written([form.key], self._sheets([form], exercises))

    def _key(self, chosen: Mapping[str, Variation], forms: Mapping[str, Form]) -> list[KeyRow]:
        rows: list[KeyRow] = []
        for student, form in forms.items():
            try:
                rows += key_rows(chosen, student, form)
            except PaperDefinitionError as error:
                msg = f"{self.paper.id}, seed '{form.seed}', student '{student}': {error}"
                raise PaperDefinitionError(msg) from error
        return rows

    def _data(self, exercises: Exercises, stem: str, form: Form) -> Iterator[tuple[str, bytes]]:
        """Yield the files that go with a sheet."""
        for variation in self._on_sheet(exercises, form).values():
            for name, text in variation.files(variation.drawn(form.draw)).items():
                yield f"{self.paper.id}-{stem}-{name}", text.encode()

    def _on_sheet(self, exercises: Exercises, form: Form | None) -> Mapping[str, Variation]:
        """Return the exercises with numbers that are selected."""
        if not self.sheet.select or form is None:
            return exercises.variations
        if "on sheet" not in self._shared:
            (some,) = self._batch([form])
            self._shared["on sheet"] = {question.exercise for question in questions_of(some, exercises, None)}
        names = self._shared["on sheet"]
        return {name: variation for name, variation in exercises.variations.items() if name in names}

    def _sheets(
        self,
        forms: Iterable[Form],
        exercises: Exercises,
        questions: list[Question] | None = None,
        figures: Collection[KeyFigure] = (),
    ) -> Iterator[Document]:
        """Yield sheets, made in batches, whose pictures are drawn together: also those of the key and of questions.

        Parameters
        ----------
        questions
            To which those of the sheets are added, if there is such a list.
        figures
            Of the key.
        """
        waiting = iter(forms)
        while some := list(islice(waiting, AT_ONCE)):
            solved = self._batch(some)
            sheets = solved if self.solutions else [without_solutions(one) for one in solved]
            pictures: list[tuple[Drawing, Kind]] = []
            if kind := PICTURES.get(self.file_format):
                pictures += [(drawing, kind) for sheet in sheets for drawing in sheet.drawings.values()]
            if questions is not None:
                pairs = zip(solved, some, strict=True)
                asked = [one for document, form in pairs for one in questions_of(document, exercises, form)]
                texts = (drawings_in([*one.text, *one.solution], one.document) for one in asked)
                pictures += [(drawing, "png") for drawings in texts for drawing in drawings]
                questions += asked
            pictures += [(figure.drawing, "svg") for figure in figures if figure.form in some]
            have_drawn(pictures, self.artist)
            yield from sheets

    def _batch(self, forms: Sequence[Form]) -> list[Document]:
        return editions(
            self.paper,
            self.results,
            self.verdicts,
            solutions=True,
            forms=forms,
            sheet=self.sheet,
            shared=self._shared,
        )

    def _written(self, stems: Sequence[str], sheets: Iterable[Document]) -> Iterator[tuple[str, bytes]]:
        for number, (stem, made) in enumerate(zip(stems, EDITIONS[self.file_format](sheets), strict=True), start=1):
            self.progress(number, len(stems))
            yield from named(made, f"{self.paper.id}-{stem}{'-solutions' if self.solutions else ''}").items()


def varying(paper: Paper, own: tuple[OwnExercise, ...] = ()) -> Exercises:
    """Return the exercises of a paper, and a lecturer's own.

    Raises
    ------
    TemplateError
        If the numbers of none of them vary.
    """
    exercises = with_own(exercises_of(paper), own)
    if not exercises.variations:
        msg = f"{paper.id}/handout.py: no exercise has numbers that vary, so all sheets would be the same"
        raise TemplateError(msg)
    return exercises
