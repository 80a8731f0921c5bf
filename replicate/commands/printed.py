"""Work on printed tables: compare two transcriptions."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from replicate.commands.options import DIFFERS
from replicate.terminal.streams import echo

app = typer.Typer(no_args_is_help=True)

File = Annotated[Path, typer.Argument(metavar="FILE.csv", dir_okay=False)]


@app.command()
def compare(one: File, other: File) -> None:
    """Show where two transcriptions of a table differ.

    Exit status 1 if they do.
    """
    from replicate.exhibits.transcriptions import differences

    lines, cells = differences(one, other)
    for line in lines:
        echo(line)
    echo(f"cells compared: {cells}; differences: {len(lines)}")
    raise typer.Exit(DIFFERS if lines else 0)


@app.callback()
def _group() -> None:
    """Work on the files of printed numbers."""
