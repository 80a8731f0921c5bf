"""What several commands share: options, and computing with progress on standard error."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from replicate.errors import AcceptedStateError

if TYPE_CHECKING:
    from replicate.exhibits import Paper
    from replicate.run.outcome import Outcome, Selection

DIFFERS, BROKEN = 1, 2

Jobs = Annotated[int | None, typer.Option("--jobs", "-j", min=1, help="Processes; default: one per core.")]
Out = Annotated[Path, typer.Option("--out", help="Folder for what a run leaves behind.", file_okay=False)]
NoCache = Annotated[bool, typer.Option("--no-cache", help="Compute everything anew, keep nothing.")]
Accepted = Annotated[
    Path | None,
    typer.Option("--accepted", help="Folder of the accepted state; default: the project's own."),
]
Papers = Annotated[list[str] | None, typer.Argument(metavar="PAPER", help="Default: all papers.")]
Names = Annotated[list[str] | None, typer.Argument(metavar="PAPER[/EXHIBIT]", help="Default: all papers.")]

BUILD = Path("build")
MOST_FAILURES = 12


def recompute(papers: list[Paper], selection: Selection | None, jobs: int | None, out: Path, no_cache: bool) -> Outcome:
    """Compute and judge with progress on standard error."""
    from replicate.run.outcome import recompute
    from replicate.terminal.console import console
    from replicate.terminal.progress import progress_on

    errors = console(stderr=True)
    with progress_on(errors) as progress:
        cache = None if no_cache else out / "cache"
        return recompute(papers, selection, jobs=jobs, cache_dir=cache, progress=progress)


def tell_failures(outcome: Outcome) -> None:
    """Report on standard error what raised; a fault in the core makes everything fail, and the first lines tell."""
    for failure in outcome.failures[:MOST_FAILURES]:
        typer.echo(f"failed: {failure}", err=True)
    if len(outcome.failures) > MOST_FAILURES:
        typer.echo(f"failed: {len(outcome.failures) - MOST_FAILURES} more", err=True)


def exit_if_broken(outcome: Outcome) -> None:
    """Report what raised, and end with the status of a broken run if anything did."""
    tell_failures(outcome)
    if outcome.failures:
        raise typer.Exit(BROKEN)


def accepted_folder(folder: Path | None) -> Path:
    """Return the folder of the accepted state: the one named, or the project's own."""
    from replicate.resources import accepted_dir

    if folder is not None:
        return folder
    try:
        return accepted_dir()
    except FileNotFoundError as error:
        msg = "the folder of the accepted state, figures, is missing: restore it, or name another: --accepted"
        raise AcceptedStateError(msg) from error
