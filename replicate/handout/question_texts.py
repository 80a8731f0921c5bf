"""The texts of questions as HTML, all of them in one call of pandoc."""

from __future__ import annotations

import html
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from replicate.handout.pandoc import written
from replicate.handout.questions import Question
from replicate.handout.tree import Blocks, Element, attribute, classes, inlines, plain, raw_block, transform


@dataclass(frozen=True)
class Texts:
    """The parts of a question as HTML.

    Attributes
    ----------
    labels
        What each answer is called, by its name.
    """

    text: str
    solution: str
    labels: dict[str, str]


def texts_of(questions: Sequence[Question], images: str, *options: str) -> Iterator[Texts]:
    """Yield the texts of questions.

    Parameters
    ----------
    images
        Where the platform finds the figures, before their names.
    options
        Of pandoc: how formulas are to be written.
    """
    pieces: list[Blocks] = []
    for question in questions:
        pieces += [_with_images(part, question, images) for part in (question.text, question.solution)]
        pieces += [[plain(inlines(answer.asked or name))] for name, answer in question.answers.items()]
    made = iter(written(pieces, "html", *options))
    for question in questions:
        yield Texts(next(made), next(made), {name: next(made).strip() for name in question.answers})


def _with_images(blocks: Blocks, question: Question, images: str) -> Blocks:
    def changed(element: Element) -> list[Element] | None:
        if element["t"] == "Div" and "drawing" in classes(element):
            drawing = question.document.drawings[attribute(element, "name")]
            image = f'<p><img src="{images}{drawing.name}.png" alt="{html.escape(drawing.alt)}" /></p>'
            return [raw_block("html", image), *element["c"][1]]
        if element["t"] == "CodeBlock":
            return [raw_block("html", f"<pre>{html.escape(element['c'][1], quote=False)}</pre>")]
        return None

    out: Blocks = transform(blocks, changed)
    return out
