"""Compare with the accepted state, and accept what is right."""

from __future__ import annotations

from typing import Annotated

import typer

from replicate.commands.options import (
    BROKEN,
    BUILD,
    DIFFERS,
    Accepted,
    Jobs,
    Names,
    NoCache,
    Out,
    accepted_folder,
    recompute,
)


def diff(
    names: Names = None,
    jobs: Jobs = None,
    out: Out = BUILD,
    no_cache: NoCache = False,
    accepted: Accepted = None,
) -> None:
    """Say what differs from the accepted state.

    In words, and in pictures in build/diff/index.html. Exit status 1 if something does.
    """
    from replicate.diff.comparison import compare
    from replicate.diff.outputs import write_diff
    from replicate.run.discovery import select
    from replicate.staging import staged
    from replicate.terminal.console import console
    from replicate.terminal.differences import print_comparison

    baseline = accepted_folder(accepted)
    with staged(out) as fresh:
        papers, selection = select(names or ())
        outcome = recompute(papers, selection, jobs, out, no_cache)
        comparison = compare(outcome, baseline)
        print_comparison(comparison, console())  # before anything else can go wrong
        write_diff(comparison, outcome, fresh, jobs)
    typer.echo(f"pictures: {out / 'diff' / 'index.html'}")
    if comparison.broken or not comparison.compared:
        raise typer.Exit(BROKEN)
    raise typer.Exit(DIFFERS if comparison.changes else 0)


def accept(
    names: Names = None,
    reason: Annotated[str, typer.Option("--reason", help="Why the present state is right.")] = "",
    jobs: Jobs = None,
    out: Out = BUILD,
    no_cache: NoCache = False,
    accepted: Accepted = None,
) -> None:
    """Make the present state the accepted one."""
    from replicate.diff.accept import accept as accept_state
    from replicate.diff.accept import require_reason
    from replicate.run.discovery import select
    from replicate.terminal.console import console
    from replicate.terminal.differences import print_changes

    require_reason(reason)
    baseline = accepted_folder(accepted)
    papers, selection = select(names or ())
    outcome = recompute(papers, selection, jobs, out, no_cache)
    comparison = accept_state(outcome, baseline, reason)
    print_changes(comparison, console())
    changes = len(comparison.changes)
    typer.echo(f"changes accepted: {changes}" if changes else "nothing differs from the accepted state")
