"""Look at one paper or exhibit, draw a chart, begin a paper."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from replicate.commands.options import BUILD, Jobs, NoCache, Out, exit_if_broken, recompute
from replicate.errors import PaperDefinitionError, UnknownPaperError


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
    outcome = recompute([owner], [(owner.id, found.id)], jobs, out, no_cache)
    if outcome.judgement.problems and not outcome.failures:
        # An explanation may quote another exhibit; then the whole paper is needed.
        outcome = recompute([owner], None, jobs, out, no_cache)
    print_exhibit(outcome, paper, found, readings, console())
    exit_if_broken(outcome)


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
