"""When a number meets a print, for exhibits that weigh printed numbers as evidence."""

from __future__ import annotations


def meets(printed: str, value: float) -> bool:
    """Return whether a value, not negative, rounds or truncates to a printed number.

    Examples
    --------
    >>> meets("3.84", 3.8361), meets("3.84", 3.8499), meets("3.84", 3.8501), meets("3.84", 3.834)
    (True, True, False, False)
    """
    unit = 10.0 ** -len(printed.partition(".")[2])
    return -0.5 * unit <= value - float(printed) < unit
