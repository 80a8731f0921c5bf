"""Compare and accept the figures of plain plotting scripts, of any repository."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from replicate.commands.options import BROKEN, DIFFERS, Jobs, not_shared
from replicate.errors import ReplicateError
from replicate.terminal.streams import echo

if TYPE_CHECKING:
    from replicate.baselines.outcomes import Outcome
    from replicate.baselines.scripts import ScriptRun

app = typer.Typer(help="Compare and accept the figures of plotting scripts.", no_args_is_help=True)

Patterns = Annotated[list[str], typer.Argument(metavar="PATTERN", help="Scripts, folders, or patterns with *.")]
AcceptedFigures = Annotated[
    Path, typer.Option("--accepted", help="Folder of the accepted figures.", file_okay=False, callback=not_shared)
]
Timeout = Annotated[float, typer.Option("--timeout", metavar="SECONDS", help="Stop a script that takes longer.")]

_FOLDER, _OUT = Path("figures"), Path("build/figures-diff")


@app.command()
def diff(
    patterns: Patterns,
    accepted: AcceptedFigures = _FOLDER,
    out: Annotated[
        Path, typer.Option("--out", help="Folder for the page and its data.", file_okay=False, callback=not_shared)
    ] = _OUT,
    comment: Annotated[
        Path | None,
        typer.Option("--comment", help="Also write the text of a comment on the pull request here.", dir_okay=False),
    ] = None,
    jobs: Jobs = None,
    timeout: Timeout = 300.0,
) -> None:
    """Say what the figures of plotting scripts show differently.

    Runs the scripts, and draws on a page what differs. Exit status 1 if something differs, 2 if a script failed or
    nothing was compared.
    """
    from replicate.baselines.outputs import counted, worst_first, write_outputs
    from replicate.baselines.scripts import compare_runs
    from replicate.baselines.store import Store

    outcomes = compare_runs(_run(patterns, jobs, timeout), Store(accepted), patterns)
    for outcome in worst_first(outcomes):
        for text in outcome.changes:
            echo(text if outcome.status == "failed" else f"{outcome.name}: {text}", err=outcome.status == "failed")
    echo(counted(outcomes))

    def command(outcome: Outcome) -> str:
        only = f"{outcome.name}={outcome.digest}"
        words = ["replicate", "figures", "accept", outcome.where, "--only", only]
        words += [] if accepted == _FOLDER else ["--accepted", accepted.as_posix()]
        return f"{shlex.join(words)} --reason 'why'"

    echo(f"pictures: {write_outputs(outcomes, out, command, comment)}")
    if not outcomes or any(outcome.status == "failed" for outcome in outcomes):
        raise typer.Exit(BROKEN)
    raise typer.Exit(DIFFERS if any(outcome.differs for outcome in outcomes) else 0)


@app.command()
def accept(
    patterns: Patterns,
    reason: Annotated[str, typer.Option("--reason", help="Why the new state is right.")] = "",
    only: Annotated[
        list[str] | None,
        typer.Option(
            "--only",
            metavar="NAME[=DIGEST]",
            help="Accept only this figure; with a digest, only if that is still its accepted state.",
        ),
    ] = None,
    accepted: AcceptedFigures = _FOLDER,
    jobs: Jobs = None,
    timeout: Timeout = 300.0,
) -> None:
    """Run plotting scripts and accept what their figures show."""
    from replicate.baselines.outputs import worst_first
    from replicate.baselines.scripts import accept_runs
    from replicate.baselines.store import Store, chosen_figure

    if not reason.strip():
        msg = "accepting needs a reason: --reason 'why the new state is right'"
        raise ReplicateError(msg)
    chosen = None if only is None else dict(map(chosen_figure, only))
    outcomes = accept_runs(_run(patterns, jobs, timeout), Store(accepted), reason, chosen, patterns)
    for outcome in worst_first(outcomes):
        for text in outcome.changes:
            echo(f"{outcome.name}: {text}")
    changed = sum(outcome.status == "accepted" for outcome in outcomes)
    echo(f"figures accepted: {changed}" if changed else "nothing differs from the accepted state")


def _run(patterns: Sequence[str], jobs: int | None, timeout: float) -> list[ScriptRun]:
    from replicate.baselines.scripts import find_scripts, run_scripts
    from replicate.terminal.console import console

    errors = console(stderr=True)

    def tell(script: str) -> None:
        errors.print(f"running {script}", highlight=False, markup=False, soft_wrap=True)

    return run_scripts(find_scripts(patterns), jobs=jobs, timeout=timeout, tell=tell)
