"""A lecturer's own exercises: a folder with ``exercise.md`` and ``exercise.py``, or a folder of such folders.

``exercise.py`` defines ``variant(rng)``, which draws the inputs, and ``answers(inputs)``, which computes an `Answer` or
several by name; it may define ``original``, ``requires``, ``shown(inputs)``, ``stated``, ``figures`` and
``files(inputs)``, as `Exercises.vary` describes them. ``exercise.md`` is the text: a heading, the question, and a block
``solution``; its fields are ``inputs['K']``, ``answer['Ki']``, ``stated`` and ``figure('name')``.
"""

from __future__ import annotations

import math
import re
import runpy
import traceback
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from numbers import Real
from pathlib import Path
from typing import Any

from replicate.errors import PaperDefinitionError, ReplicateError
from replicate.exhibits.exercises import Exercises
from replicate.exhibits.variants import Answer, Answers, Inputs, Variation
from replicate.plain_text import read_text

TEXT, PROGRAM = "exercise.md", "exercise.py"
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]*")
_OPTIONAL: dict[str, tuple[Any, Callable[[Any], bool], str]] = {
    "original": (None, lambda value: value is None or isinstance(value, Mapping), "a dictionary of inputs"),
    "requires": (
        {},
        lambda value: isinstance(value, Mapping) and all(map(callable, value.values())),
        "a dictionary of functions of the inputs, by the words that name them",
    ),
    "shown": (lambda _: {}, callable, "a function of the inputs"),
    "stated": ("", lambda value: isinstance(value, str), "a text"),
    "figures": ({}, lambda value: isinstance(value, Mapping), "a dictionary of VariedFigure"),
    "files": (lambda _: {}, callable, "a function of the inputs"),
}


@dataclass(frozen=True)
class OwnExercise:
    """One exercise of a lecturer's own.

    Attributes
    ----------
    source
        What messages call its text.
    text
        As it is in the file.
    """

    source: str
    text: str
    variation: Variation

    @property
    def name(self) -> str:
        """The name of its folder."""
        return self.variation.name


def own_exercises(folder: Path) -> list[OwnExercise]:
    """Return the exercises of a folder, in the order of their names.

    Raises
    ------
    ReplicateError
        If there are none, a file is missing, or a program fails or lacks what it must define; with file, line and
        field.
    """
    homes = [folder] if (folder / TEXT).is_file() or (folder / PROGRAM).is_file() else _inside(folder)
    if not homes:
        msg = f"--exercises: {folder.name} holds no exercise: neither {TEXT} and {PROGRAM} nor folders with them"
        raise ReplicateError(msg)
    return [_loaded(home) for home in homes]


def with_own(exercises: Exercises, own: tuple[OwnExercise, ...]) -> Exercises:
    """Return a handout's exercises together with a lecturer's own.

    Raises
    ------
    PaperDefinitionError
        If two have one name.
    """
    together = Exercises(dict(exercises.answers), dict(exercises.figures), dict(exercises.variations))
    for one in own:
        if one.name in together.answers or one.name in together.variations:
            msg = f"{one.source}: an exercise '{one.name}' exists already; rename the folder"
            raise PaperDefinitionError(msg)
        together.variations[one.name] = one.variation
    return together


def _inside(folder: Path) -> list[Path]:
    if not folder.is_dir():
        msg = f"--exercises: there is no folder {folder.name}"
        raise ReplicateError(msg)
    return sorted(home for home in folder.iterdir() if (home / TEXT).is_file() or (home / PROGRAM).is_file())


def _loaded(home: Path) -> OwnExercise:
    name = home.resolve().name
    if not _NAME.fullmatch(name):
        msg = f"--exercises: the folder '{name}' cannot name an exercise; allowed: letters, digits, - and _"
        raise ReplicateError(msg)
    for needed in (TEXT, PROGRAM):
        if not (home / needed).is_file():
            msg = f"{name}/{needed}: there is no such file; an exercise needs {TEXT} and {PROGRAM}"
            raise ReplicateError(msg)
    program = home / PROGRAM
    source = f"{name}/{PROGRAM}"
    try:
        defined = runpy.run_path(str(program), run_name=f"exercise {name}")
    except (Exception, SystemExit) as error:
        raise _failed(error, program, source, "the program fails") from error
    values = {field: defined.get(field, default) for field, (default, _, _) in _OPTIONAL.items()}
    for field, (_, holds, allowed) in _OPTIONAL.items():
        if not holds(values[field]):
            msg = f"{source}:{_line(program, field)}: '{field}' is {values[field]!r}, allowed: {allowed}"
            raise ReplicateError(msg)
    for field in ("variant", "answers"):
        if not callable(defined.get(field)):
            msg = f"{source}: defines no function '{field}'"
            raise ReplicateError(msg)
    guard = _Guard(program, source)
    variation = Variation(
        name,
        values["original"] or {},
        guard(defined["variant"], "variant(rng)", _checked_inputs),
        guard(defined["answers"], "answers(inputs)", _checked_answers),
        {words: guard(holds, f"requires['{words}']", bool) for words, holds in values["requires"].items()},
        guard(values["shown"], "shown(inputs)", dict),
        values["stated"],
        values["figures"],
        guard(values["files"], "files(inputs)", dict),
    )
    try:
        drawn = variation.drawn("original")  # also where it is not needed: errors are found now
    except PaperDefinitionError as error:
        if str(error).startswith(source):
            raise
        msg = f"{source}:{_line(program, 'requires')}: {error}"
        raise PaperDefinitionError(msg) from error
    if not variation.original:
        variation = replace(variation, original=drawn)
    variation.answers(drawn)
    variation.answers(variation.original)
    return OwnExercise(f"{name}/{TEXT}", read_text(home / TEXT, f"{name}/{TEXT}", ReplicateError), variation)


@dataclass(frozen=True)
class _Guard:
    """Turns what a lecturer's function raises, or returns wrongly, into a line with file, line and field."""

    program: Path
    source: str

    def __call__(self, function: Callable[..., Any], field: str, checked: Callable[[Any], Any]) -> Callable[..., Any]:
        def guarded(argument: Any) -> Any:
            try:
                return checked(function(argument))
            except Exception as error:
                line = _line(self.program, field.partition("(")[0].partition("[")[0])
                raise _failed(error, self.program, self.source, f"{field} fails", line) from error

        return guarded


def _failed(error: BaseException, program: Path, source: str, what: str, line: int = 1) -> ReplicateError:
    inside = [frame for frame in traceback.extract_tb(error.__traceback__) if frame.filename == str(program)]
    found = (inside[-1].lineno if inside else getattr(error, "lineno", None)) or line
    return PaperDefinitionError(f"{source}:{found}: {what}: {type(error).__name__}: {' '.join(str(error).split())}")


def _line(program: Path, field: str) -> int:
    """Return the line in which a name is defined."""
    for number, line in enumerate(program.read_text(encoding="utf-8").splitlines(), start=1):
        if re.match(rf"(def\s+)?{field}\b", line):
            return number
    return 1


def _checked_inputs(value: Any) -> Inputs:
    if not isinstance(value, Mapping) or not value:
        msg = f"returns {value!r}, allowed: a dictionary of numbers or texts"
        raise TypeError(msg)
    for key, one in value.items():
        if not isinstance(one, str | Real) or (isinstance(one, Real) and not math.isfinite(one)):
            msg = f"the field '{key}' is {one!r}, allowed: a finite number or a text"
            raise TypeError(msg)
    return value


def _checked_answers(value: Any) -> Answers:
    found = {"answer": value} if isinstance(value, Answer) else value
    if not isinstance(found, Mapping) or not found:
        msg = f"returns {value!r}, allowed: an Answer, or a dictionary of them"
        raise TypeError(msg)
    for key, one in found.items():
        if not isinstance(one, Answer):
            msg = f"the field '{key}' is {one!r}, allowed: an Answer"
            raise TypeError(msg)
    return found
