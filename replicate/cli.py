"""The command line.

Exit status: 0 = as accepted, 1 = something differs or is not explained, 2 = the run itself is broken. Errors
are one line on standard error; ``--debug`` shows where they come from. Everything heavy is imported inside
the commands, so that ``replicate --help`` answers at once.
"""

from __future__ import annotations

import io
import signal
import sys
import threading
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from replicate.errors import AcceptedStateError, PaperDefinitionError, ReplicateError, UnknownPaperError

if TYPE_CHECKING:
    from replicate.exhibits import Paper
    from replicate.run.outcome import Outcome, Selection

DIFFERS, BROKEN, TERMINATED = 1, 2, 143

app = typer.Typer(
    name="replicate",
    help="Recompute what papers on PI and PID control print, compare, and say why where it differs.",
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)

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


def main() -> None:
    """Run the command line; this is the console script ``replicate``."""
    arguments = sys.argv[1:]
    debug = "--debug" in arguments
    _prepare()
    try:
        status = app(
            args=[argument for argument in arguments if argument != "--debug"],
            prog_name="replicate",
            standalone_mode=False,
        )
    except Exception as error:
        if debug:
            raise
        print(f"replicate: {_one_line(error)}", file=sys.stderr)  # noqa: T201  -- the error is the output
        sys.exit(BROKEN)
    sys.exit(status or 0)


def _prepare() -> None:
    """Let a terminal without Unicode show what it can, and a run that is told to end tidy up first."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGTERM, lambda *_: sys.exit(TERMINATED))


def _one_line(error: Exception) -> str:
    text = " ".join(str(error).split())
    if isinstance(error, ReplicateError):
        return text
    usage = getattr(error, "format_message", None)  # a wrong option or argument
    if usage is not None:
        context = getattr(error, "ctx", None)
        hint = f" ({context.command_path} --help shows what is allowed)" if context else ""
        return f"{' '.join(usage().split()).rstrip('.')}{hint}"
    return f"unexpected {type(error).__name__}: {text} (--debug shows where)"


@app.callback(invoke_without_command=True)
def _options(
    context: typer.Context,
    debug: Annotated[bool, typer.Option("--debug", help="Show where an error comes from.")] = False,  # noqa: ARG001
    version: Annotated[bool, typer.Option("--version", help="Show the version and exit.")] = False,
) -> None:
    # `--debug` is taken out by `main`, wherever it stands; it is here for the help.
    if version:
        import replicate

        typer.echo(f"replicate {replicate.__version__}")
        raise typer.Exit
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())
        raise typer.Exit(BROKEN)


@app.command(name="list")
def list_(
    paper: Annotated[str | None, typer.Argument(metavar="PAPER", help="Default: the papers.")] = None,
) -> None:
    """List the papers, or the exhibits of one of them.

    Of each exhibit: whether it is done, and if it cannot be computed, why.
    """
    from replicate.resources import accepted_dir
    from replicate.run.discovery import find_paper, find_papers
    from replicate.terminal.console import console
    from replicate.terminal.inventory import print_exhibits, print_papers

    if paper is None:
        print_papers(find_papers(), console())
        return
    try:
        accepted = accepted_dir()
    except FileNotFoundError:  # a list does without
        accepted = Path("figures")
    print_exhibits(find_paper(paper), console(), accepted)


@app.command()
def show(
    paper: Annotated[str, typer.Argument(metavar="PAPER")],
    exhibit: Annotated[str, typer.Argument(metavar="EXHIBIT")],
    reading: Annotated[str | None, typer.Option("--reading", help="Show this reading only.")] = None,
    jobs: Jobs = None,
    out: Out = BUILD,
    no_cache: NoCache = False,
) -> None:
    """Show one exhibit: printed values, readings and verdicts.

    With the explanations of those that do not hold.
    """
    from replicate.exhibits import Table
    from replicate.run.discovery import find_exhibit, find_paper
    from replicate.terminal.console import console
    from replicate.terminal.show import print_exhibit

    owner = find_paper(paper)
    found = find_exhibit(owner, exhibit)
    readings = list(found.readings) if isinstance(found, Table) else []
    if reading is not None:
        if reading not in readings:
            msg = f"{paper}/{exhibit} has no reading '{reading}'; known: {', '.join(readings) or 'none'}"
            raise UnknownPaperError(msg)
        readings = [reading]
    outcome = _recompute([owner], [(owner.id, found.id)], jobs, out, no_cache)
    if outcome.judgement.problems and not outcome.failures:
        # An explanation may quote another exhibit; then the whole paper is needed.
        outcome = _recompute([owner], None, jobs, out, no_cache)
    print_exhibit(outcome, paper, found, readings, console())
    _exit_if_broken(outcome)


@app.command(context_settings={"allow_extra_args": True, "ignore_unknown_options": True})
def chart(
    context: typer.Context,
    paper: Annotated[str, typer.Argument(metavar="PAPER")],
    name: Annotated[str | None, typer.Option("--chart", help="Which chart; default: the paper's first.")] = None,
    out: Annotated[
        Path | None, typer.Option("--out", help="File, .svg or .png; default: in build/charts.", dir_okay=False)
    ] = None,
) -> None:
    """Draw a chart of a paper for parameters of your own.

    They are given as --NAME VALUE; without any, the message names those of the chart.
    """
    from replicate.run.charts import file_name, find_chart, read_parameters, write_chart
    from replicate.run.discovery import find_paper

    owner = find_paper(paper)
    found = find_chart(owner, name)
    values = read_parameters(found, context.args)
    path = out or BUILD / "charts" / file_name(owner, found, values)
    write_chart(owner, found, values, path)
    typer.echo(f"chart: {path}")


@app.command()
def report(papers: Papers = None, jobs: Jobs = None, out: Out = BUILD, no_cache: NoCache = False) -> None:
    """Recompute every exhibit and write the report."""
    from replicate.report.data import write_outputs
    from replicate.report.pages import build_report
    from replicate.run.discovery import find_papers
    from replicate.staging import staged
    from replicate.terminal.console import console
    from replicate.terminal.summary import print_summary

    with staged(out) as fresh:  # first of all, so that a folder that cannot be written is noticed at once
        outcome = _recompute(find_papers(papers or ()), None, jobs, out, no_cache)
        write_outputs(outcome.papers, outcome.results, outcome.judgement, fresh)
        pages = build_report(outcome.papers, outcome.results, outcome.judgement, fresh / "report")
        index = out / "report" / pages[0].name
    print_summary(outcome, console())
    typer.echo(f"\nreport: {index}")
    _exit_if_broken(outcome)


@app.command()
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

    baseline = _accepted(accepted)
    outcome = _recompute(find_papers(papers or ()), None, jobs, out, no_cache)
    comparison = compare(outcome, baseline)
    problems = find_problems(outcome, comparison)
    for problem in problems:
        typer.echo(problem)
    compared = sum(row.match != "none" for row in outcome.judgement.results)
    typer.echo(f"problems: {len(problems)}; comparisons: {compared}; exhibits: {len(outcome.results)}")
    _tell_failures(outcome)
    if comparison.broken:
        raise typer.Exit(BROKEN)
    raise typer.Exit(DIFFERS if problems else 0)


@app.command()
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

    baseline = _accepted(accepted)
    with staged(out) as fresh:
        papers, selection = select(names or ())
        outcome = _recompute(papers, selection, jobs, out, no_cache)
        comparison = compare(outcome, baseline)
        print_comparison(comparison, console())  # before anything else can go wrong
        write_diff(comparison, outcome, fresh, jobs)
    typer.echo(f"pictures: {out / 'diff' / 'index.html'}")
    if comparison.broken or not comparison.compared:
        raise typer.Exit(BROKEN)
    raise typer.Exit(DIFFERS if comparison.changes else 0)


@app.command()
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
    baseline = _accepted(accepted)
    papers, selection = select(names or ())
    outcome = _recompute(papers, selection, jobs, out, no_cache)
    comparison = accept_state(outcome, baseline, reason)
    print_changes(comparison, console())
    changes = len(comparison.changes)
    typer.echo(f"changes accepted: {changes}" if changes else "nothing differs from the accepted state")


@app.command()
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
        outcome = _recompute(chosen, None, jobs, out, no_cache)
        verdicts = outcome.judgement.verdicts
        written = build_handouts(
            outcome.papers, outcome.results, verdicts, fresh, solutions=editions, file_format=file_format
        )
    for path in written:
        typer.echo(f"handout: {out / 'handouts' / path.name}")
    _exit_if_broken(outcome)


@app.command()
def new(
    paper: Annotated[str, typer.Argument(metavar="PAPER", help="Its id: lower-case letters, digits and _.")],
) -> None:
    """Make the package of a new paper in the current folder."""
    from replicate.new_paper import new_paper
    from replicate.run.discovery import known_papers

    if paper in known_papers():
        msg = f"there is a paper '{paper}' already; choose another id"
        raise PaperDefinitionError(msg)
    folder = new_paper(paper, Path())
    typer.echo(
        f"{folder}: made. What to do next:\n"
        f"  pip install -e {folder}\n"
        f"  replicate report {paper}\n"
        f"  replicate accept {paper} --accepted figures --reason 'first'   # what check and diff compare with"
    )


def _recompute(
    papers: list[Paper], selection: Selection | None, jobs: int | None, out: Path, no_cache: bool
) -> Outcome:
    """Compute and judge with progress on standard error."""
    from replicate.run.outcome import recompute
    from replicate.terminal.console import console
    from replicate.terminal.progress import progress_on

    errors = console(stderr=True)
    with progress_on(errors) as progress:
        cache = None if no_cache else out / "cache"
        return recompute(papers, selection, jobs=jobs, cache_dir=cache, progress=progress)


def _tell_failures(outcome: Outcome) -> None:
    """Say on standard error what raised; a fault in the core makes everything fail, and the first lines tell."""
    for failure in outcome.failures[:MOST_FAILURES]:
        typer.echo(f"failed: {failure}", err=True)
    if len(outcome.failures) > MOST_FAILURES:
        typer.echo(f"failed: {len(outcome.failures) - MOST_FAILURES} more", err=True)


def _exit_if_broken(outcome: Outcome) -> None:
    _tell_failures(outcome)
    if outcome.failures:
        raise typer.Exit(BROKEN)


def _accepted(folder: Path | None) -> Path:
    from replicate.resources import accepted_dir

    if folder is not None:
        return folder
    try:
        return accepted_dir()
    except FileNotFoundError as error:
        msg = "the folder of the accepted state, figures, is missing: restore it, or name another: --accepted"
        raise AcceptedStateError(msg) from error
