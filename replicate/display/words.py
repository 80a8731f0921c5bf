"""The words of the report: every verdict and match with its symbol, name and meaning.

A symbol always accompanies the colour, so that the report can be read without colour vision and on a
black-and-white print. None of the symbols has an emoji form that a phone would draw in its place.
"""

from __future__ import annotations

from dataclasses import dataclass

from replicate.verdicts.causes import CAUSES
from replicate.verdicts.rows import Certainty, VerdictRow


@dataclass(frozen=True)
class Word:
    """A verdict as the report shows it: its symbol, its meaning, and its plural where that differs."""

    id: str
    symbol: str
    meaning: str
    plural: str = ""

    @property
    def name(self) -> str:
        """The word as text."""
        return self.id.replace("-", " ")

    def counted(self, count: int) -> str:
        """Return the word with a count before it: "1 holds", "12 hold"."""
        return f"{count} {self.plural if self.plural and count != 1 else self.name}"


VERDICTS = {
    word.id: word
    for word in (
        Word(
            "reproduced",
            "✓",
            "as the paper says, the value rounds (truncates, if its column does) to the printed digits",
        ),
        Word("consistent", "∈", "inputs that round to the printed ones give a value that rounds to the printed digits"),
        Word("reconstructed", "↻", "equal under another, documented reading"),
        Word("near", "≈", "within two units of the last digit or one per cent, or truncated where its column rounds"),
        Word("misprint", "✎", "the print is wrong in any copy; the evidence shows what it should be", "misprints"),
        Word("damaged", "⊘", "wrong in the print or in our copy of it; the evidence shows what it should be"),
        Word("discrepant", "≠", "differs for a known, documented cause; there is no single right value"),
        Word("unexplained", "?", "differs, and no cause was found; what was tried is listed"),
        Word("not-computable", "–", "measured data, given numbers, or inputs that the paper does not give"),
    )
}
"""Verdicts of printed values, best first."""

CLAIM_VERDICTS = {
    word.id: word
    for word in (
        Word("holds", "✓", "true, as the number beside it shows", "hold"),
        Word("holds-partly", "◐", "true in part, or only under conditions the paper does not name", "hold partly"),
        Word("undecided", "○", "the paper gives too little to call it true or false"),
        Word("fails", "✗", "false, as the number beside it shows", "fail"),
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

CERTAINTIES: dict[Certainty, str] = {
    "proof": "none of which gives the print, by proof",
    "joint-proof": "none of which gives the print and the rest of its case, by proof",
    "search": "none of which gives the print, by search",
    "joint-search": "none of which gives the print and the rest of its case, by search",
}
"""By what is known of printed inputs that give the print, where none do: what is said of it."""


def cause(verdict: VerdictRow) -> str:
    """Return the cause of a verdict in words; empty where the verdict says as much itself."""
    if not verdict.cause or verdict.cause in {"unknown", verdict.verdict}:
        return ""
    return CAUSES[verdict.cause]


CONSEQUENCES = {
    word.id: word
    for word in (
        Word("safety", "!!", "a statement about stability or robustness flips"),
        Word("formula", "!", "the printed formula gives a wrong result"),
        Word("comparison", "⇅", "a ranking or an inequality of the paper flips"),
        Word("none", "", "changes nothing that the paper uses the number for"),
    )
}
"""Of an error: what follows from it, worst first."""
