"""The consoles of the command line.

Colours follow the terminal and ``NO_COLOR``. Where the output is no terminal, lines are 100 columns wide
unless ``COLUMNS`` says otherwise.
"""

from __future__ import annotations

import os

from rich.console import Console

WIDTH = 100


def console(*, stderr: bool = False) -> Console:
    """Return a console that prints texts as they are, without emoji codes or highlighting."""
    made = Console(stderr=stderr, highlight=False, emoji=False, soft_wrap=False)
    if not made.is_terminal and "COLUMNS" not in os.environ:
        made.width = WIDTH
    return made
