"""A handout as a source that can be edited: a Word document, LaTeX with its figures beside it, or Typst in one file."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Mapping
from pathlib import Path

import typst

import replicate
from replicate.display.pandoc import PandocError, run
from replicate.errors import TemplateError
from replicate.handout import pandoc
from replicate.handout.edition import Document
from replicate.handout.printout import FORM, TEMPLATE, form_code, markup, quoted
from replicate.handout.tree import (
    Blocks,
    Element,
    attribute,
    classes,
    plain,
    string,
    transform,
)
from replicate.resources import templates_dir

_DATE = "315532800"  # 1 January 1980, the first that a zip file can tell: a document tells no time
# What tables hold besides words and numbers: no font of pdfLaTeX has it.
_SIGNS = {
    "\N{FIGURE SPACE}": r"\phantom{0}",
    "\N{PUNCTUATION SPACE}": r"\phantom{.}",
    "✓": r"\ensuremath{\checkmark}",
    "≈": r"\ensuremath{\approx}",
    "≠": r"\ensuremath{\neq}",
    "∈": r"\ensuremath{\in}",
    "↻": r"\ensuremath{\circlearrowright}",
    "⊘": r"\ensuremath{\oslash}",
    "✎": r"\ensuremath{\dagger}",
    "\N{MINUS SIGN}": r"\ensuremath{-}",
}
_TEXT_WIDTH = 15.5  # cm, of a figure as wide as the text


def docx(document: Document) -> bytes:
    """Return a Word document; its formulas are equations of Word.

    Raises
    ------
    TemplateError
        If pandoc cannot write it.
    """
    pictures = {f"{name}.png": drawing.png for name, drawing in document.drawings.items()}
    return _pandoc(document, "docx", pictures)


def tex(document: Document) -> dict[str, bytes]:
    """Return a LaTeX document and its figures as PDF, by the names under which the document asks for them.

    Raises
    ------
    TemplateError
        If pandoc cannot write it.
    """
    stem = f"{document.paper.id}-{document.form.split(':')[1]}" if document.form else document.paper.id
    figures = {f"{stem}-{name}.pdf": figure_pdf(one.svg) for name, one in document.drawings.items()}
    made = _pandoc(document, "latex", figures, "--standalone", "-V", "geometry:margin=25mm", "-V", "papersize:a4")
    text = made.decode()
    for sign, command in _SIGNS.items():
        text = text.replace(sign, command)
    return {".tex": text.encode(), **figures}


def typ(document: Document) -> bytes:
    """Return a Typst document in one file: the template and the figures are in it."""
    template = (templates_dir() / TEMPLATE).read_text(encoding="utf-8")
    images = {f"{name}.svg": drawing.svg for name, drawing in document.drawings.items()}
    if document.form:
        images[FORM] = form_code(document.form).decode()
    _, _, body = markup(document).partition("\n")  # the first line imports the template
    text = f"{template}\n// ------------------------------------------------------------------ the text\n\n{body}"
    for name, svg in images.items():
        embedded = f"bytes({quoted(svg)})"
        text = text.replace(f'#drawing("{name}"', f"#drawing({embedded}").replace(
            f'image("{name}"', f"image({embedded}"
        )
    return text.encode()


def figure_pdf(svg: str) -> bytes:
    """Return a drawing as a PDF of its own size."""
    source = (
        f"#set document(date: none)\n#set page(width: auto, height: auto, margin: 0pt)\n#image(bytes({quoted(svg)}))\n"
    )
    made = typst.compile(source.encode(), format="pdf", ignore_system_fonts=True)
    assert isinstance(made, bytes)  # noqa: S101  -- for the type checker: one PDF, not a list of pages
    return made


def _pandoc(document: Document, target: str, files: Mapping[str, bytes], *options: str) -> bytes:
    tree = pandoc.document(_prepared(document, dict(zip(document.drawings, files, strict=True))))
    tree["meta"] = {
        "title": _inline(document.title),
        "lang": _inline(document.language.code),
        "keywords": {"t": "MetaList", "c": [_inline(f"replicate {replicate.__version__}")]},
    } | ({"date": _inline(document.sheet.date)} if document.sheet.date else {})
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        for name, content in files.items():
            (root / name).write_bytes(content)
        command = ["--from=json", f"--to={target}", "--output=made", "--fail-if-warnings", *options]
        try:
            run(command, json.dumps(tree).encode(), root, {"SOURCE_DATE_EPOCH": _DATE})
        except PandocError as error:
            msg = f"{document.paper.id}: pandoc cannot write {target}: {' '.join(str(error).split())}"
            raise TemplateError(msg) from error
        return (root / "made").read_bytes()


def _prepared(document: Document, files: Mapping[str, str]) -> Blocks:
    """Return the text with its figures as images, and words where a colour or a place says something."""

    def changed(element: Element) -> list[Element] | None:
        found = classes(element)
        if element["t"] == "Div" and "drawing" in found:
            drawing = document.drawings[attribute(element, "name")]
            width = [["width", f"{_TEXT_WIDTH * drawing.width:.1f}cm"]]
            image = {"t": "Image", "c": [["", [], width], [string(drawing.alt)], [files[drawing.name], ""]]}
            return [{"t": "Para", "c": [image]}, *element["c"][1]]
        if element["t"] == "Div" and "solution" in found:
            label = plain([{"t": "Strong", "c": [string(document.sheet.language["solution"])]}])
            return [{"t": "BlockQuote", "c": [label, *element["c"][1]]}]
        if element["t"] == "Span" and found and found[0] == "tool":
            return [{"t": "Emph", "c": [string("("), *element["c"][1], string(")")]}]
        if element["t"] == "Span":
            return list(element["c"][1])
        if element["t"] == "Div":
            return [*element["c"][1]]
        return None

    blocks: Blocks = transform(document.blocks, changed)
    source = {"t": "Para", "c": [string(f"{document.sheet.language['paper']}: {document.paper.citation}")]}
    form = f"{document.sheet.language['form']} {document.form}"
    return [source, *([{"t": "Para", "c": [string(form)]}] if document.form else []), *blocks]


def _inline(text: str) -> Element:
    return {"t": "MetaInlines", "c": [string(text)]}
