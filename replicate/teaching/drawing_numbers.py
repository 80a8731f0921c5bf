"""Numbers of a textbook: two digits, from a range."""

from __future__ import annotations

from random import Random

from replicate.exhibits.variants import Answers, Inputs


def two_digits(rng: Random, lower: float, upper: float) -> float:
    """Draw a number with two significant digits.

    Parameters
    ----------
    lower, upper
        Ends of the range, of one power of ten; both belong to it.

    Examples
    --------
    >>> number = two_digits(Random(1), 0.5, 0.9)
    >>> 0.5 <= number <= 0.9, float(f"{number:.2g}") == number
    (True, True)
    """
    unit = 0.1 if upper >= 1.0 else 0.01
    return round(rng.randint(round(lower / unit), round(upper / unit)) * unit, 2)


def gain_apart_from_one(rng: Random, least: float, most: float) -> float:
    """Draw a gain that is either 0.5 to 0.9 or ``least`` to ``most``: a factor that is forgotten must show.

    Examples
    --------
    >>> gain = gain_apart_from_one(Random(1), 1.1, 2.5)
    >>> 0.5 <= gain <= 0.9 or 1.1 <= gain <= 2.5
    True
    """
    return two_digits(rng, 0.5, 0.9) if rng.random() < 0.5 else two_digits(rng, least, most)


def no_common_value(inputs: Inputs) -> bool:
    """Return whether all inputs differ, so that no answer can be right with the wrong one of two."""
    return len({number(inputs, key) for key in inputs}) == len(inputs)


def no_mistake_accepted(answers: Answers) -> bool:
    """Return whether no answer's interval holds what one of the declared mistakes gives."""
    return not any(one.accepts(value) for one in answers.values() for value in one.mistakes.values())


def number(inputs: Inputs, name: str) -> float:
    """Return an input as a number."""
    return float(inputs[name])
