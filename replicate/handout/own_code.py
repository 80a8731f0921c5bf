"""Code that comes with exercises: what it raises, returns wrongly or does not end is one line, with file and line."""

from __future__ import annotations

import math
import re
import traceback
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cache, partial
from numbers import Real
from pathlib import Path
from types import MappingProxyType
from typing import Any

from replicate.errors import PaperDefinitionError
from replicate.exhibits.exercises import Exercises, Values
from replicate.exhibits.variants import Answer, Answers, Inputs, Variation
from replicate.handout.formulas import FormulaError, convert
from replicate.plain_text import read_text
from replicate.run.guarded import Place, watched

LONGEST_RUN = 60.0  # seconds

_ADDRESS = re.compile(r" at 0x[0-9A-Fa-f]+")
_FILE_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]*")


@dataclass(frozen=True)
class OwnCode:
    """One file of code.

    Parameters
    ----------
    file
        As tracebacks name it.
    source
        What messages call it.
    """

    file: str
    source: str

    @contextmanager
    def running(self, what: str, line: int = 1) -> Iterator[None]:
        """Name what fails inside the ``with`` block; in a guarded process also what does not end.

        Raises
        ------
        PaperDefinitionError
            With the innermost line of this file, or else the one given.
        """
        try:
            with watched(Place(self.file, self.source, what, line)):
                yield
        except (Exception, SystemExit) as error:
            inside = [frame for frame in traceback.extract_tb(error.__traceback__) if frame.filename == self.file]
            found = (inside[-1].lineno if inside else getattr(error, "lineno", None)) or line
            text = " ".join(str(error).split())
            msg = f"{self.source}:{found}: {what} fails: {type(error).__name__}{': ' if text else ''}{text}"
            raise PaperDefinitionError(msg) from error

    def line_of(self, pattern: str) -> int:
        """Return the first line in which a pattern is found, 1 if it is in none."""
        lines = read_text(Path(self.file), self.source, PaperDefinitionError).splitlines()
        return next((number for number, line in enumerate(lines, start=1) if re.search(pattern, line)), 1)

    def guarded(
        self, function: Callable[..., Any], what: str, line: int, checked: Callable[[Any], Any] = lambda value: value
    ) -> Callable[..., Any]:
        """Return a function of this file whose calls are `running`, and whose values are checked there."""

        def call(*arguments: Any, **named: Any) -> Any:
            with self.running(what, line):
                return checked(function(*arguments, **named))

        return call

    def exercises(self, found: Exercises) -> Exercises:
        """Return exercises that this file defines, all their functions guarded."""
        answers, figures, variations = {}, {}, {}
        for name, compute in found.answers.items():
            answers[name] = self.guarded(compute, f"answer '{name}'", self._defines(name), _values)
        for name, figure in found.figures.items():
            draw = self.guarded(figure.draw, f"figure '{name}'", self._defines(name))
            figures[name] = replace(figure, draw=draw)
        for name, variation in found.variations.items():
            place = partial(_same, self._defines(name))
            variations[name] = self.variation(variation, f"exercise '{name}': ", place)
        return Exercises(answers, figures, variations)

    def variation(self, found: Variation, owner: str, line: Callable[[str], int]) -> Variation:
        """Return an exercise whose numbers vary, all its functions guarded.

        Parameters
        ----------
        owner
            Begins what messages say of it.
        line
            Returns where a field of it is defined.
        """

        def guarded(function: Callable[..., Any], field: str, checked: Callable[[Any], Any]) -> Callable[..., Any]:
            return self.guarded(function, owner + field, line(re.split(r"[(\[]", field)[0]), checked)

        return replace(
            found,
            variant=guarded(found.variant, "variant(rng)", _inputs),
            answers=guarded(found.answers, "answers(inputs)", _answers),
            requires={words: guarded(holds, f"requires['{words}']", bool) for words, holds in found.requires.items()},
            shown=guarded(found.shown, "shown(inputs)", _values),
            figures={
                name: replace(figure, draw=guarded(figure.draw, f"figures['{name}']", lambda value: value))
                for name, figure in found.figures.items()
            },
            files=guarded(found.files, "files(inputs)", _files),
        )

    def _defines(self, name: str) -> int:
        return self.line_of(rf"""["']{re.escape(name)}["']""")


def _same(line: int, _: str) -> int:
    return line


def _inputs(value: Any) -> Inputs:
    if not isinstance(value, Mapping) or not value:
        msg = f"returns {as_said(value)}, allowed: a dictionary of numbers or texts"
        raise TypeError(msg)
    for key, one in value.items():
        if not isinstance(key, str):
            msg = f"names a field {as_said(key)}, allowed: a text"
            raise TypeError(msg)
        if not isinstance(one, str | Real) or (isinstance(one, Real) and not math.isfinite(one)):
            msg = f"the field '{key}' is {as_said(one)}, allowed: a finite number or a text"
            raise TypeError(msg)
    return MappingProxyType(dict(value))  # that no later function changes


def _answers(value: Any) -> Answers:
    found = {"answer": value} if isinstance(value, Answer) else value
    if not isinstance(found, Mapping) or not found:
        msg = f"returns {as_said(value)}, allowed: an Answer, or a dictionary of them"
        raise TypeError(msg)
    for key, one in found.items():
        if not isinstance(one, Answer):
            msg = f"the field '{key}' is {as_said(one)}, allowed: an Answer"
            raise TypeError(msg)
        if not isinstance(key, str):
            msg = f"names an answer {key!r}, allowed: a text"
            raise TypeError(msg)
        _, *parts = (one.asked or key).split("$")
        if len(parts) % 2 or not all(tex.strip() for tex in parts[::2]):
            msg = f"the field 'asked' of '{key}' is {one.asked!r}, allowed: words, and LaTeX between two '$'"
            raise ValueError(msg)
        for tex in parts[::2]:
            if why := _not_a_formula(tex):
                msg = f"the field 'asked' of '{key}' holds the formula ${tex}$, which pandoc cannot convert: {why}"
                raise ValueError(msg)
    return found


@cache
def _not_a_formula(tex: str) -> str:
    """Return why pandoc cannot convert a formula; nothing if it can."""
    try:
        convert([(False, tex)])
    except FormulaError as error:
        return str(error)
    return ""


def as_said(value: Any) -> str:
    """Return a value as a message shows it: an object without a text of its own by its type, none by its address."""
    text = repr(value)
    return type(value).__name__ if f"{id(value):x}" in text else _ADDRESS.sub("", text)


def _values(value: Any) -> Values:
    if not isinstance(value, Mapping):
        msg = f"returns {as_said(value)}, allowed: a dictionary of numbers or texts"
        raise TypeError(msg)
    return value


def _files(value: Any) -> Mapping[str, str]:
    if not isinstance(value, Mapping):
        msg = f"returns {as_said(value)}, allowed: a dictionary of texts"
        raise TypeError(msg)
    for name, text in value.items():
        if not isinstance(name, str) or not _FILE_NAME.fullmatch(name):
            msg = f"names a file {name!r}, allowed: letters, digits, '.', '_' and '-', say 'data.csv'"
            raise ValueError(msg)
        if not isinstance(text, str):
            msg = f"the file '{name}' is {as_said(text)}, allowed: a text"
            raise TypeError(msg)
    return value
