"""Build teaching handouts."""

from __future__ import annotations

from dataclasses import replace

from replicate.commands.computing import Computing, computing, taking
from replicate.commands.handout_options import HandoutOptions
from replicate.commands.options import Papers, exit_with
from replicate.terminal.streams import echo


@computing
@taking(HandoutOptions)
def handout(run: Computing, options: HandoutOptions, papers: Papers = None) -> None:
    """Build teaching handouts, or a class set with a key.

    A handout comes with and without solutions; a class set has a sheet for each student.
    """
    from replicate.handout import LONGEST_RUN, check_order, make, stress_test
    from replicate.run.guarded import GuardedProcess
    from replicate.staging import staged, unchanged, write
    from replicate.terminal.console import console
    from replicate.terminal.counted_progress import counted_progress_on
    from replicate.whatif import DISTRIBUTIONS, ROOMS, unreadable_loops, write_whatif

    with unchanged(run.folder):
        chosen, order = options.order(run.within, papers)
    with GuardedProcess(min(LONGEST_RUN, run.unit_timeout)) as process:
        with unchanged(run.folder):
            if options.stress is not None:
                for line in process.stream(stress_test, order, options.stress):
                    echo(line)
                return
            list(process.stream(check_order, order))
        # Those of other papers, and other editions, stay.
        with staged(run.folder, "handouts", renews=lambda _: False) as fresh:
            outcome = run.recompute(chosen)
            outcome = outcome.without(unreadable_loops(outcome.papers, outcome.results))
            written = []
            with counted_progress_on(console(stderr=True), "sheets") as report:
                order = replace(order, packages=tuple(paper.package for paper in outcome.papers))
                for made in process.stream(make, order, outcome.results, outcome.judgement.verdicts):
                    match made:
                        case (int(done), int(total)):
                            report(done, total, 0)
                        case (str(name), bytes(content)):
                            written.append(write(fresh / "handouts" / name, content))
            # Exercises link to this page.
            written += write_whatif(
                outcome.papers, outcome.results, fresh / "handouts", keep=run.kept_texts(ROOMS, DISTRIBUTIONS)
            )
    for path in dict.fromkeys(path.relative_to(fresh) for path in written):
        echo(f"handout: {run.folder / path}")
    exit_with(run.within, outcome)
