"""Build teaching handouts."""

from __future__ import annotations

from typing import Annotated

import typer

from replicate.commands.options import (
    Bundled,
    Jobs,
    NoCache,
    Out,
    Papers,
    PapersDir,
    UnitTimeout,
    Verbose,
    exit_with,
    library,
    output_folder,
    recompute,
)
from replicate.run.limits import UNIT_TIMEOUT
from replicate.terminal.streams import echo


def handout(
    papers: Papers = None,
    papers_dir: PapersDir = None,
    bundled: Bundled = False,
    solutions: Annotated[
        bool | None, typer.Option("--solutions/--no-solutions", help="Build one edition only; default: both.")
    ] = None,
    format: Annotated[str, typer.Option("--format", help="File format: pdf or html.")] = "pdf",  # noqa: A002
    jobs: Jobs = None,
    out: Out = None,
    no_cache: NoCache = False,
    unit_timeout: UnitTimeout = UNIT_TIMEOUT,
    verbose: Verbose = False,
) -> None:
    """Build teaching handouts, with and without solutions."""
    from replicate.handout import build_handouts, checked_format, with_handout
    from replicate.staging import staged

    within = library(papers_dir, bundled)
    place = output_folder(within, out)
    chosen = with_handout(within.papers(papers or ()), all_needed=bool(papers))
    file_format = checked_format(format)
    editions = (False, True) if solutions is None else (solutions,)
    with staged(place, "handouts", renews=lambda _: False) as fresh:  # those of other papers, and other editions, stay
        outcome = recompute(chosen, None, jobs, place, no_cache, unit_timeout=unit_timeout, verbose=verbose)
        verdicts = outcome.judgement.verdicts
        written = build_handouts(
            outcome.papers, outcome.results, verdicts, fresh / "handouts", solutions=editions, file_format=file_format
        )
    for path in written:
        echo(f"handout: {place / 'handouts' / path.name}")
    exit_with(within, outcome)
