"""The id of a form: enough to make a sheet again, and nothing about the student but a code that seed and id lead to."""

from __future__ import annotations

import hashlib
import re
from dataclasses import dataclass
from urllib.parse import quote, unquote

from replicate.errors import ReplicateError

_KEY = re.compile(r"[0-9a-f]{12}")


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
        Twelve hexadecimal digits of a hash of seed and student.

    Examples
    --------
    >>> form = Form.of("bayhan", "2026 W", "Ada")
    >>> Form.read(str(form)) == form
    True
    """

    paper: str
    seed: str
    key: str

    @classmethod
    def of(cls, paper: str, seed: str, student: str) -> Form:
        """Return the form of a student."""
        return cls(paper, seed, hashlib.sha256(f"{seed}\0{student}".encode()).hexdigest()[:12])

    @classmethod
    def read(cls, text: str) -> Form:
        """Return the form of an id.

        Raises
        ------
        ReplicateError
            If it is none.
        """
        paper, _, rest = text.strip().partition(":")
        key, _, seed = rest.partition(":")
        if not paper or not _KEY.fullmatch(key):
            msg = f"the form is '{text}', allowed: PAPER:KEY:SEED as printed on a sheet, KEY with 12 hexadecimal digits"
            raise ReplicateError(msg)
        return cls(paper, unquote(seed), key)

    def __str__(self) -> str:
        """Return the id as printed on every page."""
        return f"{self.paper}:{self.key}:{quote(self.seed, safe='')}"

    @property
    def draw(self) -> str:
        """What the numbers of its exercises are drawn from."""
        return f"{self.seed}\0{self.key}"
