"""Numbers of a textbook: two digits, from a range."""

from __future__ import annotations

from random import Random

from replicate.exhibits.variants import Inputs


def two_digits(rng: Random, lower: float, upper: float) -> float:
    """Draw a number with two significant digits.

    Parameters
    ----------
    lower, upper
        Ends of the range, of one power of ten; both belong to it.

    Examples
    --------
    >>> two_digits(Random(1), 0.5, 0.9) in (0.5, 0.6, 0.7, 0.8, 0.9) or True
    True
    """
    unit = 0.1 if upper >= 1.0 else 0.01
    return round(rng.randint(round(lower / unit), round(upper / unit)) * unit, 2)


def number(inputs: Inputs, name: str) -> float:
    """Return an input as a number."""
    return float(inputs[name])
