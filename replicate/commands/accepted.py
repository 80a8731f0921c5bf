"""Compare with the accepted state, and accept what is right."""

from __future__ import annotations

from typing import Annotated

import typer

from replicate.commands.computing import Computing, computing
from replicate.commands.options import BROKEN, DIFFERS, Accepted, Names, accepted_folder, exit_with
from replicate.terminal.streams import echo


@computing
def diff(
    run: Computing,
    names: Names = None,
    accepted: Accepted = None,
) -> None:
    """Show what differs from the accepted state, in words and pictures.

    The pictures are in diff/index.html in the output folder. Exit status 1 if something differs.
    """
    from replicate.diff.comparison import compare
    from replicate.diff.outputs import write_diff
    from replicate.staging import staged
    from replicate.terminal.console import console
    from replicate.terminal.differences import print_comparison

    papers, selection = run.within.select(names or ())
    baseline = accepted_folder(run.within, papers, accepted)
    with staged(run.folder, "diff", expects=("diff.json", "diff/index.html")) as fresh:
        outcome = run.recompute(papers, selection)
        comparison = compare(outcome, baseline, run.within.ids())
        print_comparison(comparison, console())  # before anything else can go wrong
        write_diff(comparison, outcome, fresh, baseline, run.jobs)
    echo(f"pictures: {run.folder / 'diff' / 'index.html'}")
    broken = comparison.broken or not comparison.compared
    exit_with(run.within, outcome, BROKEN if broken else DIFFERS if comparison.changes else 0, failures_shown=True)


@computing
def accept(
    run: Computing,
    names: Names = None,
    reason: Annotated[str, typer.Option("--reason", help="Why the present state is right.")] = "",
    accepted: Accepted = None,
) -> None:
    """Make the present state the accepted one."""
    from replicate.diff.accept import accept as accept_state
    from replicate.diff.accept import require_reason
    from replicate.terminal.console import console
    from replicate.terminal.differences import print_changes

    require_reason(reason)
    papers, selection = run.within.select(names or ())
    folder = accepted_folder(run.within, papers, accepted, writing=True)
    outcome = run.recompute(papers, selection)
    comparison = accept_state(outcome, folder, reason, run.within.ids())
    print_changes(comparison, console())
    changes = len(comparison.changes)
    renewed = "; written anew in the present format" if comparison.outdated or comparison.unsigned else ""
    echo(f"changes accepted: {changes}; in {folder}" if changes else f"nothing differs from {folder}{renewed}")
    exit_with(run.within, outcome)
