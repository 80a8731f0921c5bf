"""A handout as PDF: pandoc writes Typst, the template `handout.typ` gives it its look, Typst sets it.

The PDF is tagged and claims PDF/UA-1, the standard for accessible documents; Typst refuses to write one that
lacks what the standard asks for (title, language, words for figures and formulas, an order of headings).
Only fonts that packages carry are used, and nothing tells the time: the same handout is the same bytes.
"""

from __future__ import annotations

import io
import os
import re
import tempfile
from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from functools import partial
from itertools import islice, zip_longest
from pathlib import Path
from typing import Any

import segno
import typst

import replicate
from replicate.errors import TemplateError
from replicate.handout.edition import Document
from replicate.handout.letters import FAMILIES, check_letters, fonts
from replicate.handout.pandoc import written
from replicate.handout.reading import BLOCKS
from replicate.handout.row_heads import with_row_heads
from replicate.handout.tree import (
    Blocks,
    Element,
    attribute,
    classes,
    div,
    elements,
    raw_block,
    raw_inline,
    transform,
)
from replicate.resources import templates_dir

TEMPLATE = "handout.typ"
FORM = "form.svg"  # its id, for a camera

# Functions of the template, by the class of a Div or Span.
_BEFORE = "before-drawing"
_BLOCKS = {*BLOCKS, _BEFORE}
_SPANS = {"number", "tool", "printed", "computed", "over-badge", "over-sign"}
_MOST_THREADS = 4
_LONG = 15  # rows; a table with more of them may break across pages, and repeats its head
_SIGNS = {"badge", "sign"}  # these also say which verdict or match they stand for


def pdf(document: Document) -> bytes:
    """Return the PDF.

    Raises
    ------
    TemplateError
        If Typst cannot set the document, or sets it with a warning.
    """
    return next(pdfs([document]))


def pdfs(documents: Iterable[Document], at_once: int = 1) -> Iterator[bytes]:
    """Yield the PDFs of documents in their order; while Typst sets some, pandoc writes the next ones.

    Parameters
    ----------
    documents
        Editions of one handout, whose tables are the same.
    at_once
        How many documents pandoc writes in one call.

    Raises
    ------
    TemplateError
        If Typst cannot set one of them, or sets it with a warning.
    """
    threads = min(os.cpu_count() or 1, _MOST_THREADS)  # Typst lets go of the interpreter
    with ThreadPoolExecutor(threads) as pool:
        under_way: deque[Future[bytes]] = deque()
        first = True
        for some in _batches(documents, at_once):
            for document, text in zip(some, markups(some), strict=True):
                under_way.append(pool.submit(typeset, document, text, tables_fit=not first))
                first = False
            while len(under_way) > at_once:
                yield under_way.popleft().result()
        while under_way:
            yield under_way.popleft().result()


def _batches(documents: Iterable[Document], size: int) -> Iterator[list[Document]]:
    waiting = iter(documents)
    while some := list(islice(waiting, size)):
        yield some


def typeset(document: Document, text: str, look: str = TEMPLATE, *, tables_fit: bool = False) -> bytes:
    """Return the PDF of a document from its Typst source.

    Parameters
    ----------
    look
        The template that the source imports.
    tables_fit
        Whether its tables are known to be no wider than the text: a quarter of the time goes into measuring them.

    Raises
    ------
    TemplateError
        If Typst cannot set the document, or sets it with a warning.
    """
    name = document.source
    check_letters(text, document, name)
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        template = (templates_dir() / look).read_text(encoding="utf-8")
        (root / look).write_text(template, encoding="utf-8")
        if document.form:
            (root / FORM).write_bytes(form_code(document.form))
        for drawing in document.drawings.values():
            (root / f"{drawing.name}.svg").write_text(drawing.svg, encoding="utf-8")
        main = root / "main.typ"
        main.write_text(text, encoding="utf-8")
        try:
            known = {"fonts": FAMILIES} | ({"tables": "fit"} if tables_fit else {})
            compiler = typst.Compiler(str(main), root=str(root), font_paths=fonts(), sys_inputs=known)
            made, warnings = compiler.compile_with_warnings(format="pdf", pdf_standards=["ua-1"])
        except typst.TypstError as error:
            raise _failed(name, error, text) from error
    if warnings:
        raise _failed(name, warnings[0], text)
    assert isinstance(made, bytes)  # noqa: S101  -- for the type checker: one PDF, not a list of pages
    rows = sum(len(_rows(element)) for element in elements(document.blocks) if element["t"] == "Table")
    try:
        return with_row_heads(made, rows)
    except ValueError as error:
        msg = f"{name}: {error}"
        raise TemplateError(msg) from error


def markup(document: Document) -> str:
    """Return the Typst source of a handout."""
    return markups([document])[0]


def markups(documents: Sequence[Document], look: str = TEMPLATE) -> list[str]:
    """Return the Typst sources of handouts, written by one call of pandoc: what they share, once."""
    whole = (transform(_with_words_before_drawings(one.blocks), partial(_for_typst, document=one)) for one in documents)
    pieces = [[[block] for block in blocks] for blocks in whole]
    made = iter(written([block for blocks in pieces for block in blocks], "typst"))
    return [
        head(one, look) + "\n".join(islice(made, len(blocks))) for one, blocks in zip(documents, pieces, strict=True)
    ]


def head(document: Document, look: str = TEMPLATE) -> str:
    """Return the Typst source before the text: the template and what it is to say."""
    paper, sheet = document.paper, document.sheet
    settings = {
        "title": document.title,
        "citation": paper.citation,
        "authors": ", ".join(paper.authors),
        "software": f"replicate {replicate.__version__}",
        "date": sheet.date,
        "text-lang": document.language.tag,
        "text-region": document.language.region,
        "lang": sheet.language.tag,
        "region": sheet.language.region,
    }
    arguments = [f"{key}: {quoted(value)}" for key, value in settings.items()]
    arguments.append(f"solutions: {'true' if document.solutions else 'false'}")
    form = f"#metadata({quoted(document.form)}) <form>\n" if document.form else ""
    words = ", ".join(f"{quoted(name)}: {quoted(word)}" for name, word in sheet.language.words.items())
    arguments.append(f"words: ({words})")
    whole = look.partition(".")[0]  # the function that the template is named after
    return f'#import "{look}": *\n#show: {whole}.with({", ".join(arguments)})\n\n{form}'


def form_code(form: str) -> bytes:
    """Return the id of a form as a QR code, an SVG that tells no time."""
    out = io.BytesIO()
    segno.make(form, micro=False, error="m", boost_error=False).save(
        out, kind="svg", border=0, xmldecl=False, svgns=True, nl=False
    )
    return out.getvalue()


def quoted(text: str) -> str:
    r"""Return a text as a string of Typst.

    Examples
    --------
    >>> print(quoted('a "b" \\ c'))
    "a \"b\" \\ c"
    """
    escaped = " ".join(text.split()).replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'


def _rows(table: Element) -> list[Any]:
    """Return the rows of a table of pandoc's tree, those of its head not among them."""
    body = table["c"][4][0]
    return list(body[3])


def _with_words_before_drawings(blocks: Blocks) -> Blocks:
    """Return blocks in which a paragraph right before a drawing is marked to stay on its page."""
    out: Blocks = []
    for block, after in zip_longest(blocks, blocks[1:]):
        if block["t"] == "Div":
            out.append({**block, "c": [block["c"][0], _with_words_before_drawings(block["c"][1])]})
        elif block["t"] == "Para" and after and "drawing" in classes(after):
            out.append(div([block], _BEFORE))
        else:
            out.append(block)
    return out


def _for_typst(element: Element, document: Document) -> list[Element] | None:
    """Replace what pandoc has no Typst for by calls of the template's functions."""
    match element["t"]:
        case "Math":
            kind, tex = element["c"]
            displayed = kind["t"] == "DisplayMath"
            formula = document.formulas[displayed, tex]
            call = f"#formula({quoted(formula.words)}, {formula.typst}{', block: true' if displayed else ''});"
            return [raw_inline("typst", call)]
        case "Span":
            found = classes(element)
            if found and found[0] in _SIGNS:
                bare = ", bare: true" if "bare" in found else ""  # in a sentence, not behind a number
                call = f"{found[0]}({quoted(found[-1])}{bare})"
            elif found and found[0] in _SPANS:
                call = found[0]
            else:
                return None
            return [raw_inline("typst", f"#{call}["), *element["c"][1], raw_inline("typst", "];")]
        case "Div":
            return _block(element, document)
    return None


def _block(element: Element, document: Document) -> Blocks | None:
    found, content = classes(element), element["c"][1]
    if "drawing" in found:
        drawing = document.drawings[attribute(element, "name")]
        call = f"#drawing({quoted(f'{drawing.name}.svg')}, {quoted(drawing.alt)}, {drawing.width:g})["
        if not content:
            return [raw_block("typst", f"{call}]")]
        return [raw_block("typst", call), *content, raw_block("typst", "]")]
    if "exhibit" in found:
        table, *caption = content
        long = "true" if len(_rows(table)) > _LONG else "false"
        group = max(cell[3] for cell in table["c"][3][1][0][1])  # columns under one head
        return [
            raw_block("typst", f"#exhibit({quoted(attribute(element, 'name'))}, {long}, {group})["),
            table,
            raw_block("typst", "]["),
            *caption,
            raw_block("typst", "]"),
        ]
    if "caption" in found:
        return list(content)
    known = next(name for name in found if name in _BLOCKS)
    return [raw_block("typst", f"#{known}["), *content, raw_block("typst", "]")]


def _failed(name: str, error: typst.TypstError | typst.TypstWarning, text: str) -> TemplateError:
    """Return an error with Typst's message and the line of its source that it is about."""
    found = re.search(r"main\.typ:(\d+):", error.diagnostic)
    about = f": '{text.splitlines()[int(found[1]) - 1].strip()[:80]}'" if found else ""
    hints = f" ({'; '.join(error.hints)})" if error.hints else ""
    return TemplateError(f"{name}: cannot be typeset: {error.message}{hints}{about}")
