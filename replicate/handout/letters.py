"""The letters that a printed handout can show: Libertinus, and behind it DejaVu Sans, which matplotlib carries.

Typst sets an empty box for a letter that no font has, and says nothing. Here it is named with its line.
"""

from __future__ import annotations

import unicodedata
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from replicate.errors import TemplateError
from replicate.plain_text import read_text

if TYPE_CHECKING:
    from replicate.handout.edition import Document

_FALLBACK = "DejaVuSans.ttf"


def fonts_dir() -> Path:
    """Return the folder of the fonts that matplotlib carries."""
    import matplotlib as mpl

    return Path(mpl.get_data_path()) / "fonts" / "ttf"


@cache
def _letters() -> frozenset[int]:
    from fontTools.ttLib import TTFont

    with TTFont(fonts_dir() / _FALLBACK) as font:
        return frozenset(font.getBestCmap())


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
    unknown = {letter for letter in set(text) if _is_shown(letter) and ord(letter) not in _letters()}
    if not unknown:
        return
    missing = next(letter for letter in text if letter in unknown)
    source = read_text(document.paper.folder() / Path(name).name, name, TemplateError)
    place = f"{name}:{source.count(chr(10), 0, source.index(missing)) + 1}" if missing in source else name
    words = f"U+{ord(missing):04X} {unicodedata.name(missing, '')}".strip()
    msg = f"{place}: no font at hand has the letter '{missing}' ({words}); a web page (--format html) can show it"
    raise TemplateError(msg)


def can_be_set(text: str) -> bool:
    """Whether the fonts at hand have all letters of a text."""
    return all(ord(letter) in _letters() for letter in text if _is_shown(letter))


def _is_shown(letter: str) -> bool:
    """Whether it is a letter or a pictograph of a text; signs of formulas come from a font of their own."""
    code = ord(letter)
    return (unicodedata.category(letter)[0] == "L" and not 0x1D400 <= code <= 0x1D7FF) or code >= 0x1F000
