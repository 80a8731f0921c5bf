"""The formats of handouts by the names that the command line has for them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from replicate.errors import ReplicateError

if TYPE_CHECKING:
    from replicate.handout.edition import Document
    from replicate.handout.questions import Question

#: The files of one edition: by what follows the edition's name in theirs, or by a whole name if it does not begin with
#: a dot or a hyphen.
Files = dict[str, bytes]


def _pdf(document: Document) -> Files:
    from replicate.handout.printout import pdf

    return {".pdf": pdf(document)}


def _html(document: Document) -> Files:
    from replicate.handout.webpage import webpage

    return {".html": webpage(document).encode()}


def _ipynb(document: Document) -> Files:
    from replicate.handout.notebook import notebook

    return {".ipynb": notebook(document)}


def _docx(document: Document) -> Files:
    from replicate.handout.editable import docx

    return {".docx": docx(document)}


def _tex(document: Document) -> Files:
    from replicate.handout.editable import tex

    return tex(document)


def _typ(document: Document) -> Files:
    from replicate.handout.editable import typ

    return {".typ": typ(document)}


def _moodle(questions: Sequence[Question]) -> Files:
    from replicate.handout.moodle import moodle_xml

    return {"-moodle.xml": moodle_xml(questions)}


def _qti(questions: Sequence[Question]) -> Files:
    from replicate.handout.qti import qti_package

    return {"-qti.zip": qti_package(questions)}


#: One edition of a handout each.
EDITIONS: dict[str, Callable[[Document], Files]] = {
    "pdf": _pdf,
    "html": _html,
    "ipynb": _ipynb,
    "docx": _docx,
    "tex": _tex,
    "typ": _typ,
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
    known = [*EDITIONS, *BANKS]
    if text in known:
        return text
    msg = f"the format is '{text}', allowed: {', '.join(known)}"
    raise ReplicateError(msg)
