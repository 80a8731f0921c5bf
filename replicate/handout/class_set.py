"""A class set: one sheet per student, each with its own numbers, one key for those who mark, one file of questions."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import islice
from typing import Any

from replicate.errors import PaperDefinitionError, TemplateError
from replicate.exhibits import Paper
from replicate.exhibits.exercises import Exercises
from replicate.exhibits.results import Results
from replicate.exhibits.variants import Variation
from replicate.handout.artist import Artist
from replicate.handout.drawings import Wanted
from replicate.handout.edition import AT_ONCE, Document, editions, without_solutions
from replicate.handout.form import Form
from replicate.handout.formats import BANKS, EDITIONS, named
from replicate.handout.key_figures import key_figures
from replicate.handout.marking_key import KeyRow, key_csv, key_pdf, key_rows
from replicate.handout.own_exercises import OwnExercise, with_own
from replicate.handout.placing import exercises_of
from replicate.handout.questions import Question, pictures_of, questions_of
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
    progress
        Is given how many sheets of how many are done.
    artist
        Draws the pictures of key and questions meanwhile; without one, they are drawn when they are needed.
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
        draw = self._draw([figure.wanted for figure in figures], exercises)
        for student, form in forms.items():
            yield from self._data(exercises, file_stem(student), form)
        questions: list[Question] = []
        stems = [file_stem(student) for student in students]
        if self.file_format in EDITIONS:
            yield from self._sheets(stems, self._documents(forms.values(), exercises, questions if bank else None))
        else:
            for number, _ in enumerate(self._documents(forms.values(), exercises, questions), start=1):
                self.progress(number, len(forms))
        yield f"{self.paper.id}-key.pdf", key_pdf(rows, self.paper, seed, figures, draw)
        if bank:
            yield from named(BANKS[bank](questions), self.paper.id).items()

    def again(self, form: Form) -> Iterator[tuple[str, bytes]]:
        """Yield the name and content of one sheet, made again from its id."""
        exercises = varying(self.paper, self.sheet.own)
        yield from self._data(exercises, form.key, form)
        yield from self._sheets([form.key], self._documents([form], exercises, None))

    def _key(self, chosen: Mapping[str, Variation], forms: Mapping[str, Form]) -> list[KeyRow]:
        rows: list[KeyRow] = []
        for student, form in forms.items():
            try:
                rows += key_rows(chosen, student, form)
            except PaperDefinitionError as error:
                msg = f"{self.paper.id}, seed '{form.seed}', student '{student}': {error}"
                raise PaperDefinitionError(msg) from error
        return rows

    def _draw(self, wanted: Sequence[Wanted], exercises: Exercises) -> Callable[[Wanted], bytes]:
        """Return what draws pictures that will be wanted."""
        return self.artist.order(wanted) if self.artist else lambda one: one.drawn(exercises)

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

    def _documents(
        self, forms: Iterable[Form], exercises: Exercises, questions: list[Question] | None
    ) -> Iterator[Document]:
        """Yield sheets with their solutions, made in batches; their questions go to the list if there is one."""
        waiting = iter(forms)
        while some := list(islice(waiting, AT_ONCE)):
            for form, document in zip(some, self._batch(some), strict=True):
                if questions is not None:
                    asked = list(questions_of(document, exercises, form))
                    questions += asked
                    self._pictures(asked)
                yield document

    def _pictures(self, questions: Iterable[Question]) -> None:
        """Have pictures of questions drawn: by the artist, or now, while another thread still sets sheets."""
        later = pictures_of(questions)
        if not self.artist:
            for drawing in later:
                drawing.png  # noqa: B018  -- it is kept
            return
        draw = self.artist.order([drawing.wanted("png") for drawing in later])
        for drawing in later:
            drawing.drawn_by("png", draw)

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

    def _sheets(self, stems: Sequence[str], documents: Iterable[Document]) -> Iterator[tuple[str, bytes]]:
        shown = (document if self.solutions else without_solutions(document) for document in documents)
        for number, (stem, made) in enumerate(zip(stems, EDITIONS[self.file_format](shown), strict=True), start=1):
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
