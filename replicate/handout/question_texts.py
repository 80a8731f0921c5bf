"""The texts of questions as HTML, all of them in one call of pandoc."""

from __future__ import annotations

import hashlib
import html
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from replicate.display.function_names import functions_apart
from replicate.handout.drawings import Drawing
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


def texts_of(questions: Sequence[Question], place: Callable[[Question, str], str], *options: str) -> Iterator[Texts]:
    """Yield the texts of questions.

    Parameters
    ----------
    place
        Returns where the platform finds a figure or a file of a question by its name.
    options
        Of pandoc: how formulas are to be written.
    """
    pieces: list[Blocks] = []
    for question in questions:
        pieces += [_with_images(part, question, place) for part in (question.text, question.solution)]
        pieces += [[plain(inlines(answer.asked or name))] for name, answer in question.answers.items()]
    made = map(functions_apart, written(pieces, "html", *options))
    for question in questions:
        links = "".join(f'<p><a href="{place(question, name)}">{name}</a></p>\n' for name in question.files)
        yield Texts(next(made) + links, next(made), {name: next(made).strip() for name in question.answers})


def picture_name(drawing: Drawing) -> str:
    """Return a name for the file of a drawing: the same for the same picture only."""
    return f"{drawing.name}-{hashlib.sha256(drawing.png).hexdigest()[:12]}.png"


def _with_images(blocks: Blocks, question: Question, place: Callable[[Question, str], str]) -> Blocks:
    def changed(element: Element) -> list[Element] | None:
        if element["t"] == "Div" and "drawing" in classes(element):
            drawing = question.document.drawings[attribute(element, "name")]
            image = f'<p><img src="{place(question, picture_name(drawing))}" alt="{html.escape(drawing.alt)}" /></p>'
            return [raw_block("html", image), *element["c"][1]]
        if element["t"] == "CodeBlock":
            return [raw_block("html", f"<pre>{html.escape(element['c'][1], quote=False)}</pre>")]
        return None

    out: Blocks = transform(blocks, changed)
    return out
