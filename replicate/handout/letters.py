"""The letters that a printed handout can show: Libertinus, and behind it the fonts of `replicate.figures.fonts`.

Typst sets an empty box for a letter that no font has, and says nothing. Here it is named with its line.
"""

from __future__ import annotations

import unicodedata
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from replicate.errors import TemplateError
from replicate.figures.fonts import FALLBACKS
from replicate.plain_text import read_text

if TYPE_CHECKING:
    import typst

    from replicate.handout.edition import Document

_MAIN = "Libertinus Serif"  # inside the typst package


#: For a template of Typst, as its input ``fonts``.
FAMILIES = ",".join((_MAIN, *(font.family for font in FALLBACKS)))


@cache
def fonts() -> typst.Fonts:
    """Return the fonts for Typst, and none of the system."""
    import typst

    paths = [str(font.path.parent) for font in FALLBACKS]
    return typst.Fonts(include_system_fonts=False, include_embedded_fonts=True, font_paths=paths)


def check_letters(text: str, document: Document, name: str) -> None:
    """Refuse a handout with a letter that no font at hand has.

    Parameters
    ----------
    text
        All that is typeset.
    name
        What messages call the handout's file.

    Raises
    ------
    TemplateError
        With the line of the file in which the first such letter stands, if it is from there.
    """
    missing = _missing(text)
    if not missing:
        return
    source = read_text(document.paper.folder() / Path(name).name, name, TemplateError)
    place = f"{name}:{source.count(chr(10), 0, source.index(missing)) + 1}" if missing in source else name
    words = f"U+{ord(missing):04X} {unicodedata.name(missing, '')}".strip()
    msg = f"{place}: no font at hand has the letter '{missing}' ({words}); a web page (--format html) can show it"
    raise TemplateError(msg)


def can_be_set(text: str) -> bool:
    """Whether the fonts at hand have all letters of a text."""
    return not _missing(text)


def _missing(text: str) -> str:
    """Return the first letter that no font at hand has, or nothing."""
    unknown = {letter for letter in set(text) if _is_shown(letter)}
    for font in FALLBACKS:  # the next one is read only if there is need
        if not unknown:
            return ""
        unknown = {letter for letter in unknown if ord(letter) not in font.letters()}
    return next((letter for letter in text if letter in unknown), "")


def _is_shown(letter: str) -> bool:
    """Whether it is a letter or a pictograph of a text; signs of formulas come from a font of their own."""
    code = ord(letter)
    return (unicodedata.category(letter)[0] == "L" and not 0x1D400 <= code <= 0x1D7FF) or code >= 0x1F000
