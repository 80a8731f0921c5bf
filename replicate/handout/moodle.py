"""The exercises of a handout as questions for Moodle, in its own XML.

One category per exercise, in it one question per form. An exercise with one answer is a numerical question, one with
several a cloze question, one without numbers an essay. Formulas are TeX, figures are inside the file.
Source: the format as Moodle documents it under "Moodle XML format", "Numerical question type", "Embedded answers".
"""

from __future__ import annotations

import base64
import html
import re
import xml.etree.ElementTree as ET
from collections.abc import Iterable, Iterator
from decimal import ROUND_CEILING

from replicate.exhibits.variants import Answer
from replicate.handout.marking_key import accepted_ends, plain_decimals
from replicate.handout.question_texts import Texts, picture_name, texts_of
from replicate.handout.questions import Question, different, drawings_in
from replicate.handout.tree import Blocks

_PENALTY = "0.1"  # Moodle's own
_NUMERICAL = {"unitgradingtype": "0", "unitpenalty": "0.1", "showunits": "3", "unitsleft": "0"}  # no units asked for
_ESSAY = {
    "responseformat": "editorfilepicker",
    "responserequired": "0",
    "responsefieldlines": "15",
    "attachments": "-1",
    "attachmentsrequired": "0",
}


def moodle_xml(questions: Iterable[Question]) -> bytes:
    """Return a file that Moodle imports as format "Moodle XML".

    Parameters
    ----------
    questions
        Of any number of forms; equal ones, of exercises that do not vary, are written once.
    """
    chosen = different(questions)
    quiz = ET.Element("quiz")
    category = ""
    for question, texts in zip(
        chosen, texts_of(chosen, lambda _, name: f"@@PLUGINFILE@@/{name}", "--mathjax"), strict=True
    ):
        course = f"$course$/top/{question.document.title.replace('/', '//')}"
        here = f"{course}/{question.number} {question.title.replace('/', '//')}"
        if here != category:
            category = here
            head = ET.SubElement(quiz, "question", type="category")
            _text(head, "category", category)
            _text(head, "info", f"{question.document.paper.citation}", format="plain_text")
        quiz.append(_question(question, texts))
    ET.indent(quiz, " ")
    return b'<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(quiz, encoding="unicode").encode() + b"\n"


def _question(question: Question, texts: Texts) -> ET.Element:
    kind = {0: "essay", 1: "numerical"}.get(len(question.answers), "cloze")
    out = ET.Element("question", type=kind)
    form = "" if question.variant == "0" else f" ({question.variant})"
    _text(out, "name", f"{question.title}{form}")
    asked = texts.text
    if kind == "numerical":
        ((name, answer),) = question.answers.items()
        asked += f"<p>{texts.labels[name]}{f' ({html.escape(answer.unit)})' if answer.unit else ''}</p>\n"
    elif kind == "cloze":
        weight = _weight(question)
        asked += "".join(
            f"<p>{texts.labels[name]} = {{{weight}:NUMERICAL:{_cloze(answer)}}} {html.escape(answer.unit)}</p>\n"
            for name, answer in question.answers.items()
        )
    _files(_text(out, "questiontext", asked, format="html"), question, question.text)
    _files(_text(out, "generalfeedback", texts.solution, format="html"), question, question.solution)
    if kind != "cloze":  # the weights of its parts say it there
        ET.SubElement(out, "defaultgrade").text = f"{question.points or 1:g}"
    ET.SubElement(out, "penalty").text = _PENALTY if question.answers else "0"
    ET.SubElement(out, "hidden").text = "0"
    ET.SubElement(out, "idnumber").text = question.id
    if kind == "numerical":
        for fraction, value, tolerance, feedback in _accepted(next(iter(question.answers.values()))):
            found = ET.SubElement(out, "answer", fraction=str(fraction), format="moodle_auto_format")
            ET.SubElement(found, "text").text = value
            _text(found, "feedback", html.escape(feedback, quote=False), format="html")
            ET.SubElement(found, "tolerance").text = tolerance
        _settings(out, _NUMERICAL)
    if kind == "essay":
        _settings(out, _ESSAY)
        _files(_text(out, "graderinfo", texts.solution, format="html"), question, question.solution)
    return out


def _accepted(answer: Answer) -> Iterator[tuple[int, str, str, str]]:
    """Yield grade in per cent, value, tolerance and feedback: the exact answer, all that is accepted, the mistakes.

    Moodle takes the first that fits.
    """
    lower, upper = (float(end) for end in accepted_ends(answer))
    near, far = sorted((answer.value - lower, upper - answer.value))
    centre = (lower + upper) / 2
    if answer.carried and plain_decimals(centre) != plain_decimals(answer.value):
        yield 100, *_within(answer.value, near), ""
        yield 100, *_within(centre, (upper - lower) / 2), ""
    else:
        yield 100, *_within(answer.value, far), ""
    for words, value in answer.mistakes.items():
        yield 0, *_within(value, answer.margin(value)), f"{words}?"


def _within(value: float, distance: float) -> tuple[str, str]:
    """Return a value with few digits, and the tolerance that takes in all that is so near to the exact one."""
    text = plain_decimals(value)
    return text, plain_decimals(distance + abs(float(text) - value), ROUND_CEILING)


def _cloze(answer: Answer) -> str:
    """Return what is accepted in Moodle's notation of embedded answers."""
    parts = []
    for fraction, value, tolerance, feedback in _accepted(answer):
        words = re.sub(r'([\\~}#"/])', r"\\\1", html.escape(feedback, quote=False))
        parts.append(f"{'=' if fraction else '%0%'}{value}:{tolerance}{f'#{words}' if words else ''}")
    return "~".join(parts)


def _weight(question: Question) -> int:
    """Return the weight of each part; Moodle takes whole numbers only."""
    share = (question.points or 0) / len(question.answers)
    return int(share) if share >= 1 and share == int(share) else 1


def _settings(parent: ET.Element, settings: dict[str, str]) -> None:
    for tag, value in settings.items():
        ET.SubElement(parent, tag).text = value


def _text(parent: ET.Element, tag: str, text: str, **attributes: str) -> ET.Element:
    out = ET.SubElement(parent, tag, attributes)
    ET.SubElement(out, "text").text = text
    return out


def _files(parent: ET.Element, question: Question, blocks: Blocks) -> None:
    """Put the figures of a text beside it, and beside the question its files."""
    pictures = {picture_name(one): one.png for one in drawings_in(blocks, question.document)}
    data = {name: text.encode() for name, text in question.files.items()} if blocks is question.text else {}
    for name, content in {**pictures, **data}.items():
        found = ET.SubElement(parent, "file", name=name, path="/", encoding="base64")
        found.text = base64.b64encode(content).decode()
