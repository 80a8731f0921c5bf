"""What a lecturer sets for a sheet besides its text: title, date, points, which exercises, and the language."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from replicate.errors import ReplicateError
from replicate.handout.own_exercises import OwnExercise
from replicate.languages import Language, language


@dataclass(frozen=True)
class Sheet:
    """What is set for all sheets of a paper.

    Attributes
    ----------
    title
        In place of the text's own; empty for that.
    date
        As it is to be printed; empty for none.
    points
        One number for each exercise of the sheet, or one for all alike; nothing for no points.
    select
        The numbers of the exercises, as the whole handout counts them; nothing for all.
    language
        Of the words besides the text.
    own
        Exercises of the lecturer's own, behind those of the paper.
    """

    title: str = ""
    date: str = ""
    points: tuple[float, ...] = ()
    select: tuple[int, ...] = ()
    language: Language = field(default_factory=language)
    own: tuple[OwnExercise, ...] = ()

    def points_of(self, place: int, count: int) -> float | None:
        """Return the points of the exercise at a place (from 0) among so many of the sheet.

        Raises
        ------
        ReplicateError
            If there are several points, but not so many.
        """
        if not self.points:
            return None
        if len(self.points) not in {1, count}:
            msg = f"--points has {len(self.points)} numbers, the sheet has {count} exercises; give one, or {count}"
            raise ReplicateError(msg)
        return self.points[place if len(self.points) > 1 else 0]


def read_points(text: str, select: str = "") -> tuple[float, ...]:
    """Return points as written on the command line, in the order of the handout.

    Parameters
    ----------
    select
        A selection that `read_selection` accepts; its exercises have the points in the order in which it names them.

    Raises
    ------
    ReplicateError
        If they are not positive numbers, separated by commas.

    Examples
    --------
    >>> read_points("4, 2.5"), read_points("4, 2.5", select="5,2")
    ((4.0, 2.5), (2.5, 4.0))
    """
    parts = [part.strip() for part in text.split(",")]
    if not all(re.fullmatch(r"\d{1,4}(\.\d{1,2})?", part) and float(part) > 0 for part in parts):
        msg = f"--points is '{text}', allowed: positive numbers separated by commas, say 4,6,2.5"
        raise ReplicateError(msg)
    points = tuple(float(part) for part in parts)
    named = [int(number) for number in select.split(",")] if select else []
    if len(named) != len(points):
        return points
    return tuple(dict(sorted(zip(named, points, strict=True))).values())


def read_selection(text: str) -> tuple[int, ...]:
    """Return the numbers of exercises as written on the command line, in the order of the handout.

    Raises
    ------
    ReplicateError
        If they are not different whole numbers from 1, separated by commas.

    Examples
    --------
    >>> read_selection("5,2")
    (2, 5)
    """
    parts = [part.strip() for part in text.split(",")]
    if not all(re.fullmatch(r"[1-9]\d{0,2}", part) for part in parts) or len(set(parts)) < len(parts):
        msg = f"--select is '{text}', allowed: different numbers of exercises separated by commas, say 2,4,5"
        raise ReplicateError(msg)
    return tuple(sorted(int(part) for part in parts))
