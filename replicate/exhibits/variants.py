"""Exercises with numbers of one's own: what is drawn for a student, the answers to it, and what a marker accepts.

Each draw starts from a hash of form key and exercise, so that it depends on no other student and no other exercise.
"""

from __future__ import annotations

import hashlib
import math
import random
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from numbers import Real
from typing import Any

from replicate.errors import PaperDefinitionError
from replicate.exhibits.definitions import check_function, check_size, check_texts

Inputs = Mapping[str, float | str]

_MOST_DIGITS = 15  # that a floating-point number has
TRIES = 1000  # draws before a seed is given up


@dataclass(frozen=True)
class Answer:
    """A number to be found, and what is accepted for it.

    Attributes
    ----------
    value
        Along the exact path.
    unit
        Of `value`; empty for a pure number.
    digits
        Significant digits to be stated; half a unit of the last one is accepted on both sides.
    tolerance
        Instead of digits: the largest absolute deviation, in the unit of `value`.
    carried
        The values of those who carry on intermediate results rounded as the text says, themselves unrounded.
    mistakes
        Wrong values by the mistake that leads to them; none of them may be accepted.
    asked
        What is asked for, in short, where it stands alone: words, and LaTeX between ``$``. If empty, its name.

    Raises
    ------
    PaperDefinitionError
        Unless the value is finite and either digits or tolerance is given.

    Examples
    --------
    >>> Answer(0.3, digits=2, carried=(0.31,)).accepted
    (0.295, 0.315)
    >>> Answer(30.0, unit="degrees", tolerance=0.5).accepts(30.6)
    False
    """

    value: float
    unit: str = ""
    digits: int | None = None
    tolerance: float | None = None
    carried: tuple[float, ...] = ()
    mistakes: Mapping[str, float] = field(default_factory=dict)
    asked: str = ""

    def __post_init__(self) -> None:
        """Check the types that Python does not, and that the answer exists."""
        for field_, holds, allowed in (
            ("value", _is_real(self.value), "a number"),
            ("unit", isinstance(self.unit, str), "a text"),
            ("digits", self.digits is None or _is_count(self.digits), "a whole number from 1 to 15"),
            ("tolerance", self.tolerance is None or _is_real(self.tolerance), "a number"),
            ("carried", _are_numbers(self.carried), "numbers: (1.2,)"),
            ("mistakes", _are_named_numbers(self.mistakes), "a dictionary of finite numbers by their words"),
            ("asked", isinstance(self.asked, str), "a text"),
        ):
            if not holds:
                msg = f"the field '{field_}' of an answer is {getattr(self, field_)!r}, allowed: {allowed}"
                raise PaperDefinitionError(msg)
        if not all(math.isfinite(value) for value in (self.value, *self.carried)):
            msg = f"an answer, exact or carried on, does not exist: {[self.value, *self.carried]}"
            raise PaperDefinitionError(msg)
        if (self.digits is None) == (self.tolerance is None):
            msg = "an answer needs either digits or tolerance"
            raise PaperDefinitionError(msg)
        margin = self.tolerance if self.digits is None else self.digits
        if margin is None or not 0 < margin < math.inf:
            msg = f"an answer has digits={self.digits}, tolerance={self.tolerance}; allowed: positive numbers"
            raise PaperDefinitionError(msg)
        for field_, plain in (
            ("value", _plain(self.value)),
            ("tolerance", None if self.tolerance is None else _plain(self.tolerance)),
            ("carried", tuple(map(_plain, self.carried))),
            ("mistakes", {words: _plain(value) for words, value in self.mistakes.items()}),
        ):
            object.__setattr__(self, field_, plain)

    @property
    def accepted(self) -> tuple[float, float]:
        """The ends of the accepted interval: the exact path and the carried ones, each with its margin."""
        paths = (self.value, *self.carried)
        return min(path - self.margin(path) for path in paths), max(path + self.margin(path) for path in paths)

    def accepts(self, value: float) -> bool:
        """Whether a stated value is in the accepted interval; its ends belong to it."""
        lower, upper = self.accepted
        slack = 1e-12 * max(abs(lower), abs(upper))  # the ends are computed in floating point
        return lower - slack <= value <= upper + slack

    def margin(self, value: float) -> float:
        """Return how far from a value its statement may be: half a unit of the last digit, or the tolerance."""
        if self.tolerance is not None:
            return self.tolerance
        assert self.digits is not None  # noqa: S101  -- for the type checker
        if value == 0.0:
            return 0.0
        return 0.5 * 10.0 ** (math.floor(math.log10(abs(value))) - self.digits + 1)


def _is_real(value: object) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool)


def _plain(value: Any) -> float:
    """Return a number, say a fraction or one of numpy's, as one that can be written in decimals."""
    return value if isinstance(value, int | float) else float(value)


def _is_count(value: object) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and 1 <= value <= _MOST_DIGITS


def _are_numbers(value: object) -> bool:
    return isinstance(value, tuple | list) and all(map(_is_real, value))


def _are_named_numbers(value: object) -> bool:
    return isinstance(value, Mapping) and all(
        isinstance(key, str) and _is_real(one) and math.isfinite(one) for key, one in value.items()
    )


Answers = Mapping[str, Answer]


@dataclass(frozen=True)
class VariedFigure:
    """A figure that shows the numbers of a form.

    Attributes
    ----------
    title, alt, size
        As of `replicate.exhibits.Figure`.
    draw
        Draws on an empty matplotlib figure: ``draw(fig, inputs=...)``.
    in_key
        Whether those who mark need it beside the numbers: what a student was to draw.
    """

    title: str
    alt: str
    draw: Callable[..., None]
    size: tuple[float, float] = (6.4, 3.0)
    in_key: bool = False

    def __post_init__(self) -> None:
        """Check the types that Python does not, and that there are words for those who cannot see it."""
        what = f"figure '{self.title}'"
        check_texts(what, title=self.title, alt=self.alt)
        check_size(what, self.size)
        check_function(what, "what draws it", self.draw)
        if not self.alt.strip():
            msg = f"{what}: alt is empty; expected: what it shows, in words"
            raise PaperDefinitionError(msg)


@dataclass(frozen=True)
class Variation:
    """An exercise whose numbers vary.

    Attributes
    ----------
    name
        By which the text asks for it.
    original
        The numbers of the handout that all share.
    variant
        Draws inputs.
    answers
        Computes the answers to inputs, by name.
    requires
        What inputs must satisfy, by the words that name it; they are drawn anew until they do.
    shown
        Computes what else the text says about inputs.
    stated
        A sentence for sheets that are marked by the key: how to round, in Markdown.
    figures
        Figures of the inputs, by the name by which the text places them.
    files
        Computes files that go with a sheet, say measured data, by the ends of their names.
    """

    name: str
    original: Inputs
    variant: Callable[[random.Random], Inputs]
    answers: Callable[[Inputs], Answers]
    requires: Mapping[str, Callable[[Inputs], bool]] = field(default_factory=dict)
    shown: Callable[[Inputs], Mapping[str, float | str]] = lambda _: {}
    stated: str = ""
    figures: Mapping[str, VariedFigure] = field(default_factory=dict)
    files: Callable[[Inputs], Mapping[str, str]] = lambda _: {}
    _drawn: dict[str, Inputs] = field(default_factory=dict, init=False, repr=False, compare=False)

    def drawn(self, key: str) -> Inputs:
        """Return the inputs of one form.

        Parameters
        ----------
        key
            What identifies the form; the same key draws the same inputs, always.

        Raises
        ------
        PaperDefinitionError
            If no draw satisfies what is required.
        """
        if key not in self._drawn:
            self._drawn[key] = self._draw(key)
        return self._drawn[key]

    def _draw(self, key: str) -> Inputs:
        digest = hashlib.sha256(f"{key}\0{self.name}".encode()).digest()
        rng = random.Random(int.from_bytes(digest, "big"))  # noqa: S311  -- numbers of an exercise, no secret
        failures = dict.fromkeys(self.requires, 0)
        for _ in range(TRIES):
            inputs = self.variant(rng)
            failed = next((words for words, holds in self.requires.items() if not holds(inputs)), None)
            if failed is None:
                return inputs
            failures[failed] += 1
        worst = max(failures, key=lambda words: failures[words])
        msg = (
            f"exercise '{self.name}': no draw of {TRIES} satisfies all that is required; "
            f"{failures[worst]} fail '{worst}'; use another seed"
        )
        raise PaperDefinitionError(msg)


def rounded(value: float, digits: int) -> float:
    """Return a number rounded to significant digits, as students carry it on.

    Examples
    --------
    >>> rounded(1.15607, 3)
    1.16
    """
    return float(f"{value:.{digits - 1}e}")
