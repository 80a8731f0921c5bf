"""Slides: the story of a paper's error in a few pictures, as a PDF of the shape of a screen.

A paper's ``slides.md`` begins with its title and the first slide; each heading begins another. A slide has one figure,
which takes the room that its words leave. The PDF claims PDF/UA-1, as handouts do.
"""

from __future__ import annotations

from replicate.errors import TemplateError
from replicate.handout.edition import Document
from replicate.handout.printout import markups, typeset
from replicate.handout.tree import Blocks, classes, elements, text_of

LOOK = "slides.typ"
FEWEST, MOST = 5, 8  # slides


def slides(document: Document) -> bytes:
    """Return the slides as PDF.

    Raises
    ------
    TemplateError
        If they are too few or too many, one has no figure or several, or its words and figure do not fit.
    """
    _check(document)
    return typeset(document, markups([document], LOOK)[0], LOOK)


def _check(document: Document) -> None:
    found = _parts(document)
    if not FEWEST <= len(found) <= MOST:
        msg = f"{document.source}: {len(found)} slides, allowed: {FEWEST} to {MOST}; each heading begins one"
        raise TemplateError(msg)
    for name, blocks in found:
        count = sum("drawing" in classes(element) for element in elements(blocks))
        if count != 1:
            msg = f"{document.source}: the slide '{name}' has {count or 'no'} figures, allowed: one"
            raise TemplateError(msg)
        other = next((element for element in elements(blocks) if element["t"] in {"Table", "Header"}), None)
        if other is not None:
            what = "a table" if other["t"] == "Table" else "a heading below its own"
            msg = f"{document.source}: the slide '{name}' has {what}; a slide has words and one figure"
            raise TemplateError(msg)


def _parts(document: Document) -> list[tuple[str, Blocks]]:
    """Return the slides with their names; the first has that of the document."""
    found: list[tuple[str, Blocks]] = [(document.title, [])]
    for block in document.blocks:
        if block["t"] == "Header" and block["c"][0] == 1:
            found.append((" ".join(text_of(block["c"][2]).split()), []))
        else:
            found[-1][1].append(block)
    return found
