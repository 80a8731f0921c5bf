"""A lecturer's own exercises: a folder with ``exercise.md`` and ``exercise.py``, or a folder of such folders.

``exercise.py`` defines ``variant(rng)``, which draws the inputs, and ``answers(inputs)``, which computes an `Answer` or
several by name; it may define ``original``, ``requires``, ``shown(inputs)``, ``stated``, ``figures`` and
``files(inputs)``, as `Exercises.vary` describes them. ``exercise.md`` is the text: a heading, the question, and a block
``solution``; its fields are ``inputs['K']``, ``answer['Ki']``, ``stated`` and ``figure('name')``.
"""

from __future__ import annotations

import ast
import re
import runpy
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from difflib import get_close_matches
from pathlib import Path
from types import MappingProxyType
from typing import Any

from replicate.errors import PaperDefinitionError, ReplicateError
from replicate.exhibits.exercises import Exercises
from replicate.exhibits.variants import Variation, VariedFigure
from replicate.handout.own_code import OwnCode, as_said
from replicate.plain_text import read_text

TEXT, PROGRAM = "exercise.md", "exercise.py"
BESIDE = "exercises"  # the folder beside notebooks in which their programs are
_NEARLY = 0.8  # how alike a misspelt name is to the one that is meant, from 0 to 1
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
    "figures": (
        {},
        lambda value: isinstance(value, Mapping) and all(isinstance(one, VariedFigure) for one in value.values()),
        "a dictionary of VariedFigure",
    ),
    "files": (lambda _: {}, callable, "a function of the inputs"),
}


@dataclass(frozen=True)
class OwnExercise:
    """One exercise of a lecturer's own.

    Attributes
    ----------
    source
        What messages call its text.
    text, program
        As they are in its files.
    """

    source: str
    text: str
    program: str
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
    text, program = (read_text(home / file, f"{name}/{file}", ReplicateError) for file in (TEXT, PROGRAM))
    return OwnExercise(f"{name}/{TEXT}", text, program, own_variation(home / PROGRAM, name))


def own_variation(program: Path, name: str) -> Variation:
    """Return what the program of an exercise defines.

    Raises
    ------
    ReplicateError
        If it fails or lacks what it must define; with file, line and field.
    """
    source = f"{name}/{PROGRAM}"
    code = OwnCode(str(program), source)
    with code.running("the program"):
        defined = runpy.run_path(str(program), run_name=f"exercise {name}")
    _check_names(defined, program, source)
    values = {field: defined.get(field, default) for field, (default, _, _) in _OPTIONAL.items()}
    for field, (_, holds, allowed) in _OPTIONAL.items():
        if not holds(values[field]):
            msg = (
                f"{source}:{code.line_of(_defining(field))}: '{field}' is {as_said(values[field])}, allowed: {allowed}"
            )
            raise ReplicateError(msg)
    for field in ("variant", "answers"):
        if not callable(defined.get(field)):
            msg = f"{source}: defines no function '{field}'"
            raise ReplicateError(msg)
    variation = code.variation(
        Variation(
            name,
            values["original"] or {},
            defined["variant"],
            defined["answers"],
            **{field: values[field] for field in ("requires", "shown", "stated", "figures", "files")},
        ),
        "",
        lambda field: code.line_of(_defining(field)),
    )
    try:
        drawn = variation.drawn("original")  # also where it is not needed: errors are found now
    except PaperDefinitionError as error:
        if str(error).startswith(source):
            raise
        msg = f"{source}:{code.line_of(_defining('requires'))}: {error}"
        raise PaperDefinitionError(msg) from error
    if replace(variation).drawn("original") != drawn:  # a copy has drawn nothing yet
        line = code.line_of(_defining("variant"))
        msg = f"{source}:{line}: variant(rng) draws other numbers for the same student and seed; draw from rng alone"
        raise PaperDefinitionError(msg)
    original = MappingProxyType(dict(variation.original)) if variation.original else drawn
    variation = replace(variation, original=original)
    variation.answers(drawn)
    variation.answers(original)
    return variation


def _check_names(defined: Mapping[str, Any], program: Path, source: str) -> None:
    """Refuse a name that is used nowhere and is nearly one that exercises may define, and do not."""
    bound: dict[str, int] = {}
    used = set()
    for node in ast.walk(ast.parse(program.read_bytes())):
        match node:
            case ast.FunctionDef(name=name) | ast.Name(id=name, ctx=ast.Store()):
                bound.setdefault(name, node.lineno)
            case ast.Name(id=name):
                used.add(name)
    absent = [field for field in _OPTIONAL if field not in defined]
    for name in sorted(defined.keys() & bound.keys() - used, key=bound.__getitem__):
        near = get_close_matches(name.lower(), absent, n=1, cutoff=_NEARLY)
        if near and not name.startswith("_"):
            place = f"{source}:{bound[name]}"
            msg = f"{place}: '{name}' is used nowhere, and no name of a part of an exercise; write '{near[0]}'"
            raise ReplicateError(msg)


def _defining(field: str) -> str:
    """Return the pattern of the line that defines a name."""
    return rf"^((async\s+)?def\s+)?{field}\b"
