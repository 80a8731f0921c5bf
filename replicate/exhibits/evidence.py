"""What the evidence of claims is made of: numbers and lists in a sentence, and the verdict on all members of a list."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from replicate.exhibits.claims import ClaimVerdict


def number(value: float, digits: int = 4) -> str:
    """Write a number with so many significant digits, without trailing zeros.

    Parameters
    ----------
    value
        Zero is written without a sign.
    digits
        How many significant digits at most.

    Examples
    --------
    >>> number(0.3447381), number(-0.0), number(81.66, 2)
    ('0.3447', '0', '82')
    """
    return f"{value + 0.0:.{digits}g}"


def listed(values: Mapping[str, float] | Iterable[float], digits: int = 4) -> str:
    """Write numbers one after the other, each with its name if they have names.

    Parameters
    ----------
    values
        Numbers, or numbers by name.
    digits
        How many significant digits at most.

    Examples
    --------
    >>> listed({"PI": 81.66, "PID": 51.3})
    '81.66 (PI), 51.3 (PID)'
    >>> listed([1.0, 2.0 / 3.0], 2)
    '1, 0.67'
    """
    if isinstance(values, Mapping):
        return ", ".join(f"{number(value, digits)} ({name})" for name, value in values.items())
    return ", ".join(number(value, digits) for value in values)


class Share(NamedTuple):
    """How many members of a list keep a claim, of how many, and the verdict on a claim about all of them."""

    verdict: ClaimVerdict
    kept: int
    total: int


def share(flags: Iterable[bool]) -> Share:
    """Judge a claim about all members of a list: it holds if all keep it, in part if some do.

    Parameters
    ----------
    flags
        For each member, whether it keeps the claim.

    Raises
    ------
    ValueError
        If the list is empty: of nothing, anything holds.

    Examples
    --------
    >>> share([True, False, True])
    Share(verdict='holds-partly', kept=2, total=3)
    """
    known = list(flags)
    if not known:
        msg = "there is nothing to judge: the list is empty"
        raise ValueError(msg)
    kept = sum(known)
    return Share("holds" if kept == len(known) else "holds-partly" if kept else "fails", kept, len(known))
