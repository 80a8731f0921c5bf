"""The consoles of the command line.

Colours follow the terminal and ``NO_COLOR``. Where the output is no terminal, lines are 100 columns wide
unless ``COLUMNS`` says otherwise.
"""

from __future__ import annotations

import os

from rich.console import Console
from rich.table import Table as Grid

WIDTH = 100

_ENDLESS = 10_000


def console(*, stderr: bool = False) -> Console:
    """Return a console that prints texts as they are, without emoji codes or highlighting."""
    made = Console(stderr=stderr, highlight=False, emoji=False, soft_wrap=False)
    if not made.is_terminal and "COLUMNS" not in os.environ:
        made.width = WIDTH
    return made


def print_whole(grid: Grid, console: Console) -> None:
    """Print a table as wide as it is: a number that is cut short is no number."""
    width = console.width
    wide = console.options.update(max_width=_ENDLESS)
    console.width = max(width, console.measure(grid, options=wide).maximum)
    console.print(grid)
    console.width = width
