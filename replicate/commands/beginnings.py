"""Begin a project, or a paper in one."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Annotated

import typer

from replicate.commands.options import library, shortest
from replicate.errors import PaperDefinitionError
from replicate.terminal.streams import echo


def init(
    folder: Annotated[Path, typer.Argument(metavar="FOLDER", help="Created if it does not exist.")],
    title: Annotated[str, typer.Option("--title", help="Title of the report.")] = "",
) -> None:
    """Begin a project: a folder for papers, with what CI needs."""
    from replicate.new_project import new_project

    new_project(folder, title)
    here = folder.resolve() == Path.cwd()
    echo(
        f"Created {'a project in this folder' if here else folder}. Next steps:\n"
        + ("" if here else f"  cd {shlex.quote(f'{folder}')}\n")
        + "  replicate new PAPER     # begins a paper in papers/PAPER\n"
        "  replicate report"
    )


def new(
    paper: Annotated[str, typer.Argument(metavar="PAPER", help="Its id: lower-case letters, digits and _.")],
) -> None:
    """Begin a paper, in the project or in this folder."""
    from replicate.new_paper import new_paper
    from replicate.new_project import SCHEMAS

    within = library()
    if paper in within.ids():
        msg = f"the paper '{paper}' already exists; choose another id"
        raise PaperDefinitionError(msg)
    homes = within.project.papers if within.project is not None else ()
    schemas = within.project.root / SCHEMAS if within.project is not None else None
    folder = new_paper(paper, homes[0] if homes else Path(), schemas)
    option, state = ("", "") if homes else (" --papers .", " --accepted accepted")
    echo(
        f"Created {shortest(folder.resolve())}. Next steps:\n"
        f"  replicate report {paper}{option}\n"
        f"  replicate check {paper}{option}{state}     # lists what is still to do\n"
        f"  replicate accept {paper}{option}{state} --reason 'first'"
    )
