"""Make a page in which one loop can be tried out."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from replicate.errors import ReplicateError


def whatif(
    plant: Annotated[str, typer.Option("--plant", help="For example 'e^{-s}/(s+1)'.")],
    controller: Annotated[str, typer.Option("--controller", help="For example 'k=0.6,ki=0.5'.")],
    out: Annotated[Path, typer.Option("--out", help="The file to write.", dir_okay=False)] = Path("whatif.html"),
    title: Annotated[str, typer.Option("--title", help="Title of the page.")] = "What if?",
) -> None:
    """Make a page in which a control loop can be tried out."""
    from replicate.loops.errors import LoopError
    from replicate.staging import write_signed
    from replicate.whatif import Row, whatif_page

    try:
        page = whatif_page([Row("as given", plant, controller)], title)
    except LoopError as error:
        raise ReplicateError(str(error)) from error
    write_signed(out, page.encode())
    typer.echo(f"page: {out}")
