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
        Word("consistent", "∈", "inputs that round to the printed ones give a value that rounds to the printed digits"),
        Word("reconstructed", "↻", "the printed digits come out under another, documented reading"),
        Word("near", "≈", "within two units of the last printed digit, or within one per cent"),
        Word("misprint", "✎", "the print is wrong, whatever copy one reads; the evidence shows what it should be"),
        Word("damaged", "⊘", "wrong in the print or in our copy of it; the evidence shows what it should be"),
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
        Word("undecided", "○", "what the paper gives does not suffice to call it true or false"),
        Word("fails", "✗", "false, shown by the number beside it"),
    )
}
"""Verdicts of claims, best first."""

WORDS = VERDICTS | CLAIM_VERDICTS

MATCHES = {
    "equal": ("=", "equal at the printed precision"),
    "consistent": ("∈", "equal within the rounding of the printed inputs"),
    "near": ("≈", "near"),
    "differs": ("≠", "differs"),
    "none": ("", "nothing to compare"),
}
"""By kind of match: the sign in the table and its name."""

CAUSES = {
    "misprint": "misprint",
    "print-or-copy": "in the paper or in the copy at hand",
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

CONSEQUENCES = {
    word.id: word
    for word in (
        Word("safety", "!!", "a statement on stability or robustness flips"),
        Word("formula", "!", "who types the printed formula gets a wrong controller"),
        Word("comparison", "⇅", "a ranking or an inequality of the paper flips"),
        Word("none", "", "nothing that the paper uses the number for changes"),
    )
}
"""Of an error: what follows from it, worst first."""
