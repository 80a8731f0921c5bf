"""What the parts of a record may hold; a damaged one is named with the panel and with what is allowed.

A record is written by the program and changed by hand in reviews, so a merge or an editor may damage it. Nothing is
guessed then: half a record would look like a change of the figure.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any, NoReturn

from replicate.errors import FigureRecordError

_NEEDED = {"panel", "xlim", "ylim"}


def check_record(figure: object, panels: object) -> None:
    """Refuse what does not describe a figure.

    Raises
    ------
    FigureRecordError
        If something is missing, or is not what it must be.
    """
    if not isinstance(figure, dict):
        refuse("'figure' must be an object")
    if not isinstance(panels, list) or not all(isinstance(entry, dict) and entry.keys() >= _NEEDED for entry in panels):
        refuse(f"expected: a list of objects, each with {', '.join(sorted(_NEEDED))}")
    _check_fields(figure, "the figure")
    seen: set[str] = set()
    for entry in panels:
        where = f"panel '{entry['panel']}'"
        _check_fields(entry, where)
        for axis in "xy":
            if entry.get(f"{axis}scale") == "log" and min(entry[f"{axis}lim"]) <= 0.0 and "projection" not in entry:
                refuse(f"{axis}lim of {where} is not positive on a logarithmic axis")
        if entry["panel"] in seen:
            refuse(f"describes {where} twice; allowed: each panel once")
        seen.add(entry["panel"])


def _check_fields(entry: Mapping[str, Any], where: str) -> None:
    for name, value in entry.items():
        holds, expected = _FIELDS.get(name, (_anything, ""))
        if not holds(value):
            refuse(f"{name} of {where} is {_shown(value)}; expected: {expected}")


def refuse(why: str, line: int | None = None) -> NoReturn:
    """Raise the error that says why a text is not a record."""
    raise FigureRecordError(why, line) from None


def _shown(value: object) -> str:
    text = json.dumps(value)
    return text if len(text) <= 80 else f"{text[:80]}…"


def _anything(_: object) -> bool:
    return True


def _is_text(value: object) -> bool:
    return isinstance(value, str)


def _are_pairs(value: object) -> bool:
    return isinstance(value, list) and all(_are_texts(pair) and len(pair) == 2 for pair in value)


def _is_flag(value: object) -> bool:
    return isinstance(value, bool)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _is_count(value: object) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and value > 0


def _are_texts(value: object) -> bool:
    return isinstance(value, list) and all(map(_is_text, value))


def _are_limits(value: object) -> bool:
    return isinstance(value, list) and len(value) == 2 and all(map(_is_number, value)) and value[0] != value[1]


def _are_placed(value: object) -> bool:
    return isinstance(value, list) and all(
        isinstance(text, dict)
        and _is_text(text.get("text"))
        and all(_is_number(text.get(axis)) or _is_text(text.get(axis)) for axis in "xy")
        for text in value
    )


def _are_numbers_by_name(value: object) -> bool:
    return isinstance(value, dict) and all(map(_is_number, value.values()))


def _are_parts(value: object) -> bool:
    return isinstance(value, list) and all(
        isinstance(part, dict)
        and _is_text(part.get("name"))
        and isinstance(part.get("properties", {}), dict)
        and isinstance(part.get("field", {}), dict)
        and isinstance(part.get("marks"), list)
        and all(isinstance(mark, dict) and _is_text(mark.get("draws")) for mark in part["marks"])
        for part in value
    )


def _are_numbers(value: object) -> bool:
    return isinstance(value, list) and all(map(_is_number, value))


def _is_table(value: object) -> bool:
    return (
        isinstance(value, dict)
        and all(_are_numbers(value.get(name)) and len(value[name]) > 1 for name in ("data", "at"))
        and len(value["data"]) == len(value["at"])
    )


def _is_place(value: object) -> bool:
    return _are_numbers(value) and len(value) == 4  # type: ignore[arg-type]


def _is_polar(value: object) -> bool:
    return (
        isinstance(value, dict)
        and all(_is_number(value.get(name)) for name in ("offset", "direction"))
        and _are_limits(value.get("rlim"))
        and _are_numbers(value.get("matrix"))
        and len(value["matrix"]) == 6
        and ("rtable" not in value or _is_table(value["rtable"]))
    )


def _are_objects(value: object) -> bool:
    return isinstance(value, dict) and all(isinstance(part, dict) for part in value.values())


def _is_aspect(value: object) -> bool:
    return _is_number(value) or _is_text(value)


def _are_ellipses(value: object) -> bool:
    return isinstance(value, list) and all(_is_place(part) and min(part[2:]) > 0.0 for part in value)


def _are_ellipses_by_name(value: object) -> bool:
    return isinstance(value, dict) and all(map(_are_ellipses, value.values()))


_UNITS = ("Y", "M", "h", "m", "s")
_Field = tuple[Callable[[object], bool], str]

_TEXT: _Field = (_is_text, "a text")
_TEXTS: _Field = (_are_texts, "a list of texts")
_UNIT: _Field = (lambda value: value in _UNITS, "one of Y, M, h, m, s")
_LIMITS: _Field = (_are_limits, "two different numbers")

_FIELDS: dict[str, _Field] = {
    **dict.fromkeys(
        ("panel", "title", "xlabel", "ylabel", "xscale", "yscale", "figure_title", "projection", "depth"), _TEXT
    ),
    **dict.fromkeys(("legend", "figure_legend", "figure_texts", "points", "areas"), _TEXTS),
    **dict.fromkeys(("xlim", "ylim"), _LIMITS),
    **dict.fromkeys(("xunit", "yunit"), _UNIT),
    "revision": (_is_count, "a whole number, at least 1"),
    "hidden": (_is_flag, "true or false"),
    "texts": (_are_placed, "a list of objects, each with text, x and y"),
    **dict.fromkeys(("thinned", "streams"), (_are_numbers_by_name, "numbers by name")),
    "labels": (_are_ellipses_by_name, "lists by name, each of four numbers, the last two positive"),
    "aspect": (_is_aspect, "a number or a text"),
    "over": (_are_pairs, "a list of pairs of names"),
    "parts": (_are_parts, "a list of objects, each with name and marks"),
    "position": (_is_place, "four numbers"),
    "polar": (_is_polar, "an object with offset, direction, rlim and matrix"),
    **dict.fromkeys(("size", "view", "proportions"), (_are_numbers, "numbers")),
    **dict.fromkeys(("xtable", "ytable"), (_is_table, "an object with data and at, numbers of the same length")),
    **dict.fromkeys(("dense", "clouds"), (_are_objects, "objects by name")),
    **dict.fromkeys(("xcategories", "ycategories", "titles", "loose"), _TEXTS),
}
