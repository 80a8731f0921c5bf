"""Build teaching handouts."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from replicate.commands.computing import Computing, computing
from replicate.commands.options import Papers, exit_with
from replicate.errors import ReplicateError
from replicate.terminal.streams import echo


@computing
def handout(
    run: Computing,
    papers: Papers = None,
    solutions: Annotated[
        bool | None, typer.Option("--solutions/--no-solutions", help="Build one edition only; default: both.")
    ] = None,
    format: Annotated[str, typer.Option("--format", help="File format: pdf or html.")] = "pdf",  # noqa: A002
    variants: Annotated[
        int | None, typer.Option("--variants", min=1, help="A class set: so many sheets, each with its own numbers.")
    ] = None,
    roster: Annotated[
        Path | None, typer.Option("--roster", help="A class set: a CSV file with one student per line.")
    ] = None,
    roster_id: Annotated[
        str, typer.Option("--roster-id", help="The roster's column that names the sheets; default: the first.")
    ] = "",
    seed: Annotated[str, typer.Option("--seed", help="What the numbers of a class set are drawn from.")] = "1",
    form: Annotated[str | None, typer.Option("--form", help="Make one sheet again, from the id on its pages.")] = None,
    stress: Annotated[
        int | None, typer.Option("--stress", min=1, help="Draw so many forms of each exercise and test the answers.")
    ] = None,
) -> None:
    """Build teaching handouts, or a class set with a key.

    A handout comes with and without solutions; a class set has a sheet for each student.
    """
    from replicate.handout import (
        ClassSet,
        Form,
        build_handouts,
        checked_format,
        read_roster,
        stressed,
        varying,
        with_handout,
    )
    from replicate.staging import staged

    again = Form.read(form) if form is not None else None
    given = [*(papers or ()), *([again.paper] if again and again.paper not in (papers or ()) else [])]
    chosen = with_handout(run.within.papers(given), all_needed=bool(given))
    file_format = checked_format(format)
    class_options = {"--variants": variants, "--roster": roster, "--form": form, "--stress": stress}
    kinds = [name for name, value in class_options.items() if value is not None]
    if kinds:
        _check_class_options(kinds, len(chosen), file_format, papers)
        varying(chosen[0])
    if stress is not None:
        for variation in varying(chosen[0]).variations.values():
            for line in stressed(variation, stress):
                echo(line)
        return
    students = (
        read_roster(roster, roster_id) if roster else [f"{number:03}" for number in range(1, (variants or 0) + 1)]
    )
    editions = (False, True) if solutions is None else (solutions,)
    # Those of other papers, and other editions, stay.
    with staged(run.folder, "handouts", renews=lambda _: False) as fresh:
        outcome = run.recompute(chosen)
        verdicts = outcome.judgement.verdicts
        if kinds:
            class_set = ClassSet(outcome.papers[0], outcome.results, verdicts, solutions=bool(solutions))
            files = [class_set.again(again)] if again else class_set.files(students, seed)
            written = [_written(fresh / "handouts" / name, content) for name, content in files]
        else:
            written = build_handouts(
                outcome.papers,
                outcome.results,
                verdicts,
                fresh / "handouts",
                solutions=editions,
                file_format=file_format,
            )
    for path in written:
        echo(f"handout: {run.folder / 'handouts' / path.name}")
    exit_with(run.within, outcome)


def _check_class_options(kinds: list[str], papers: int, file_format: str, given: list[str] | None) -> None:
    """Refuse options that do not go together."""
    if len(kinds) > 1:
        msg = f"{' and '.join(kinds)} do not go together; choose one"
        raise ReplicateError(msg)
    if papers != 1:
        msg = f"{kinds[0]} is about one paper, {len(given) if given else 'none'} given; name one"
        raise ReplicateError(msg)
    if file_format != "pdf":
        msg = f"{kinds[0]} makes PDFs, the format is '{file_format}'"
        raise ReplicateError(msg)


def _written(path: Path, content: bytes) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content)
    return path
