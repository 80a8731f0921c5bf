"""The words of the report: every verdict and match with its symbol, name and meaning.

A symbol always accompanies the colour, so that the report can be read without colour vision and on a
black-and-white print. None of the symbols has an emoji form that a phone would draw in its place.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Word:
    """A verdict (or match) as the report shows it; `meaning` completes the sentence "This says that ..."."""

    id: str
    symbol: str
    meaning: str

    @property
    def name(self) -> str:
        """The word as text."""
        return self.id.replace("-", " ")


VERDICTS = {
    word.id: word
    for word in (
        Word("reproduced", "✓", "as the paper says, the value rounds or truncates to the printed digits"),
        Word("reconstructed", "↻", "the printed digits come out under another, documented reading"),
        Word("near", "≈", "within two units of the last printed digit, or within one per cent"),
        Word("misprint", "✎", "the print is wrong, and the evidence shows what it should be"),
        Word("discrepant", "≠", "differs for a known, documented cause; there is no single right value"),
        Word("unexplained", "?", "differs, and no cause was found; what was tried is listed"),
        Word("not-computable", "–", "measured data, or inputs that the paper does not give"),
    )
}
"""Verdicts of printed values, best first."""

CLAIM_VERDICTS = {
    word.id: word
    for word in (
        Word("holds", "✓", "true, shown by the number beside it"),
        Word("holds-partly", "◐", "true in part, or only under conditions the paper does not name"),
        Word("fails", "✗", "false, shown by the number beside it"),
    )
}
"""Verdicts of claims, best first."""

WORDS = VERDICTS | CLAIM_VERDICTS

MATCHES = {
    "equal": ("=", "equal at the printed precision"),
    "near": ("≈", "near"),
    "differs": ("≠", "differs"),
    "none": ("", "nothing to compare"),
}
"""By kind of match: the sign in the table and its name."""

CAUSES = {
    "misprint": "misprint",
    "scan": "damaged in the copy at hand",
    "definition": "another definition",
    "method": "numerical method of the time",
    "optimiser": "optimiser stopped early",
    "rounding": "rounded intermediate values",
    "measured": "measured data",
    "unavailable": "inputs not given",
    "unknown": "unknown",
}
"""By cause of a ledger entry: how the report names it."""
