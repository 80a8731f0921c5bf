"""How the evidence of claims writes numbers."""

from __future__ import annotations

from collections.abc import Mapping


def number(value: float, digits: int = 4) -> str:
    """Write a number with so many significant digits.

    Examples
    --------
    >>> number(0.3447381), number(-0.0)
    ('0.3447', '0')
    """
    return f"{value + 0.0:.{digits}g}"


def listed(values: Mapping[str, float], digits: int = 4) -> str:
    """Write named numbers as ``1.2 (name), ...``.

    Examples
    --------
    >>> listed({"PI": 81.66, "PID": 51.3})
    '81.66 (PI), 51.3 (PID)'
    """
    return ", ".join(f"{number(value, digits)} ({name})" for name, value in values.items())
