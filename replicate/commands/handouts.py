"""Build teaching handouts."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from replicate.commands.computing import Computing, computing
from replicate.commands.options import Papers, exit_with
from replicate.errors import ReplicateError
from replicate.plain_text import steering
from replicate.terminal.streams import echo


@computing
def handout(
    run: Computing,
    papers: Papers = None,
    solutions: Annotated[
        bool | None, typer.Option("--solutions/--no-solutions", help="Build one edition only; default: both.")
    ] = None,
    file_format: Annotated[
        str,
        typer.Option(
            "--format", help="pdf, html, docx, tex, typ, ipynb, slides; for learning platforms moodle or qti."
        ),
    ] = "pdf",
    variants: Annotated[
        int | None,
        typer.Option("--variants", min=1, help="A class set of this many sheets, each with its own numbers."),
    ] = None,
    roster: Annotated[
        Path | None, typer.Option("--roster", help="A class set for the students of a CSV file, one per line.")
    ] = None,
    roster_id: Annotated[
        str, typer.Option("--roster-id", help="The roster's column that names the sheets; default: the first.")
    ] = "",
    seed: Annotated[str, typer.Option("--seed", help="What the numbers of a class set are drawn from.")] = "1",
    form: Annotated[str | None, typer.Option("--form", help="Make one sheet again, from the id on its pages.")] = None,
    stress: Annotated[
        int | None, typer.Option("--stress", min=1, help="Draw this many forms of each exercise and test the answers.")
    ] = None,
    select: Annotated[
        str, typer.Option("--select", metavar="2,4,5", help="Only these exercises; they keep their numbers.")
    ] = "",
    points: Annotated[
        str,
        typer.Option(
            "--points",
            metavar="4,6,2",
            help="Points for the exercises, in the order of --select; one number is for each.",
        ),
    ] = "",
    title: Annotated[str, typer.Option("--title", help="Title in place of the handout's own.")] = "",
    date: Annotated[str, typer.Option("--date", help="Date, printed at the top as it stands.")] = "",
    language: Annotated[
        str | None,
        typer.Option(
            "--language",
            help="Language of the words besides the text: en, de, or a file like en.toml; default: the project's.",
        ),
    ] = None,
    exercises: Annotated[
        list[Path] | None,
        typer.Option("--exercises", metavar="DIR", help="Add exercises of your own: exercise.md and exercise.py."),
    ] = None,
) -> None:
    """Build teaching handouts, or a class set with a key.

    A handout comes with and without solutions; a class set has a sheet for each student.
    """
    from replicate.handout import (
        BANKS,
        LONGEST_RUN,
        SLIDES,
        Form,
        Order,
        Sheet,
        check_order,
        checked_format,
        make,
        read_points,
        read_roster,
        read_selection,
        stress_test,
        with_handout,
    )
    from replicate.languages import language as language_of
    from replicate.run.guarded import GuardedProcess
    from replicate.staging import staged, write
    from replicate.terminal.console import console
    from replicate.terminal.counted_progress import counted_progress_on
    from replicate.whatif import DISTRIBUTIONS, ROOMS, unreadable_loops, write_whatif

    again = Form.read(form) if form is not None else None
    selected = read_selection(select) if select else again.select if again else ()
    if again and selected != again.select:
        msg = "--select differs from the form, which says what is on its sheet; leave it out"
        raise ReplicateError(msg)
    _check_texts({"--seed": seed, "--title": title, "--date": date})
    if roster_id and not roster:
        msg = f"--roster-id is '{roster_id}', a column of a roster, and there is none; give --roster FILE"
        raise ReplicateError(msg)
    project = run.within.project
    words = language_of(language) if language else project.language if project else language_of()
    sheet = Sheet(title, date, read_points(points, select) if points else (), selected, words)
    given = [*(papers or ()), *([again.paper] if again and again.paper not in (papers or ()) else [])]
    file_format = checked_format(file_format)
    chosen = with_handout(run.within.papers(given), all_needed=bool(given), file_format=file_format)
    class_options = {"--variants": variants, "--roster": roster, "--form": form, "--stress": stress}
    kinds = [name for name, value in class_options.items() if value is not None]
    if file_format == SLIDES:
        about_exercises = {"--select": select, "--points": points, "--exercises": exercises, "--solutions": solutions}
        _check_no_exercises([*kinds, *(name for name, value in about_exercises.items() if value)])
    if kinds:
        _check_class_options(kinds, len(chosen), again is not None and file_format in BANKS, papers)
    students = (
        read_roster(roster, roster_id) if roster else [f"{number:03}" for number in range(1, (variants or 0) + 1)]
    )
    order = Order(
        tuple(paper.package for paper in chosen),
        sheet,
        tuple(exercises or ()),
        file_format,
        (False, True) if solutions is None and not kinds else (bool(solutions),),
        tuple(students),
        seed,
        again,
    )
    with GuardedProcess(min(LONGEST_RUN, run.unit_timeout)) as process:
        if stress is not None:
            for line in process.stream(stress_test, order, stress):
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


def _check_texts(given: dict[str, str]) -> None:
    """Refuse texts that would steer what shows them."""
    for option, text in given.items():
        if found := steering(text):
            msg = f"{option} holds the character {found}, which sheets must not get; leave it out"
            raise ReplicateError(msg)


def _check_class_options(kinds: list[str], papers: int, one_in_a_bank: bool, given: list[str] | None) -> None:
    """Refuse options that do not go together."""
    if len(kinds) > 1:
        msg = f"{' and '.join(kinds)} do not go together; choose one"
        raise ReplicateError(msg)
    if papers != 1:
        msg = f"{kinds[0]} is about one paper, {len(given) if given else 'none'} given; name one"
        raise ReplicateError(msg)
    if one_in_a_bank:
        msg = "--form makes one sheet again; a file of questions is about a class: use --variants or --roster"
        raise ReplicateError(msg)


def _check_no_exercises(given: list[str]) -> None:
    """Refuse options that slides have no use for."""
    if given:
        msg = f"{given[0]} is about exercises, and slides have none"
        raise ReplicateError(msg)
