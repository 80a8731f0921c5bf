"""Recompute everything: the report, and the check that nothing is left unexplained."""

from __future__ import annotations

import typer

from replicate.commands.options import (
    BROKEN,
    BUILD,
    DIFFERS,
    Accepted,
    Jobs,
    NoCache,
    Out,
    Papers,
    accepted_folder,
    exit_if_broken,
    recompute,
    tell_failures,
)


def report(papers: Papers = None, jobs: Jobs = None, out: Out = BUILD, no_cache: NoCache = False) -> None:
    """Recompute every exhibit and write the report."""
    from replicate.report.data import write_outputs
    from replicate.report.pages import build_report
    from replicate.run.discovery import find_papers
    from replicate.staging import staged
    from replicate.terminal.console import console
    from replicate.terminal.summary import print_summary

    with staged(out) as fresh:  # first of all, so that a folder that cannot be written is noticed at once
        outcome = recompute(find_papers(papers or ()), None, jobs, out, no_cache)
        write_outputs(outcome.papers, outcome.results, outcome.judgement, fresh)
        pages = build_report(outcome.papers, outcome.results, outcome.judgement, fresh / "report")
        index = out / "report" / pages[0].name
    print_summary(outcome, console())
    typer.echo(f"\nreport: {index}")
    exit_if_broken(outcome)


def check(
    papers: Papers = None,
    jobs: Jobs = None,
    out: Out = BUILD,
    no_cache: NoCache = False,
    accepted: Accepted = None,
) -> None:
    """Check that every value holds or is explained.

    And that nothing differs from the accepted state.
    """
    from replicate.diff.check import problems as find_problems
    from replicate.diff.comparison import compare
    from replicate.run.discovery import find_papers

    baseline = accepted_folder(accepted)
    outcome = recompute(find_papers(papers or ()), None, jobs, out, no_cache)
    comparison = compare(outcome, baseline)
    problems = find_problems(outcome, comparison)
    for problem in problems:
        typer.echo(problem)
    typer.echo(
        f"problems: {len(problems)}; comparisons: {outcome.judgement.compared}; exhibits: {len(outcome.results)}"
    )
    tell_failures(outcome)
    if comparison.broken:
        raise typer.Exit(BROKEN)
    raise typer.Exit(DIFFERS if problems else 0)
