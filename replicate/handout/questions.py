"""The exercises of a handout as questions of a learning platform: text, answers and solution, one by one."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

from replicate.exhibits.exercises import Exercises
from replicate.exhibits.variants import Answers
from replicate.handout.drawings import Drawing
from replicate.handout.edition import Document
from replicate.handout.form import Form
from replicate.handout.tree import Blocks, attribute, classes, elements


@dataclass(frozen=True)
class Question:
    """One exercise with the numbers of one form.

    Attributes
    ----------
    exercise
        The name under which its numbers vary; without such a name, its number.
    number
        In the handout.
    variant
        The key of the form, or ``0`` for the numbers that all share.
    text, solution
        Pandoc's tree, without the heading.
    answers
        What is asked for, by name; nothing if the exercise is answered in words.
    files
        That go with it, by name.
    points
        For the whole exercise, if it has any.
    document
        What the exercise is from, with the formulas and drawings in its text but without the text.
    """

    exercise: str
    number: int
    title: str
    variant: str
    text: Blocks
    solution: Blocks
    answers: Answers
    files: Mapping[str, str]
    points: float | None
    document: Document

    @property
    def id(self) -> str:
        """A name that no other question has, of letters, digits, ``-`` and ``_``."""
        return f"{self.document.paper.id}-{self.exercise}-{self.variant}"


def questions_of(document: Document, exercises: Exercises, form: Form | None) -> Iterator[Question]:
    """Yield the exercises of an edition with solutions, in the order of the text.

    Raises
    ------
    PaperDefinitionError
        If an answer does not exist.
    """
    about = replace(document, blocks=[])
    for block in elements(document.blocks):
        if "exercise" not in classes(block):
            continue
        name = attribute(block, "vary")
        answers: Answers = {}
        files: Mapping[str, str] = {}
        if name:
            variation = exercises.variations[name]
            inputs = variation.drawn(form.draw) if form else variation.original
            answers, files = variation.answers(inputs), variation.files(inputs)
        content = block["c"][1][1:]
        number, points = int(attribute(block, "number")), attribute(block, "points")
        yield Question(
            exercise=name or f"exercise-{number}",
            number=number,
            title=attribute(block, "title"),
            variant=form.key if form and name else "0",
            text=[inner for inner in content if "solution" not in classes(inner)],
            solution=[part for inner in content if "solution" in classes(inner) for part in inner["c"][1]],
            answers=answers,
            files=files,
            points=float(points) if points else None,
            document=about,
        )


def drawings_in(blocks: Blocks, document: Document) -> list[Drawing]:
    """Return the drawings in a text, each once."""
    found = [attribute(element, "name") for element in elements(blocks) if "drawing" in classes(element)]
    return [document.drawings[name] for name in dict.fromkeys(found)]


def different(questions: Iterable[Question]) -> list[Question]:
    """Return questions by exercise and form; those of exercises that do not vary are the same on all forms."""
    found = {question.id: question for question in questions}
    return sorted(found.values(), key=lambda question: (question.number, question.variant))
