"""The consoles of the command line.

Colours follow the terminal and ``NO_COLOR``. Where the output is not a terminal, lines are 100 columns wide
unless ``COLUMNS`` says otherwise.
"""

from __future__ import annotations

import os

from rich.console import Console, ConsoleOptions, ConsoleRenderable, RenderHook, RenderResult
from rich.segment import Segment
from rich.table import Table as Grid

from replicate.plain_text import visible

WIDTH = 100

_ENDLESS = 10_000


def console(*, stderr: bool = False) -> Console:
    """Return a console that prints texts as they are, without emoji codes or highlighting."""
    made = Console(stderr=stderr, highlight=False, emoji=False, soft_wrap=False)
    if not made.is_terminal and "COLUMNS" not in os.environ:
        made.width = WIDTH
    made.push_render_hook(_WrittenOut())
    return made


class _WrittenOut(RenderHook):
    """Writes out, in whatever is printed, the characters that would steer the terminal; colours are none of them."""

    def process_renderables(self, renderables: list[ConsoleRenderable]) -> list[ConsoleRenderable]:
        return [_Visible(renderable) for renderable in renderables]


class _Visible:
    def __init__(self, renderable: ConsoleRenderable) -> None:
        self._renderable = renderable

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        for segment in console.render(self._renderable, options):
            yield segment if segment.control else Segment(visible(segment.text), segment.style)


def print_whole(grid: Grid, console: Console) -> None:
    """Print a table as wide as it is: a number cut short would be another number."""
    width = console.width
    wide = console.options.update(max_width=_ENDLESS)
    console.width = max(width, console.measure(grid, options=wide).maximum)
    console.print(grid)
    console.width = width
