r"""How strong a match is: the chance that a reading that explains nothing would explain as many printed digits.

A value that comes about by accident is taken to lie, with equal probability, as far from the print on either side as
the farthest of the readings of the exhibit that give another number, but at most as far as the print is from zero. It
meets the print with the probability

.. math::

    p = \frac{u + r}{2 w},

with the unit :math:`u` of the last printed digit, the length :math:`r` of the value's range over printed inputs, and
that distance :math:`w`, and a value that is met explains :math:`-\log_{10} p` digits: a long number says more than a
short one. The digits met by accident are then a sum of independent events, and the chance :math:`P` of at least as many
as were met follows by convolution. A reading that was chosen among :math:`k` alternatives had :math:`k` chances,
:math:`1 - (1 - P)^k` together. A reading other than as written is judged by the values in which it differs from that
one.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from replicate.exhibits import AS_WRITTEN, Table
from replicate.exhibits.printed import Key, PrintedValue
from replicate.exhibits.statements import numbers_in, scaled
from replicate.verdicts.rows import Computed

LEVEL = 0.01  # a reading whose matches are less likely than this to be accidents is strong
_EVEN = 0.5  # matches that are as likely as not to be accidents say nothing
_FEWEST_NEIGHBOURS = 3  # cells of one quantity, which can tell of it
_SAME = 1e-9  # relative: readings that give the same number
_MEETS = frozenset({"equal", "consistent"})
PARTS = 100  # of a digit: how finely digits are counted
_MOST_PLACES = 100_000  # of a distribution: more than a thousand digits are counted less finely


@dataclass(frozen=True)
class Strength:
    """How strong the match of one reading with its exhibit is.

    Attributes
    ----------
    compared, met
        How many printed values the reading is judged by, and how many of them it meets.
    digits
        How many printed digits that explains: the sum of the decimal logarithms of 1/p over the values met.
    choices
        How many alternatives were tried.
    chance
        The chance that one of them explains as many digits by accident.
    lines
        By quantity: values compared, and values met.
    """

    compared: int
    met: int
    digits: float
    choices: int
    chance: float
    lines: Mapping[str, tuple[int, int]] = field(default_factory=dict)

    @property
    def strong(self) -> bool:
        """Whether an accident is unlikely."""
        return self.chance < LEVEL

    def holds_for(self, quantity: str) -> bool:
        """Whether the reading is strong and explains a quantity, not just single cells whose neighbours fail.

        It must meet half of the quantity's values, or half of the exhibit's where the quantity has too few to tell.
        """
        compared, met = self.lines.get(quantity, (0, 0))
        if compared < _FEWEST_NEIGHBOURS:
            compared, met = self.compared, self.met
        return self.strong and 2 * met >= compared

    @property
    def sentence(self) -> str:
        """The strength in one sentence.

        Examples
        --------
        >>> Strength(20, 18, 31.2, 6, 3e-25).sentence
        'Meets 18 of 20 values, 31 digits, with 6 alternatives tried: by accident once in more than a million cases.'
        >>> Strength(20, 3, 4.4, 6, 0.31).sentence
        'Meets 3 of 20 values, 4 digits, with 6 alternatives tried: by accident in 31 % of cases.'
        >>> Strength(9, 1, 0.9, 1, 0.3).sentence
        'Meets 1 of 9 values, 1 digit, with 1 alternative tried: by accident in 30 % of cases.'
        >>> Strength(1, 0, 0.0, 6, 1.0).sentence
        'Does not meet its one value.'
        >>> Strength(12, 7, 0.2, 1, 1.0).sentence
        'Meets 7 of 12 values, no more than an accident would: no evidence for this reading.'
        """
        values = f"{self.compared} value{'s' if self.compared != 1 else ''}"
        if not self.met:
            return f"Meets none of {values}." if self.compared != 1 else "Does not meet its one value."
        if self.chance >= _EVEN:
            return f"Meets {self.met} of {values}, no more than an accident would: no evidence for this reading."
        tried = f"{self.choices} alternative{'s' if self.choices != 1 else ''} tried"
        digits = f"{self.digits:.0f} digit{'s' if round(self.digits) != 1 else ''}"
        return f"Meets {self.met} of {values}, {digits}, with {tried}: {self.odds}."

    @property
    def odds(self) -> str:
        """The chance in words."""
        if self.chance >= LEVEL:
            return f"by accident in {float(f'{100 * self.chance:.2g}'):g} % of cases"
        if self.chance < 1e-6:
            return "by accident once in more than a million cases"
        return f"by accident once in {float(f'{1 / self.chance:.2g}'):.0f} cases"


def strengths(table: Table, computed: Mapping[str, Mapping[Key, Computed]]) -> dict[str, Strength]:
    """Return the strength of every reading of a table.

    Parameters
    ----------
    computed
        By reading and (row, column): what it gives for each printed value, compared with it.
    """
    return {reading: _strength(table, reading, computed) for reading in computed}


def _strength(table: Table, reading: str, computed: Mapping[str, Mapping[Key, Computed]]) -> Strength:
    cells = {key: one for key, one in computed[reading].items() if _judged(one, computed.get(AS_WRITTEN, {}).get(key))}
    odds = {key: _odds(key, reading, computed) for key in cells}
    met = {key for key, one in cells.items() if one.match.kind in _MEETS}
    digits = {key: -math.log10(p) for key, p in odds.items()}
    choices = choices_of(table, reading)
    lines: dict[str, list[Key]] = {}
    for key in cells:
        lines.setdefault(table.quantity(*key), []).append(key)
    return Strength(
        len(cells),
        len(met),
        sum(digits[key] for key in met),
        choices,
        _repeated(as_many_digits([digits[key] for key in met], list(digits.values())), choices),
        {quantity: (len(keys), len(met.intersection(keys))) for quantity, keys in lines.items()},
    )


def choices_of(table: Table, reading: str) -> int:
    """Return how many alternatives were tried to find a reading: those it declares, and at least the other readings.

    What is done as the text says has alternatives only where it leaves something open.
    """
    declared = math.prod(table.readings[reading].tried.values())
    return declared if reading == AS_WRITTEN else max(declared, len(table.readings) - 1)


def _judged(one: Computed, as_written: Computed | None) -> bool:
    """Say whether a value counts: it must not be infinite, and another one than as written."""
    if one.match.kind == "none" or (one.number is not None and not math.isfinite(one.number)):
        return False
    return one.reading == AS_WRITTEN or as_written is None or _differ(as_written, one)


def _differ(one: Computed, other: Computed) -> bool:
    """Say whether two readings give different values."""
    first, second = _numbers(one), _numbers(other)
    if not first or len(first) != len(second):
        return one.text != other.text
    return any(abs(number - rival) > _SAME * abs(number) for number, rival in zip(first, second, strict=True))


def _numbers(one: Computed) -> list[float]:
    """Return the number that a reading gives, or the two of a pair; none for a word, or if it gives nothing."""
    if one.word:
        return [float(number) for number in numbers_in(one.word)]
    return [one.number] if one.number is not None and math.isfinite(one.number) else []


def _odds(key: Key, reading: str, computed: Mapping[str, Mapping[Key, Computed]]) -> float:
    """Return the probability that a value meets its print by accident; both numbers of a pair must."""
    one = computed[reading][key]
    stated = _stated(one.printed) if one.printed is not None else []
    if not stated:
        return 0.5  # a bound or a word: one of two
    others = [other[key] for id, other in computed.items() if id != reading and key in other]
    rivals = [_numbers(other) for other in others if _differ(other, one)]
    spread = 0.0 if one.lower is None or one.upper is None else one.upper - one.lower
    return math.prod(
        _chance(*stated[place], spread, [rival[place] for rival in rivals if len(rival) > place])
        for place in range(min(len(stated), len(_numbers(one))))
    )


def _stated(value: PrintedValue) -> list[tuple[float, float]]:
    """Return each number that a print states to its last digit, with the unit of that digit."""
    statement = value.statement
    if not value.states_number and statement.kind != "interval":
        return []
    second = statement.upper or statement.uncertainty
    parts = [(value.value, value.unit)] + ([scaled(replace(statement, text=second))] if second else [])
    return [(float(number), float(unit)) for number, unit in parts]


def _chance(printed: float, unit: float, spread: float, rivals: Sequence[float]) -> float:
    """Return the probability that a number meets a print by accident, given what other readings give."""
    distances = [abs(number - printed) for number in rivals]
    limit = abs(printed) or max([*distances, unit])
    width = min(max(distances, default=limit), limit)
    return min((unit + spread) / (2 * width), 1.0) if width else 1.0


def as_many_digits(met: Sequence[float], possible: Sequence[float]) -> float:
    """Return the probability that independent accidents explain at least as many digits as were explained.

    Parameters
    ----------
    met
        The digits of each value that was met.
    possible
        The digits d of every value; an accident meets it with the probability 10^-d.

    Examples
    --------
    One of two numbers of two digits was met; then a number of four digits beside one of one digit.

    >>> round(as_many_digits([2.0], [2.0, 2.0]), 6), round(as_many_digits([4.0], [4.0, 1.0]), 6)
    (0.0199, 0.0001)
    """
    parts = min(PARTS, _MOST_PLACES / max(sum(met), 1.0))
    goal = sum(round(parts * digits) for digits in met)
    reached = np.zeros(goal + 1)  # the probability of so many parts of digits, in the last place of at least so many
    reached[0] = 1.0
    for digits in possible:
        chance, step = 10.0**-digits, min(round(parts * digits), goal)
        happened = chance * reached
        reached *= 1.0 - chance
        reached[step:] += happened[: goal + 1 - step]
        reached[goal] += happened[goal + 1 - step :].sum()
    return min(float(reached[goal]), 1.0)


def _repeated(chance: float, choices: int) -> float:
    """Return the chance that one of several independent attempts succeeds."""
    return -math.expm1(choices * math.log1p(-chance)) if chance < 1.0 else 1.0
