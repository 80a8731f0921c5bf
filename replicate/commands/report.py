"""Recompute everything: the report, and the check that nothing is left unexplained."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from replicate.commands.computing import Computing, computing
from replicate.commands.options import BROKEN, DIFFERS, Accepted, Papers, SingleFile, accepted_folder, exit_with
from replicate.errors import TemplateError
from replicate.run.garbage import staying
from replicate.terminal.streams import echo

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from replicate.exhibits import Paper
    from replicate.report.scope import Scope
    from replicate.report.site import Site
    from replicate.report.standing import Standing
    from replicate.run.outcome import Outcome


@computing
@staying()
def report(
    run: Computing,
    papers: Papers = None,
    single_file: SingleFile = False,
) -> None:
    """Recompute every exhibit and write the report.

    Of papers that are named, their pages are written and what all pages share.
    """
    from replicate.report.standing import keep, kept_files, material, read_note, units_shown

    # What is read below must not be newer than what is said to have been read.
    texts = {} if papers or single_file or run.no_cache else _texts(run)
    note = read_note(run.folder) if texts else None
    if note and _stands(run, texts, note):
        return

    from replicate import whatif
    from replicate.display import markdown
    from replicate.display.environment import versions
    from replicate.report.data import expected_files, write_outputs
    from replicate.report.pages import build_report, single_page
    from replicate.report.site import INDEX
    from replicate.report.texts import placed, unreadable
    from replicate.staging import staged
    from replicate.terminal.console import console
    from replicate.terminal.summary import counts_of, print_summary

    chosen = run.within.papers(papers or ())
    named = {paper.id for paper in chosen}
    scope = _scope(run, named, beside=bool(papers))
    in_order = [one.name for one in run.within.known if one.name in {*named, *scope.others}]
    everyone = run.within.papers(in_order) if scope.others else chosen
    about = _about(run, everyone)
    with staged(run.folder, "report", renews=scope.renews, expects=expected_files(chosen)) as fresh:
        # The overview and the lists speak of all papers; what has been kept of the others is not computed again.
        outcome = run.recompute(everyone)
        outcome = outcome.without(whatif.unreadable_loops(outcome.papers, outcome.results))
        made_of = material(run.folder, chosen, units_shown(chosen) if texts else [], texts)
        keeps = kept_files(run.folder, note, made_of)
        kept = run.kept_texts(markdown.ROOMS, markdown.DISTRIBUTIONS)
        build = partial(
            build_report, out_dir=fresh / "report", about=about, keep=kept, keeps=keeps, uses=run.distributions
        )
        try:
            pages = build(outcome.papers, outcome.results, outcome.judgement)
        except TemplateError:  # one paper's text must not take the pages of the others
            outcome = outcome.without(unreadable(outcome))
            with placed(run.within.project):
                pages = build(outcome.papers, outcome.results, outcome.judgement)
        data = write_outputs(outcome.papers, outcome.results, outcome.judgement, fresh, keeps)
        kept = run.kept_texts(whatif.ROOMS, whatif.DISTRIBUTIONS)
        whatif.write_whatif(outcome.papers, outcome.results, fresh / "report", back=INDEX, keep=kept)
        mailed = [paper for paper in outcome.papers if paper.id in named] if single_file else []
        for paper in mailed:
            text = single_page(paper, outcome.results, outcome.judgement, data, about)
            (fresh / f"{paper.id}.html").write_bytes(text.encode())
        written = scope.prune(fresh)
    outcome = outcome.of(named)
    counts = counts_of(outcome)
    print_summary(counts, console())
    if texts and not (run.within.broken or outcome.broken or outcome.failures or outcome.judgement.unreadable):
        stamp = versions(run.distributions(paper.package for paper in chosen))
        keep(run.folder, made_of, units_shown(chosen), stamp, written, counts, outcome.judgement.unused)
    echo(f"\nreport: {run.folder / 'report' / pages[0].name}")
    for paper in mailed:
        echo(f"in one file: {run.folder / paper.id}.html")
    exit_with(run.within, outcome)


def _scope(run: Computing, named: set[str], *, beside: bool) -> Scope:
    """Return the scope of a run, beside the pages of other papers that the report has, or in place of them."""
    from replicate.report.scope import Scope
    from replicate.staging import files_of

    pages = [name.removeprefix("report/") for name in files_of(run.folder, "report")] if beside else []
    return Scope.among(named, pages, run.within.ids())


def _about(run: Computing, papers: Sequence[Paper]) -> Site:
    """Return the texts of the report on some papers."""
    from replicate.report.site import site_of

    return site_of(run.within.project, bundled=all(run.within.is_bundled(paper.id) for paper in papers))


def _texts(run: Computing) -> dict[str, str]:
    """Return by paper the digest of what the report is made of besides results; nothing if a paper cannot be used."""
    from replicate.report.standing import texts_of

    papers = run.within.found()
    return texts_of(papers, _about(run, papers)) if papers else {}


def _stands(run: Computing, texts: Mapping[str, str], note: Standing) -> bool:
    """Say what the report says, if there is nothing to write anew; return whether that is so."""
    from replicate.report.site import INDEX
    from replicate.report.standing import standing
    from replicate.staging import finish_interrupted
    from replicate.terminal.console import console
    from replicate.terminal.summary import print_summary

    finish_interrupted(run.folder)
    found = standing(run.folder, run.within.found(), texts, note)
    if found is None:
        return False
    run.tell_kept(found.shown)
    print_summary(found.counts, console())
    echo(f"\nreport: {run.folder / 'report' / INDEX}")
    for line in found.unused:
        echo(f"unused: {line}", err=True)
    return True


@computing
@staying()
def check(
    run: Computing,
    papers: Papers = None,
    accepted: Accepted = None,
) -> None:
    """Check that all is explained and as accepted.

    Every printed value holds or has an explanation, and nothing differs from the accepted state.
    """
    from replicate.diff.check import problems as find_problems
    from replicate.diff.comparison import compare
    from replicate.handout.legibility import unreadable_handouts
    from replicate.handout.own_code import LONGEST_RUN
    from replicate.report.texts import unreadable

    chosen = run.within.papers(papers or ())
    baseline = accepted_folder(run.within, chosen, accepted)
    outcome = run.recompute(chosen)
    comparison = compare(outcome, baseline, run.within.ids())
    problems = find_problems(outcome, comparison)
    for problem in problems:
        echo(problem)
    comparisons = outcome.judgement.compared
    echo(f"problems: {len(problems)}; comparisons: {comparisons}; exhibits: {len(outcome.results)}")
    handouts = {}
    if outcome.complete and not outcome.failures:  # a text may ask for a result that failed or was not computed
        seconds = min(LONGEST_RUN, run.unit_timeout)
        handouts = unreadable_handouts(outcome.papers, outcome.results, outcome.judgement.verdicts, seconds)
    broken = handouts | unreadable(outcome) | _unreadable_loops(outcome)
    outcome = replace(outcome, broken=outcome.broken | broken)
    status = BROKEN if comparison.broken else DIFFERS if problems else 0
    exit_with(run.within, outcome, status, problems_shown=True)


def _unreadable_loops(outcome: Outcome) -> dict[str, str]:
    """Return what `unreadable_loops` does; without loops, nothing that computes with them is loaded."""
    from replicate.exhibits.results import TableResult

    if not any(isinstance(one, TableResult) and one.trials.all for one in outcome.results.values()):
        return {}
    from replicate.whatif import unreadable_loops

    return unreadable_loops(outcome.papers, outcome.results)
