"""Texts as the outlines of their letters: each is read, measured and drawn out once, however often it is asked for.

What costs most in laying a figure out, and much of drawing it, is to read ``$...$``, to find the fonts of a text and to
ask them how high a line is. What has been found is remembered for as long as the process lives.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from matplotlib.font_manager import fontManager, get_font
from matplotlib.mathtext import MathTextParser
from matplotlib.textpath import TextToPath

if TYPE_CHECKING:
    from matplotlib.mathtext import VectorParse

    _PathParser = MathTextParser[VectorParse]
else:
    _PathParser = MathTextParser

#: Points to the inch: the resolution of an SVG.
POINTS = 72

_MOST_REMEMBERED = 20_000
_SETTINGS = ("mathtext.", "font.", "text.")
# The tables of a font that say how high its lines are, and by what names; matplotlib asks them in this order, too.
_LINES = (("OS/2", "sTypoAscender", "sTypoDescender", "sTypoLineGap"), ("hhea", "ascent", "descent", "lineGap"))


class _Memory:
    """What has been found, for as long as the settings and the fonts stay what they are."""

    def __init__(self) -> None:
        self._settings: tuple[str, ...] = ()
        self._found: dict[Hashable, Any] = {}

    def once(self, key: Hashable, find: Callable[[], Any]) -> Any:
        """Return what is remembered under a key; find it if it is the first time."""
        if key not in self._found:
            self._found[key] = find()
        return self._found[key]

    def settle(self) -> None:
        """Forget what was found with other settings."""
        settings = tuple(f"{name}: {value}" for name, value in mpl.rcParams.items() if name.startswith(_SETTINGS))
        settings = (*settings, f"fonts: {len(fontManager.ttflist)}")
        if settings != self._settings or len(self._found) > _MOST_REMEMBERED:
            self._settings = settings
            self._found.clear()


class _Parser(_PathParser):
    """Reads mathematical text once, at whatever size it is drawn."""

    def __init__(self, memory: _Memory) -> None:
        super().__init__("path")
        self._memory = memory

    def parse(self, s: str, dpi: float = POINTS, prop: Any = None, **options: Any) -> Any:
        key = ("read", s, dpi, None if prop is None else prop.copy(), *options.values())
        return self._memory.once(key, lambda: super(_Parser, self).parse(s, dpi, prop, **options))


class Outlines(TextToPath):
    """Draws out texts, and measures them."""

    def __init__(self) -> None:
        super().__init__()
        self._memory = _Memory()
        self.settle = self._memory.settle
        self.mathtext_parser = _Parser(self._memory)

    def _get_font(self, prop: Any) -> Any:
        find = fontManager._find_fonts_by_props  # noqa: SLF001
        font = get_font(self._memory.once(("fonts", prop.copy()), lambda: find(prop)))
        font.set_size(self.FONT_SCALE, self.DPI)
        return font

    def get_text_width_height_descent(self, s: str, prop: Any, ismath: Any) -> tuple[float, float, float]:
        """Return width, height and depth, in points."""
        measure = super().get_text_width_height_descent
        found: tuple[float, float, float] = self._memory.once(
            ("size", s, prop.copy(), ismath), lambda: measure(s, prop, ismath)
        )
        return found

    def get_text_path(self, prop: Any, s: str, ismath: Any = False, **options: Any) -> Any:
        """Return vertices and codes of the letters, `TextToPath.FONT_SCALE` points high."""
        draw = super().get_text_path
        if any(options.values()):
            return draw(prop, s, ismath, **options)

        def drawn() -> Any:
            vertices, codes = draw(prop, s, ismath, **options)
            return np.array(vertices), np.array(codes, dtype=np.uint8)

        return self._memory.once(("path", s, prop.copy(), ismath), drawn)

    def line_height(self, prop: Any, dpi: float) -> tuple[float | None, float | None, float | None]:
        """Return how far a line reaches up and down, and the gap between two, in pixels; none if the font is silent."""
        found: tuple[float | None, float | None, float | None] = self._memory.once(
            ("line", prop.copy(), dpi), lambda: _line_height(self._get_font(prop), prop.get_size_in_points() * dpi)
        )
        return found


def _line_height(font: Any, size: float) -> tuple[float | None, float | None, float | None]:
    for name, up, down, gap in _LINES:
        table = font.get_sfnt_table(name)
        if table is not None:
            scale = size / POINTS / font.get_sfnt_table("head")["unitsPerEm"]
            return table[up] * scale, -table[down] * scale, table[gap] * scale
    return None, None, None
