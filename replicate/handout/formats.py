"""The formats of handouts by the names that the command line has for them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

from replicate.errors import ReplicateError

if TYPE_CHECKING:
    from replicate.figures.off_screen import Kind
    from replicate.handout.edition import Document
    from replicate.handout.questions import Question

#: The story in pictures, one file for each paper, without exercises.
SLIDES = "slides"

#: The files of one edition: by what follows the edition's name in theirs, or by a whole name if it does not begin with
#: a dot or a hyphen.
Files = dict[str, bytes]


def _pdf(documents: Iterable[Document]) -> Iterator[Files]:
    from replicate.handout.edition import AT_ONCE
    from replicate.handout.printout import pdfs

    return ({".pdf": made} for made in pdfs(documents, AT_ONCE))


def _html(documents: Iterable[Document]) -> Iterator[Files]:
    from replicate.handout.webpage import webpage

    return ({".html": webpage(document).encode()} for document in documents)


def _ipynb(documents: Iterable[Document]) -> Iterator[Files]:
    from replicate.handout.notebook import notebook
    from replicate.handout.own_exercises import BESIDE, PROGRAM

    for document in documents:
        programs = {f"{BESIDE}/{own.name}/{PROGRAM}": own.program.encode() for own in document.sheet.own}
        yield {".ipynb": notebook(document)} | programs


def _docx(documents: Iterable[Document]) -> Iterator[Files]:
    from replicate.handout.editable import docx

    return ({".docx": docx(document)} for document in documents)


def _tex(documents: Iterable[Document]) -> Iterator[Files]:
    from replicate.handout.editable import tex

    return map(tex, documents)


def _typ(documents: Iterable[Document]) -> Iterator[Files]:
    from replicate.handout.editable import typ

    return ({".typ": typ(document)} for document in documents)


def _moodle(questions: Sequence[Question]) -> Files:
    from replicate.handout.moodle import moodle_xml

    return {"-moodle.xml": moodle_xml(questions)}


def _qti(questions: Sequence[Question]) -> Files:
    from replicate.handout.qti import qti_package

    return {"-qti.zip": qti_package(questions)}


#: Each writes editions of a handout, one after the other.
EDITIONS: dict[str, Callable[[Iterable[Document]], Iterator[Files]]] = {
    "pdf": _pdf,
    "html": _html,
    "ipynb": _ipynb,
    "docx": _docx,
    "tex": _tex,
    "typ": _typ,
}
#: The pictures that each of them places.
PICTURES: dict[str, Kind] = {
    "pdf": "svg",
    "html": "svg",
    "docx": "png",
    "tex": "svg",
    "typ": "svg",
    "ipynb": "png",
}
#: All exercises together, for a learning platform.
BANKS: dict[str, Callable[[Sequence[Question]], Files]] = {"moodle": _moodle, "qti": _qti}


def named(files: Files, stem: str) -> Files:
    """Return files by their whole names."""
    return {f"{stem}{name}" if name[0] in ".-" else name: content for name, content in files.items()}


def checked_format(text: str) -> str:
    """Return a format if there is one of that name.

    Raises
    ------
    ReplicateError
        If there is not.
    """
    known = [*EDITIONS, SLIDES, *BANKS]
    if text in known:
        return text
    msg = f"the format is '{text}', allowed: {', '.join(known)}"
    raise ReplicateError(msg)
