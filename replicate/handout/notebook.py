"""A handout as a Jupyter notebook: text, programs as cells, and cells that check answers without holding them."""

from __future__ import annotations

import base64
import html
import json
import re
from collections.abc import Iterator
from typing import Any

from replicate.handout.edition import Document
from replicate.handout.own_exercises import with_own
from replicate.handout.pandoc import written
from replicate.handout.placing import exercises_of
from replicate.handout.tree import (
    Blocks,
    Element,
    attribute,
    classes,
    raw_block,
    string,
    transform,
)

_MARKDOWN = "commonmark+tex_math_dollars+pipe_tables+raw_html"


def notebook(document: Document) -> bytes:
    """Return the notebook, of format 4.5; it holds no outputs, the programs have not run in it.

    Each exercise with numbers has a cell for its answers, which asks `replicate.handout.checking` about them.
    """
    cells = [*_cells(document)]
    texts = iter(written([content for kind, content in cells if kind == "markdown"], _MARKDOWN, raw="markdown"))
    found = []
    for number, (kind, content) in enumerate(cells, start=1):
        text = next(texts).strip() if kind == "markdown" else str(content)
        cell: dict[str, Any] = {"cell_type": kind, "id": f"cell-{number}", "metadata": {}}
        if kind == "code":
            cell |= {"execution_count": None, "outputs": []}
        else:
            pictures = re.findall(r'src="attachment:([^"]+)\.png"', text)
            if pictures:
                cell["attachments"] = {
                    f"{name}.png": {"image/png": base64.b64encode(document.drawings[name].png).decode()}
                    for name in pictures
                }
        cell["source"] = text.splitlines(keepends=True)
        found.append(cell)
    made = {
        "cells": found,
        "metadata": {
            "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
            "language_info": {"name": "python"},
            "title": document.title,
        },
        "nbformat": 4,
        "nbformat_minor": 5,
    }
    return (json.dumps(made, ensure_ascii=False, indent=1) + "\n").encode()


def _cells(document: Document) -> Iterator[tuple[str, Any]]:
    """Yield kind and content: a tree for text, source for programs."""
    words = document.sheet.language
    head = [_heading(1, document.title), _paragraph(f"{words['paper']}: {document.paper.citation}")]
    if document.form:
        head.append(_paragraph(f"{words['form']}: {document.form}"))
    yield "markdown", [*head, *([_paragraph(document.sheet.date)] if document.sheet.date else [])]
    exercises = with_own(exercises_of(document.paper), document.sheet.own)
    form = f", {document.form!r}" if document.form else ""
    own = f", own={tuple(one.name for one in document.sheet.own)!r}" if document.sheet.own else ""
    yield (
        "code",
        f"from replicate.handout.checking import Checker\n\ncheck = Checker({document.paper.id!r}{form}{own})",
    )
    text: Blocks = []
    for block in document.blocks:
        if "exercise" not in classes(block):
            text.append(block)
            continue
        yield from _split(text, document)
        text = []
        questions = [part for part in block["c"][1] if "solution" not in classes(part)]
        yield from _split(questions, document)
        name = attribute(block, "vary")
        if name:
            asked = exercises.variations[name].answers(exercises.variations[name].original)
            lines = "".join(f"    {part!r}: None,\n" for part in asked)
            yield "code", f"# {words['answer']}\nanswers = {{\n{lines}}}\ncheck({name!r}, answers)"
        if attribute(block, "plot"):
            yield "code", f"# check.plot({attribute(block, 'plot')!r}, figure)"
        for solution in (part for part in block["c"][1] if "solution" in classes(part)):
            yield from _split([_paragraph(words["solution"]), *solution["c"][1]], document)
    yield from _split(text, document)


def _split(blocks: Blocks, document: Document) -> Iterator[tuple[str, Any]]:
    """Yield text and programs apart; what a program wrote when the handout was made is left to the notebook."""
    text: Blocks = []
    for block in blocks:
        if block["t"] != "CodeBlock":
            text.append(block)
            continue
        names = classes(block)
        if "output" in names:
            continue
        if text:
            yield "markdown", _prepared(text, document)
            text = []
        yield ("code", block["c"][1]) if "python" in names else ("markdown", [block])
    if text:
        yield "markdown", _prepared(text, document)


def _prepared(blocks: Blocks, document: Document) -> Blocks:
    def changed(element: Element) -> list[Element] | None:
        if element["t"] == "Header":
            level, attributes, content = element["c"]
            return [{"t": "Header", "c": [min(level + 1, 6), attributes, content]}]
        if element["t"] == "Div" and "drawing" in classes(element):
            name = attribute(element, "name")
            alt = html.escape(document.drawings[name].alt)
            return [raw_block("markdown", f'<img src="attachment:{name}.png" alt="{alt}">'), *element["c"][1]]
        if element["t"] in {"Div", "Span"}:
            return list(element["c"][1])
        return None

    out: Blocks = transform(blocks, changed)
    return out


def _heading(level: int, text: str) -> Element:
    return {"t": "Header", "c": [level, ["", [], []], [string(text)]]}


def _paragraph(text: str) -> Element:
    return {"t": "Para", "c": [string(text)]}
