"""One difference from the accepted state, and how numbers are compared and shown."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from replicate.figures.differences import Difference, Layer

_DIGITS = (6, 7, 8, 9)

Kind = Literal[
    "value", "verdict", "printed", "words", "curve", "axes", "look", "new", "removed", "altered", "failed", "damaged"
]


@dataclass(frozen=True)
class Change:
    """One difference from the accepted state.

    Attributes
    ----------
    text
        What changed, in words.
    where
        The cell (``row column (reading)``), curve (``panel / curve``) or property it is about; empty for the
        whole exhibit.
    before, after
        The two values, as text.
    size
        How much a curve moved, as a fraction of its axes; how much a number moved, as a fraction of itself.
    layer
        Of a figure: whether a reader noticed that knows what it sees, or the safety net.
    """

    paper: str
    exhibit: str
    kind: Kind
    text: str
    where: str = ""
    before: str = ""
    after: str = ""
    size: float | None = None
    layer: Layer = "named"

    @classmethod
    def of_figure(cls, paper: str, exhibit: str, found: Difference) -> Change:
        """Return what differs in a figure as a change of the exhibit."""
        where, size = found.where, found.size
        text = found.text + (" (noticed by the safety net)" if found.layer == "net" else "")
        return cls(paper, exhibit, found.kind, text, where, found.before, found.after, size, found.layer)

    def __str__(self) -> str:
        """Return the whole sentence, for the terminal and the log."""
        return f"{self.paper}/{self.exhibit}: {self.text}"


def moved(before: str, after: str) -> str:
    """Return two values with an arrow between them: as many digits as tell them apart, and by how much.

    Examples
    --------
    >>> moved("13.0561234", "13.0702345"), moved("0.5", ""), moved("1", "2.5"), moved("1e-05", "2e-05")
    ('13.0561 -> 13.0702 (+0.11 %)', '0.5 -> nothing', '1 -> 2.5', '1e-05 -> 2e-05')
    >>> moved("2.00000012", "2.00000098")
    '2 -> 2.000001 (+4.3e-05 %)'
    """
    size = relative(before, after)
    if size is None:
        return f"{before or 'nothing'} -> {after or 'nothing'}"
    one, other = before, after
    for digits in _DIGITS:
        one, other = (f"{float(text):.{digits}g}" for text in (before, after))
        if one != other:
            break
    percent = f" ({100 * size:+.2g} %)" if abs(size) < 1.0 else ""
    return f"{one} -> {other}{percent}"


def relative(before: str, after: str) -> float | None:
    """Return by which fraction of itself a number changed; ``None`` if one of the texts is not a number."""
    try:
        one, other = float(before), float(after)
    except ValueError:
        return None
    return (other - one) / abs(one) if one else math.copysign(math.inf, other)
