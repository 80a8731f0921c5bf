"""Build teaching handouts."""

from __future__ import annotations

from typing import Annotated

import typer

from replicate.commands.options import BUILD, Jobs, NoCache, Out, Papers, exit_if_broken, recompute


def handout(
    papers: Papers = None,
    solutions: Annotated[
        bool | None, typer.Option("--solutions/--no-solutions", help="One edition only; default: both.")
    ] = None,
    format: Annotated[str, typer.Option("--format", help="pdf or html.")] = "pdf",  # noqa: A002
    jobs: Jobs = None,
    out: Out = BUILD,
    no_cache: NoCache = False,
) -> None:
    """Build teaching handouts, without and with solutions."""
    from replicate.handout import build_handouts, checked_format, with_handout
    from replicate.run.discovery import find_papers
    from replicate.staging import staged

    chosen = with_handout(find_papers(papers or ()), all_needed=bool(papers))
    file_format = checked_format(format)
    editions = (False, True) if solutions is None else (solutions,)
    with staged(out / "handouts") as fresh:
        outcome = recompute(chosen, None, jobs, out, no_cache)
        verdicts = outcome.judgement.verdicts
        written = build_handouts(
            outcome.papers, outcome.results, verdicts, fresh, solutions=editions, file_format=file_format
        )
    for path in written:
        typer.echo(f"handout: {out / 'handouts' / path.name}")
    exit_if_broken(outcome)
