"""What a lecturer sets for a sheet besides its text: title, date, points, which exercises, and the language."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

from replicate.errors import ReplicateError
from replicate.handout.own_exercises import OwnExercise
from replicate.plain_text import parse_toml, read_text
from replicate.resources import templates_dir

FOLDER = "languages"
_TAG = re.compile(r"[a-z]{2,3}")


@dataclass(frozen=True)
class Language:
    """The words that a sheet has besides its text.

    Attributes
    ----------
    tag
        As in the documents' metadata, say ``en``.
    region
        Say ``gb``; empty if none is meant.
    words
        By their names.
    """

    tag: str
    region: str
    words: Mapping[str, str]

    def __getitem__(self, name: str) -> str:
        """Return a word."""
        return self.words[name]

    @property
    def code(self) -> str:
        """Tag and region, as HTML has it."""
        return f"{self.tag}-{self.region.upper()}" if self.region else self.tag


@cache
def language(tag: str) -> Language:
    """Return a language of the folder of templates, or of a file of one's own.

    Parameters
    ----------
    tag
        Its name, or the path of a file like ``en.toml`` whose name it is.

    Raises
    ------
    ReplicateError
        If there is no such file, or it is not as ``en.toml``.
    """
    folder = templates_dir() / FOLDER
    path = Path(tag) if tag.endswith(".toml") else folder / f"{tag}.toml"
    if not _TAG.fullmatch(path.stem) or not path.is_file():
        known = ", ".join(sorted(file.stem for file in folder.glob("*.toml")))
        msg = f"--language is '{tag}', allowed: {known}, or the path of a file like en.toml, say fr.toml"
        raise ReplicateError(msg)
    found = parse_toml(read_text(path, path.name, ReplicateError), path.name, ReplicateError)
    words, region = found.get("words"), found.get("region", "")
    if not isinstance(words, dict) or not isinstance(region, str):
        msg = f"{path.name}: needs a text 'region' and a table [words], as {FOLDER}/en.toml"
        raise ReplicateError(msg)
    needed = set(words) if path == folder / "en.toml" else set(language("en").words)
    for name in sorted(needed ^ set(words)):
        msg = f"{path.name}: [words] {'lacks' if name in needed else 'has an unknown'} '{name}'"
        raise ReplicateError(msg)
    for name, word in words.items():
        if not isinstance(word, str) or not word.strip():
            msg = f"{path.name}: '{name}' is {word!r}, allowed: a text"
            raise ReplicateError(msg)
    return Language(path.stem, region, words)


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
    language: Language = field(default_factory=lambda: language("en"))
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


def read_points(text: str) -> tuple[float, ...]:
    """Return points as written on the command line.

    Raises
    ------
    ReplicateError
        If they are not positive numbers, separated by commas.

    Examples
    --------
    >>> read_points("4, 2.5")
    (4.0, 2.5)
    """
    parts = [part.strip() for part in text.split(",")]
    if not all(re.fullmatch(r"\d{1,4}(\.\d{1,2})?", part) and float(part) > 0 for part in parts):
        msg = f"--points is '{text}', allowed: positive numbers separated by commas, say 4,6,2.5"
        raise ReplicateError(msg)
    return tuple(float(part) for part in parts)


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
