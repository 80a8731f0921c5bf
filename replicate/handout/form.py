"""The id of a form: enough to make a sheet again, and nothing about the student but a code that seed and id lead to.

Two of its digits are computed from all others, so that a mistyped id does not make the sheet of nobody.
"""

from __future__ import annotations

import hashlib
import re
from dataclasses import dataclass
from urllib.parse import quote, unquote

from replicate.errors import ReplicateError

_KEY = re.compile(r"[0-9a-f]{12}")
_CODE = 10  # digits of the key that depend on seed and student; the others check the whole id
_NUMBERS = re.compile(r"([1-9]\d{0,2}(\.[1-9]\d{0,2})*)?")


@dataclass(frozen=True)
class Form:
    """Which sheet: of which paper, of which class set, of which student.

    Attributes
    ----------
    paper
        Its id.
    seed
        Of the class set.
    key
        Twelve hexadecimal digits: ten of a hash of seed and student, two that check the id.
    select
        The numbers of its exercises; nothing for all.

    Examples
    --------
    >>> form = Form.of("bayhan", "2026 W", "Ada")
    >>> Form.read(str(form)) == form
    True
    >>> print(Form.of("bayhan", "1", "Ada Lovelace", (2, 4)))
    bayhan:2b6cdeb0ee52:1:2.4
    """

    paper: str
    seed: str
    key: str
    select: tuple[int, ...] = ()

    @classmethod
    def of(cls, paper: str, seed: str, student: str, select: tuple[int, ...] = ()) -> Form:
        """Return the form of a student."""
        code = _digits(seed, student)[:_CODE]
        return cls(paper, seed, code + _check(paper, seed, code, select), select)

    @classmethod
    def read(cls, text: str) -> Form:
        """Return the form of an id.

        Raises
        ------
        ReplicateError
            If it is none.
        """
        paper, _, rest = text.strip().partition(":")
        key, _, rest = rest.partition(":")
        seed, _, numbers = rest.partition(":")
        if not paper or not _KEY.fullmatch(key) or not _NUMBERS.fullmatch(numbers):
            msg = (
                f"the form is '{text}', allowed: PAPER:KEY:SEED as printed on a sheet, KEY with 12 hexadecimal digits; "
                "if only some exercises are on it, also :2.4.5"
            )
            raise ReplicateError(msg)
        form = cls(paper, unquote(seed), key, tuple(int(number) for number in numbers.split(".") if number))
        if key[_CODE:] != _check(paper, form.seed, key[:_CODE], form.select):
            msg = f"the form is '{text}', which no sheet has: a letter or a digit of it is wrong"
            raise ReplicateError(msg)
        return form

    def __str__(self) -> str:
        """Return the id as printed on every page."""
        numbers = f":{'.'.join(str(number) for number in self.select)}" if self.select else ""
        return f"{self.paper}:{self.key}:{quote(self.seed, safe='')}{numbers}"

    @property
    def draw(self) -> str:
        """What the numbers of its exercises are drawn from."""
        return f"{self.seed}\0{self.key[:_CODE]}"


def _check(paper: str, seed: str, code: str, select: tuple[int, ...]) -> str:
    return _digits(paper, seed, code, *(str(number) for number in select))[:2]


def _digits(*parts: str) -> str:
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()
