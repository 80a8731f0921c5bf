"""What a definition must be: ids that can name files and anchors, texts that are texts, lists that are lists.

Ids become names of files and folders, addresses on pages and words on the command line, so they are checked where they
are defined. Python itself checks no types: ``authors="A. Author"`` would be nine authors of one letter.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence, Set
from numbers import Real
from typing import Any, NoReturn

from replicate.errors import PaperDefinitionError
from replicate.plain_text import steering

_ID = re.compile(r"[A-Za-z0-9](?:[A-Za-z0-9_.-]{0,98}[A-Za-z0-9_-])?", re.ASCII)
_ALLOWED = "letters and digits first, then also '-', '_' and '.', at most 100 and no '.' at the end"

_LAST_YEAR = 9999

#: Names of a report's own pages, which no paper may have.
PAGES = frozenset({"errata", "index", "methods", "search", "verdicts", "whatif"})


def check_id(what: str, id: object, others: Iterable[str] = ()) -> None:
    """Check an id.

    Parameters
    ----------
    what
        What it is the id of: ``exhibit``, ``reading of table-1``.
    others
        Ids that are taken; two must differ also where case does not count, as in the names of files.

    Raises
    ------
    PaperDefinitionError
        If it is none, or taken.

    Examples
    --------
    >>> check_id("exhibit", "table-1")
    >>> check_id("exhibit", "../x")
    Traceback (most recent call last):
    replicate.errors.PaperDefinitionError: '../x' is not an id of an exhibit; allowed: letters and digits first, ...
    """
    if not isinstance(id, str) or not _ID.fullmatch(id):
        article = "an" if what[0] in "aeiou" else "a"
        refuse(f"{shown(id)} is not an id of {article} {what}; allowed: {_ALLOWED}")
    for other in others:
        if other == id:
            refuse(f"{what} '{id}' is defined twice")
        if other.lower() == id.lower():
            refuse(f"{what} '{id}' differs from '{other}' only in case; files of both would have one name")


def check_paper_id(id: object) -> None:
    """Check the id of a paper, which names its page, too.

    Raises
    ------
    PaperDefinitionError
        If it is none, or that of another page of the report.
    """
    check_id("paper", id)
    if str(id).lower() in PAGES:
        taken = ", ".join(sorted(PAGES))
        refuse(f"'{id}' is not an id of a paper: the report has pages of the names {taken}; choose another")


def check_texts(what: str, **texts: object) -> None:
    """Check that fields are texts without characters that steer a terminal or a page.

    Raises
    ------
    PaperDefinitionError
        With the name of the first field that is not.
    """
    for name, text in texts.items():
        if not isinstance(text, str):
            refuse(f"{what}: {name} is {_typed(text)}; expected: a text")
        if found := steering(text):
            refuse(f"{what}: {name} holds the character {found}, which pages and terminals must not get")


def check_lists(what: str, **lists: object) -> None:
    """Check that fields are lists or tuples of texts, and not a text.

    Raises
    ------
    PaperDefinitionError
        With the name of the first field that is not.
    """
    for name, values in lists.items():
        if isinstance(values, str) or not isinstance(values, Sequence):
            hint = f", as in ({shown(values)},)" if isinstance(values, str) else ""
            refuse(f"{what}: {name} is {_typed(values)}; expected: a list of texts{hint}")
        for value in values:
            check_texts(what, **{f"an element of {name}": value})


def as_keys(what: str, name: str, keys: Iterable[str]) -> tuple[str, ...]:
    """Return keys as a tuple of texts; a text would be taken for its letters, and a set has no order.

    Raises
    ------
    PaperDefinitionError
        If they are none that one can list.
    """
    if isinstance(keys, str | bytes | Set) or not isinstance(keys, Iterable):
        refuse(f"{what}: {name} is {_typed(keys)}; expected: a list of texts")
    listed = tuple(keys)
    check_lists(what, **{name: listed})
    return listed


def check_mappings(what: str, **mappings: object) -> None:
    """Check that fields are mappings from text to text.

    Raises
    ------
    PaperDefinitionError
        With the name of the first field that is not.
    """
    for name, mapping in mappings.items():
        if not isinstance(mapping, Mapping):
            refuse(f"{what}: {name} is {_typed(mapping)}; expected: texts by key")
        for key, text in mapping.items():
            check_texts(what, **{f"a key of {name}": key, f"{name} of '{key}'": text})


def as_texts(what: str, name: str, mapping: object) -> dict[str, str]:
    """Return a mapping from text to text as a dictionary of its own; nothing given is an empty one.

    Raises
    ------
    PaperDefinitionError
        If it is none.
    """
    if mapping is not None:
        check_mappings(what, **{name: mapping})
    return as_mapping(what, name, mapping)


def as_mapping(what: str, name: str, mapping: object) -> dict[Any, Any]:
    """Return a mapping as a dictionary of its own; nothing given is an empty one.

    Raises
    ------
    PaperDefinitionError
        If it is none, or a key is not a text.
    """
    if mapping is None:
        return {}
    if not isinstance(mapping, Mapping):
        refuse(f"{what}: {name} is {_typed(mapping)}; expected: a dictionary")
    for key in mapping:
        check_texts(what, **{f"a key of {name}": key})
    return dict(mapping)


def check_year(what: str, value: object) -> None:
    """Check the year of a paper.

    Raises
    ------
    PaperDefinitionError
        If it is none.
    """
    if type(value) is not int or not 1 <= value <= _LAST_YEAR:
        refuse(f"{what}: year is {shown(value)}; expected: a whole number, 1 to {_LAST_YEAR}")


def check_number(what: str, name: str, value: object) -> None:
    """Check that a field is a real number; it may be infinite.

    Raises
    ------
    PaperDefinitionError
        If it is not.
    """
    if isinstance(value, bool) or not isinstance(value, Real) or math.isnan(value):
        refuse(f"{what}: {name} is {_typed(value)}; expected: a number")


def check_count(what: str, name: str, value: object, most: int = 10**9) -> None:
    """Check that a field is a whole number, 1 or more, and at most `most`.

    Raises
    ------
    PaperDefinitionError
        If it is not.
    """
    if not isinstance(value, int) or isinstance(value, bool) or value < 1:
        refuse(f"{what}: {name} is {_typed(value)}; expected: a whole number, 1 or more")
    if value > most:
        refuse(f"{what}: {name} is {shown(value)}; expected: at most {most}")


def check_spans(what: str, spans: object) -> None:
    """Check that a field has, by cell, a list of other cells, each a pair of row and column.

    Raises
    ------
    PaperDefinitionError
        If it has not.
    """
    listed = spans.items() if isinstance(spans, Mapping) else [(spans, None)]
    for cell, others in listed:
        cells = [cell, *others] if isinstance(others, list | tuple) else [None]
        if not all(
            isinstance(one, tuple) and len(one) == 2 and all(isinstance(key, str) for key in one) for one in cells
        ):
            refuse(f"{what}: spans is {_typed(spans)}; expected: by cell a list of others, each (row, column)")


def check_one_of(what: str, name: str, value: object, allowed: Sequence[object]) -> None:
    """Check that a field has one of a few values.

    Raises
    ------
    PaperDefinitionError
        If it has not; the message lists them.
    """
    if not any(isinstance(value, type(one)) and value == one for one in allowed):
        refuse(f"{what}: {name} is {shown(value)}; allowed: {', '.join(repr(one) for one in allowed)}")


def check_kind(what: str, name: str, value: object, kind: type) -> None:
    """Check that a field is of a class of the vocabulary.

    Raises
    ------
    PaperDefinitionError
        If it is not.
    """
    if not isinstance(value, kind):
        refuse(f"{what}: {name} is {_typed(value)}; expected: {kind.__name__}(...)")


def check_size(what: str, size: object) -> None:
    """Check width and height of a figure in inches.

    Raises
    ------
    PaperDefinitionError
        If they are not two positive numbers.
    """
    fits = isinstance(size, Sequence) and not isinstance(size, str) and len(size) == 2
    if not fits or not all(isinstance(one, int | float) and math.isfinite(one) and one > 0 for one in size):  # type: ignore[attr-defined]
        refuse(f"{what}: size is {shown(size)}; expected: width and height in inches, two positive numbers")


def check_function(what: str, name: str, function: object) -> None:
    """Check that something can be called.

    Raises
    ------
    PaperDefinitionError
        If it cannot.
    """
    if not callable(function):
        refuse(f"{what}: {name} is {_typed(function)}; expected: a function")


def refuse(message: str) -> NoReturn:
    """Refuse a definition; whoever imports the paper adds file and line."""
    raise PaperDefinitionError(message)


def _typed(value: object) -> str:
    return "missing" if value is None else f"{shown(value)} ({type(value).__name__})"


def shown(value: object) -> str:
    """Return a value as Python writes it, on one short line."""
    return f"{' '.join(repr(value).split()):.60}"
