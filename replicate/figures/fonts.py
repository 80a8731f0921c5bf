"""Fonts of many scripts that packages carry, behind the first font of figures and handouts: everywhere the same."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from importlib.util import find_spec
from pathlib import Path


@dataclass(frozen=True)
class Font:
    """A font of a package.

    Attributes
    ----------
    family
        Its name.
    package
        The one that carries it.
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
        """Where it lies."""
        return Path(str(files(self.package))) / self.file

    @cache  # noqa: B019  -- there are few, and they live as long as the process
    def letters(self) -> frozenset[int]:
        """Return the code points of which it has a letter."""
        from fontTools.ttLib import TTFont

        with TTFont(self.path, fontNumber=self.number, lazy=True) as font:
            return frozenset(font.getBestCmap())


def _noto(script: str) -> Font:
    """Return the font of a script from a package that carries nothing else."""
    package = f"fontpkg_noto_sans_{script.lower()}"
    return Font(f"Noto Sans {script}", package, f"files/NotoSans{script}[wdth,wght].ttf")


# In the order in which they are tried. DejaVu has Arabic, Armenian, Cyrillic, Georgian, Greek, Hebrew, Lao and Latin.
_KNOWN = (
    Font("DejaVu Sans", "matplotlib", "mpl-data/fonts/ttf/DejaVuSans.ttf"),
    Font("Noto Sans CJK SC", "noto_cjk_sans_otc", "NotoSansCJK-Regular.ttc", 2),
    *map(_noto, ("Devanagari", "Khmer", "Tamil", "Telugu", "Thai")),
)
#: Those that are installed.
FALLBACKS = tuple(font for font in _KNOWN if find_spec(font.package))  # a distribution may leave the large ones out


@cache
def families() -> list[str]:
    """Return the names by which matplotlib finds them, once it knows their files."""
    from matplotlib.font_manager import fontManager

    for font in FALLBACKS:
        fontManager.addfont(font.path)
    known = set(fontManager.get_font_names())
    return [font.family for font in FALLBACKS if font.family in known]
