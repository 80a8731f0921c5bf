"""Functions and classes of modules that everybody uses, and that code has put others in place of."""

from __future__ import annotations

import sys
from functools import cache
from typing import Any

#: Where other functions would give the next unit other numbers.
MODULES = (
    *("builtins", "math", "cmath", "decimal", "fractions", "random", "statistics", "time"),
    *("numpy", "numpy.linalg", "numpy.random", "pandas"),
    *("scipy.integrate", "scipy.linalg", "scipy.optimize", "scipy.signal", "scipy.special"),
)


@cache
def _originals(module: str) -> dict[str, Any]:
    return {name: value for name, value in vars(sys.modules[module]).items() if callable(value)}


def functions_now(module: str) -> list[int]:
    """Return which objects the names now stand for that stood for functions when this was first asked.

    Names that have come since count for nothing: modules load parts of themselves late.
    """
    now = vars(sys.modules[module])
    return [id(now.get(name)) for name in _originals(module)]


def put_back(module: str, _now: object = None) -> None:
    """Have the names of a module stand for what they stood for at first."""
    vars(sys.modules[module]).update(_originals(module))
