"""The letters that a printed handout can show: Libertinus, and behind it fonts of many scripts that packages carry.

Typst sets an empty box for a letter that no font has, and says nothing. Here it is named with its line.
"""

from __future__ import annotations

import unicodedata
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from replicate.errors import TemplateError
from replicate.plain_text import read_text

if TYPE_CHECKING:
    import typst

    from replicate.handout.edition import Document

_MAIN = "Libertinus Serif"  # inside the typst package


@dataclass(frozen=True)
class _Font:
    """A font of a package.

    Attributes
    ----------
    file
        In the package's folder.
    number
        In the file, if that is a collection.
    """

    family: str
    package: str
    file: str
    number: int = 0

    @property
    def path(self) -> Path:
        return Path(str(files(self.package))) / self.file

    @cache  # noqa: B019  -- there are few, and they live as long as the process
    def letters(self) -> frozenset[int]:
        from fontTools.ttLib import TTFont

        with TTFont(self.path, fontNumber=self.number, lazy=True) as font:
            return frozenset(font.getBestCmap())


def _noto(script: str) -> _Font:
    """Return the font of a script from a package that carries nothing else."""
    package = f"fontpkg_noto_sans_{script.lower()}"
    return _Font(f"Noto Sans {script}", package, f"files/NotoSans{script}[wdth,wght].ttf")


# In the order in which they are tried. DejaVu has Arabic, Armenian, Cyrillic, Georgian, Greek, Hebrew, Lao and Latin.
_KNOWN = (
    _Font("DejaVu Sans", "matplotlib", "mpl-data/fonts/ttf/DejaVuSans.ttf"),
    _Font("Noto Sans CJK SC", "noto_cjk_sans_otc", "NotoSansCJK-Regular.ttc", 2),
    *map(_noto, ("Devanagari", "Khmer", "Tamil", "Telugu", "Thai")),
)
_FALLBACKS = tuple(font for font in _KNOWN if find_spec(font.package))  # a distribution may leave the large ones out

#: For a template of Typst, as its input ``fonts``.
FAMILIES = ",".join((_MAIN, *(font.family for font in _FALLBACKS)))


@cache
def fonts() -> typst.Fonts:
    """Return the fonts for Typst, and none of the system."""
    import typst

    paths = [str(font.path.parent) for font in _FALLBACKS]
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
    for font in _FALLBACKS:  # the next one is read only if there is need
        if not unknown:
            return ""
        unknown = {letter for letter in unknown if ord(letter) not in font.letters()}
    return next((letter for letter in text if letter in unknown), "")


def _is_shown(letter: str) -> bool:
    """Whether it is a letter or a pictograph of a text; signs of formulas come from a font of their own."""
    code = ord(letter)
    return (unicodedata.category(letter)[0] == "L" and not 0x1D400 <= code <= 0x1D7FF) or code >= 0x1F000
