"""Compare with the accepted state, and accept what is right."""

from __future__ import annotations

from typing import Annotated

import typer

from replicate.commands.options import (
    BROKEN,
    DIFFERS,
    Accepted,
    Bundled,
    Jobs,
    Names,
    NoCache,
    Out,
    PapersDir,
    UnitTimeout,
    Verbose,
    accepted_folder,
    exit_with,
    library,
    output_folder,
    recompute,
)
from replicate.run.limits import UNIT_TIMEOUT
from replicate.terminal.streams import echo


def diff(
    names: Names = None,
    papers_dir: PapersDir = None,
    bundled: Bundled = False,
    jobs: Jobs = None,
    out: Out = None,
    no_cache: NoCache = False,
    unit_timeout: UnitTimeout = UNIT_TIMEOUT,
    verbose: Verbose = False,
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

    within = library(papers_dir, bundled)
    folder = output_folder(within, out)
    papers, selection = within.select(names or ())
    baseline = accepted_folder(within, papers, accepted)
    with staged(folder, "diff", expects=("diff.json", "diff/index.html")) as fresh:
        outcome = recompute(papers, selection, jobs, folder, no_cache, unit_timeout=unit_timeout, verbose=verbose)
        comparison = compare(outcome, baseline, within.ids())
        print_comparison(comparison, console())  # before anything else can go wrong
        write_diff(comparison, outcome, fresh, jobs)
    echo(f"pictures: {folder / 'diff' / 'index.html'}")
    broken = comparison.broken or not comparison.compared
    exit_with(within, outcome, BROKEN if broken else DIFFERS if comparison.changes else 0, failures_shown=True)


def accept(
    names: Names = None,
    reason: Annotated[str, typer.Option("--reason", help="Why the present state is right.")] = "",
    papers_dir: PapersDir = None,
    bundled: Bundled = False,
    jobs: Jobs = None,
    out: Out = None,
    no_cache: NoCache = False,
    unit_timeout: UnitTimeout = UNIT_TIMEOUT,
    verbose: Verbose = False,
    accepted: Accepted = None,
) -> None:
    """Make the present state the accepted one."""
    from replicate.diff.accept import accept as accept_state
    from replicate.diff.accept import require_reason
    from replicate.terminal.console import console
    from replicate.terminal.differences import print_changes

    require_reason(reason)
    within = library(papers_dir, bundled)
    papers, selection = within.select(names or ())
    folder = accepted_folder(within, papers, accepted, writing=True)
    outcome = recompute(
        papers, selection, jobs, output_folder(within, out), no_cache, unit_timeout=unit_timeout, verbose=verbose
    )
    comparison = accept_state(outcome, folder, reason, within.ids())
    print_changes(comparison, console())
    changes = len(comparison.changes)
    echo(f"changes accepted: {changes}; in {folder}" if changes else f"nothing differs from {folder}")
    exit_with(within, outcome)
