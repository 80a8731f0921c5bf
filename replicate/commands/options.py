"""What several commands share: options, folders, and how they end."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer

from replicate.errors import AcceptedStateError, OutputError, ProjectError
from replicate.terminal.streams import echo

if TYPE_CHECKING:
    from replicate.exhibits import Paper
    from replicate.run.library import Library
    from replicate.run.outcome import Outcome

DIFFERS, BROKEN = 1, 2

Jobs = Annotated[int | None, typer.Option("--jobs", "-j", min=1, help="Number of processes; default: one per core.")]
Out = Annotated[
    Path | None,
    typer.Option("--out", help="Folder for the results; default: the project's.", file_okay=False),
]
SingleFile = Annotated[
    bool,
    typer.Option("--single-file", help="Also write each paper as one file that can be mailed, PAPER.html."),
]
Accepted = Annotated[
    Path | None,
    typer.Option("--accepted", help="Folder of the accepted state; default: the project's own."),
]
Papers = Annotated[list[str] | None, typer.Argument(metavar="PAPER", help="Default: the project's papers.")]
Names = Annotated[list[str] | None, typer.Argument(metavar="PAPER[/EXHIBIT]", help="Default: the project's papers.")]

PapersDir = Annotated[
    list[Path] | None,
    typer.Option("--papers", metavar="DIR", help="A folder that holds papers; may be given several times."),
]
Bundled = Annotated[bool, typer.Option("--bundled", help="Use the papers that come with replicate.")]

Backend = Annotated[str, typer.Option("--backend", metavar="local|dask", help="Where the work is done.")]
Scheduler = Annotated[
    str | None, typer.Option("--scheduler", metavar="ADDRESS", help="With --backend dask, such as tcp://host:8786.")
]

BUILD = Path("build")
MOST_FAILURES = 12


def tell_failures(outcome: Outcome) -> None:
    """Report on standard error what raised; a fault in the core makes everything fail, and the first lines tell."""
    for failure in outcome.failures[:MOST_FAILURES]:
        echo(f"failed: {failure}", err=True)
    if len(outcome.failures) > MOST_FAILURES:
        echo(f"failed: {len(outcome.failures) - MOST_FAILURES} more", err=True)


def library(folders: list[Path] | None = None, bundled: bool = False) -> Library:
    """Return the papers within reach of a command: those of the project, of the folders given, and the bundled ones."""
    from replicate.run.library import Library
    from replicate.run.project import find_project

    return Library(find_project(), tuple(folders or ()), bundled)


def output_folder(papers: Library, out: Path | None) -> Path:
    """Return where a run leaves what it makes: the folder named, the project's, or ``build`` here."""
    if out is None:
        out = shortest(papers.project.out) if papers.project is not None else BUILD
    return not_shared(out)


def not_shared(folder: Path) -> Path:
    """Return a folder that a command may fill.

    Raises
    ------
    OutputError
        If everything else lies in it: the root of a disk, or the user's home.
    """
    try:
        place = folder.resolve()
    except RuntimeError:  # links in a circle, as Python before 3.13 has it: whoever opens the folder says so
        return folder
    shared = {Path(place.anchor): "the root of a disk"}
    with suppress(RuntimeError):  # a user whom the system does not know
        shared[Path.home().resolve()] = "the user's home"
    if place in shared:
        msg = f"{folder}: is {shared[place]}, where nothing is written; name a folder in it, such as {folder / BUILD}"
        raise OutputError(msg)
    return folder


def accepted_folder(papers: Library, chosen: Sequence[Paper], folder: Path | None, *, writing: bool = False) -> Path:
    """Return the folder of the accepted state: the one named, the project's, or that of the bundled papers.

    Raises
    ------
    ProjectError
        If there is neither a project nor a folder named; the state of the bundled papers is read, never written.
    """
    from replicate.staging import finish_interrupted

    if folder is None:
        folder = _accepted_folder(papers, chosen, writing=writing)
    if writing:
        not_shared(folder)
    finish_interrupted(folder)
    return folder


def _accepted_folder(papers: Library, chosen: Sequence[Paper], *, writing: bool) -> Path:
    from replicate.resources import accepted_dir

    project = papers.project
    foreign = not (project is not None and project.bundled) and all(papers.is_bundled(paper.id) for paper in chosen)
    own = project is not None and all((project.accepted / paper.id).is_dir() for paper in chosen)
    if foreign and not writing and not own:
        try:
            return accepted_dir()
        except FileNotFoundError as error:
            msg = "the accepted state of the bundled papers is missing: name another folder: --accepted"
            raise AcceptedStateError(msg) from error
    if project is None:
        msg = "there is no project here: name the folder of the accepted state with --accepted, or see 'replicate init'"
        raise ProjectError(msg)
    return shortest(project.accepted)


def exit_with(
    papers: Library,
    outcome: Outcome | None = None,
    status: int = 0,
    *,
    failures_shown: bool = False,
    problems_shown: bool = False,
) -> NoReturn:
    """Report what raised, which papers could not be used and which of their lines say nothing, and end.

    What raised and what could not be used makes the run a broken one.
    """
    broken, failed = list(papers.broken), False
    if outcome is not None:
        if not failures_shown:
            tell_failures(outcome)
        broken += outcome.broken.values()
        failed = bool(outcome.failures)
        judgement = outcome.judgement
        if outcome.complete and not failed:  # a text may ask for a result that failed or was not computed
            broken += [line for line in judgement.unreadable if line not in broken]
        for line in [] if problems_shown else judgement.unused:
            echo(f"unused: {line}", err=True)
    for line in broken:
        echo(f"broken: {line}", err=True)
    raise typer.Exit(BROKEN if broken or failed else status)


def shortest(path: Path) -> Path:
    """Return a path as a person here would write it."""
    here = Path.cwd()
    return path.relative_to(here) if path.is_relative_to(here) else path
