"""The options of handouts and class sets, and what they order together."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from replicate.errors import ReplicateError
from replicate.plain_text import steering

if TYPE_CHECKING:
    from replicate.exhibits import Paper
    from replicate.handout import Order
    from replicate.run.library import Library


@dataclass(frozen=True)
class HandoutOptions:
    """What a lecturer asks for; each attribute is the option of its name, whose help describes it."""

    solutions: Annotated[
        bool | None, typer.Option("--solutions/--no-solutions", help="Build one edition only; default: both.")
    ] = None
    file_format: Annotated[
        str,
        typer.Option(
            "--format", help="pdf, html, docx, tex, typ, ipynb, slides; for learning platforms moodle or qti."
        ),
    ] = "pdf"
    variants: Annotated[
        int | None,
        typer.Option("--variants", min=1, help="A class set of this many sheets, each with its own numbers."),
    ] = None
    roster: Annotated[
        Path | None, typer.Option("--roster", help="A class set for the students of a CSV file, one per line.")
    ] = None
    roster_id: Annotated[
        str, typer.Option("--roster-id", help="The roster's column that names the sheets; default: the first.")
    ] = ""
    seed: Annotated[str, typer.Option("--seed", help="What the numbers of a class set are drawn from.")] = "1"
    form: Annotated[str | None, typer.Option("--form", help="Make one sheet again, from the id on its pages.")] = None
    stress: Annotated[
        int | None, typer.Option("--stress", min=1, help="Draw this many forms of each exercise and test the answers.")
    ] = None
    select: Annotated[
        str, typer.Option("--select", metavar="2,4,5", help="Only these exercises; they keep their numbers.")
    ] = ""
    points: Annotated[
        str,
        typer.Option(
            "--points",
            metavar="4,6,2",
            help="Points for the exercises, in the order of --select; one number is for each.",
        ),
    ] = ""
    title: Annotated[str, typer.Option("--title", help="Title in place of the handout's own.")] = ""
    date: Annotated[str, typer.Option("--date", help="Date, printed at the top as it stands.")] = ""
    language: Annotated[
        str | None,
        typer.Option(
            "--language",
            help="Language of the words besides the text: en, de, or a file like en.toml; default: the project's.",
        ),
    ] = None
    exercises: Annotated[
        list[Path] | None,
        typer.Option("--exercises", metavar="DIR", help="Add exercises of your own: exercise.md and exercise.py."),
    ] = None

    def order(self, within: Library, papers: list[str] | None) -> tuple[list[Paper], Order]:
        """Return the papers that are meant, and what is to be made of them.

        Parameters
        ----------
        papers
            Their names; all that have a handout if there are none.

        Raises
        ------
        ReplicateError
            If an option cannot be read, or options do not go together.
        """
        from replicate.handout import (
            BANKS,
            SLIDES,
            Form,
            Order,
            Sheet,
            checked_format,
            read_points,
            read_roster,
            read_selection,
            with_handout,
        )
        from replicate.languages import language as language_of

        again = Form.read(self.form) if self.form is not None else None
        selected = read_selection(self.select) if self.select else again.select if again else ()
        if again and selected != again.select:
            msg = "--select differs from the form, which says what is on its sheet; leave it out"
            raise ReplicateError(msg)
        _check_texts({"--seed": self.seed, "--title": self.title, "--date": self.date})
        if self.roster_id and not self.roster:
            msg = f"--roster-id is '{self.roster_id}', a column of a roster, and there is none; give --roster FILE"
            raise ReplicateError(msg)
        project = within.project
        words = language_of(self.language) if self.language else project.language if project else language_of()
        points = read_points(self.points, self.select) if self.points else ()
        sheet = Sheet(self.title, self.date, points, selected, words)
        given = [*(papers or ()), *([again.paper] if again and again.paper not in (papers or ()) else [])]
        file_format = checked_format(self.file_format)
        chosen = with_handout(within.papers(given), all_needed=bool(given), file_format=file_format)
        if file_format == SLIDES:
            self._check_slides()
        if self._kinds:
            _check_class_options(self._kinds, len(chosen), again is not None and file_format in BANKS, papers)
        numbers = [f"{number:03}" for number in range(1, (self.variants or 0) + 1)]
        order = Order(
            tuple(paper.package for paper in chosen),
            sheet,
            tuple(self.exercises or ()),
            file_format,
            (False, True) if self.solutions is None and not self._kinds else (bool(self.solutions),),
            tuple(read_roster(self.roster, self.roster_id) if self.roster else numbers),
            self.seed,
            again,
        )
        return chosen, order

    @property
    def _kinds(self) -> list[str]:
        """The options given of which each asks for another kind of class set."""
        kinds = {"--variants": self.variants, "--roster": self.roster, "--form": self.form, "--stress": self.stress}
        return [name for name, value in kinds.items() if value is not None]

    def _check_slides(self) -> None:
        """Refuse options that slides have no use for."""
        about_exercises = {
            "--select": self.select,
            "--points": self.points,
            "--exercises": self.exercises,
            "--solutions": self.solutions,
        }
        if given := [*self._kinds, *(name for name, value in about_exercises.items() if value)]:
            msg = f"{given[0]} is about exercises, and slides have none"
            raise ReplicateError(msg)


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
