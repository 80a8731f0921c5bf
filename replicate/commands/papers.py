"""Look at one paper or exhibit, and draw a chart."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from replicate.commands.computing import Computing, computing
from replicate.commands.options import Bundled, PapersDir, accepted_folder, exit_with, library, output_folder
from replicate.errors import ReplicateError, UnknownPaperError
from replicate.terminal.streams import echo


def list_(
    paper: Annotated[str | None, typer.Argument(metavar="PAPER", help="Default: list the papers.")] = None,
    papers_dir: PapersDir = None,
    bundled: Bundled = False,
) -> None:
    """List the papers, or the exhibits of one of them."""
    from replicate.terminal.console import console
    from replicate.terminal.inventory import print_exhibits, print_papers

    within = library(papers_dir, bundled)
    if paper is None:
        print_papers(within.papers(() if within.meant else within.ids()), console())
    else:
        found = within.paper(paper)
        try:
            accepted = accepted_folder(within, [found], None)
        except ReplicateError:  # a list does without
            accepted = Path("accepted")
        print_exhibits(found, console(), accepted)
    exit_with(within)


@computing
def show(
    run: Computing,
    paper: Annotated[str, typer.Argument(metavar="PAPER")],
    exhibit: Annotated[str, typer.Argument(metavar="EXHIBIT")],
    reading: Annotated[str | None, typer.Option("--reading", help="Show only this reading.")] = None,
) -> None:
    """Show one exhibit: prints, readings, verdicts, explanations."""
    from replicate.exhibits import Table
    from replicate.run.discovery import find_exhibit
    from replicate.terminal.console import console
    from replicate.terminal.show import print_exhibit

    owner = run.within.paper(paper)
    found = find_exhibit(owner, exhibit)
    readings = list(found.readings) if isinstance(found, Table) else []
    if reading is not None:
        if reading not in readings:
            msg = f"{paper}/{exhibit} has no reading '{reading}'; known: {', '.join(readings) or 'none'}"
            raise UnknownPaperError(msg)
        readings = [reading]
    outcome = run.recompute([owner], [(owner.id, found.id)])
    if outcome.judgement.problems and not outcome.failures:
        # An explanation may quote another exhibit; then the whole paper is needed.
        outcome = run.recompute([owner])
    print_exhibit(outcome, paper, found, readings, console())
    exit_with(run.within, outcome)


def chart(
    context: typer.Context,
    paper: Annotated[str, typer.Argument(metavar="PAPER")],
    name: Annotated[str | None, typer.Option("--chart", help="Which chart; default: the paper's first.")] = None,
    papers_dir: PapersDir = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", help="Output file, .svg or .png; default: a file in build/charts.", dir_okay=False),
    ] = None,
) -> None:
    """Draw a chart of a paper for parameters of your own.

    Give them as --NAME VALUE; without any, the message lists those that the chart needs.
    """
    from replicate.run.charts import file_name, find_chart, guarded_chart, read_parameters
    from replicate.staging import signed, staged, write_signed

    within = library(papers_dir)
    owner = within.paper(paper)
    found = find_chart(owner, name)
    values = read_parameters(found, context.args)
    file = file_name(owner, found, values)
    content = guarded_chart(owner, found, values, out or Path(file))
    if out is None:
        folder = output_folder(within, None)
        with staged(folder, "charts", renews=lambda _: False) as fresh:  # earlier charts stay
            (fresh / "charts").mkdir()
            (fresh / "charts" / file).write_bytes(signed(content))
        out = folder / "charts" / file
    else:
        write_signed(out, content)
    echo(f"chart: {out}")
