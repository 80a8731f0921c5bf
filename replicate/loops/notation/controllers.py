"""Controllers in text."""

from __future__ import annotations

import math
from dataclasses import fields
from typing import Any

from replicate.loops.controller import PI, PID
from replicate.loops.errors import LoopError, NotationError
from replicate.loops.notation.grammar import parse
from replicate.loops.notation.rational import NotRationalError, constant, value
from replicate.loops.notation.tokens import refuse
from replicate.loops.notation.writing import number, polynomial

ALIASES = {"kp": "k", "gain": "k", "integral_time": "ti", "derivative_time": "td"}
TIMES = ("ti", "td", "alpha")
ONLY_PID = {"kd", "td", "c", "derivative_filter", "alpha"}
Value = float | tuple[tuple[float, ...], tuple[float, ...]]


def parse_controller(text: str) -> PI | PID:
    """Return the controller that a text names.

    Parameters
    ----------
    text
        Pairs ``name=value`` with commas: ``k`` (or ``kp``) with ``ki`` and ``kd``, or with the times ``ti`` and ``td``
        of the ideal form; ``alpha`` makes it the series form with that filter; the other names are those of `PID`. A
        value is a number or arithmetic (``ki=1/3``); ``ti=inf`` switches the integral part off; ``setpoint_filter``
        may be a transfer function. Without a name of the derivative part the result is a `PI`.

    Raises
    ------
    NotationError
        If a name is unknown or given twice, a value is not a number, or the controller refuses it.

    Examples
    --------
    >>> parse_controller("k=0.6, ki=0.5, b=1")
    PI(k=0.6, ki=0.5)
    >>> parse_controller("k=2,ti=4,td=1").kd
    2.0
    """
    given, columns = _pairs(text)
    for clash in (("ki", "ti"), ("kd", "td"), ("ki", "alpha"), ("kd", "alpha")):
        if set(clash) <= given.keys():
            column = columns[clash[1]]
            refuse("controller", text, column, f"{clash[0]} and {clash[1]} cannot both be given")
    if "k" not in given:
        refuse("controller", text, 1, "the gain is missing: k=...")
    try:
        return _controller(given)
    except LoopError as error:
        refuse("controller", text, 1, str(error))


def _controller(given: dict[str, Any]) -> PI | PID:
    rest = {name: item for name, item in given.items() if name not in {"k", *TIMES}}
    if "alpha" in given:
        return PID.series(given["k"], given.get("ti", math.inf), given.get("td", 0.0), alpha=given["alpha"], **rest)
    gain = given["k"]
    if "ti" in given:
        rest["ki"] = PID.ideal(gain, given["ti"]).ki
    if "td" in given:
        rest["kd"] = PID.ideal(gain, derivative_time=given["td"]).kd
    kind = PID if ONLY_PID & given.keys() else PI
    return kind(gain, **rest)


def _pairs(text: str) -> tuple[dict[str, Value], dict[str, int]]:
    if not isinstance(text, str):
        refuse("controller", str(text), 1, f"a text is needed, not {type(text).__name__}")
    allowed = [field.name for field in fields(PID)] + list(TIMES)
    given: dict[str, Value] = {}
    columns: dict[str, int] = {}
    start = 0
    for part in text.split(","):
        column = start + 1 + len(part) - len(part.lstrip())
        name, equals, right = part.partition("=")
        key = name.strip().lower()
        key = ALIASES.get(key, key)
        if key not in allowed:
            reason = f"'{name.strip()}' is not known; allowed are {', '.join(allowed)}"
            refuse("controller", text, column, reason)
        if not equals:
            refuse("controller", text, column, f"a value is missing: {key}=...")
        if key in given:
            refuse("controller", text, column, f"{key} is given twice")
        columns[key] = column
        given[key] = _value(key, right, text, start + len(name) + 1)
        start += len(part) + 1
    return given, columns


def _value(key: str, right: str, text: str, offset: int) -> Value:
    if key == "ti" and right.strip() == "inf":
        return math.inf
    try:
        tree = parse(right, "controller")
        terms = value(tree)
    except NotationError as error:
        refuse("controller", text, offset + error.column, error.reason)
    except NotRationalError as error:
        refuse("controller", text, offset + error.column, f"{key} must be a number")
    plain = constant(tree)
    if key == "setpoint_filter" and (tree.kind == "/" or plain is None) and len(terms) == 1 and not terms[0].dead_time:
        num, den = (tuple(float(c) for c in part) for part in (terms[0].num, terms[0].den))
        return num, den
    if plain is None:
        refuse("controller", text, offset + 1, f"{key} must be a number")
    return int(plain) if key == "measurement_filter_order" and plain.denominator == 1 else float(plain)


def controller_notation(controller: PID) -> str:
    """Return the controller as a text from which `parse_controller` gives an equal controller.

    Examples
    --------
    >>> controller_notation(PI(0.6, 0.5, b=0.5))
    'k=0.6,ki=0.5,b=0.5'
    """
    always = {"k", "ki"} | (set() if isinstance(controller, PI) else {"kd"})
    parts = []
    for field in fields(PID):
        item = getattr(controller, field.name)
        if field.name in always or item != field.default:
            parts.append(f"{field.name}={_text(item)}")
    return ",".join(parts)


def _text(item: object) -> str:
    if isinstance(item, tuple):
        above, below = (polynomial(part, keep_zeros=True) for part in item)
        return f"({above})/({below})"
    return number(float(item)) if isinstance(item, (int, float)) else str(item)
