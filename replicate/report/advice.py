"""What a reader may do with a paper's numbers: cite them, use the corrected ones, or leave them alone."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from replicate.report.views import ExhibitView
from replicate.verdicts.rows import CLAIM_COLUMN, HOLDING


@dataclass(frozen=True)
class Advice:
    """Exhibits by what can be done with their printed numbers.

    Attributes
    ----------
    safe
        Every number that can be computed holds.
    corrected
        Some numbers are wrong, and the right ones are given.
    beware
        Some numbers differ, and no single right value replaces them.
    """

    safe: list[ExhibitView] = field(default_factory=list)
    corrected: list[ExhibitView] = field(default_factory=list)
    beware: list[ExhibitView] = field(default_factory=list)


def advice(exhibits: Iterable[ExhibitView]) -> Advice:
    """Sort the exhibits that print numbers; one whose numbers cannot be computed is in no list."""
    found = Advice()
    for exhibit in exhibits:
        verdicts = [one for one in exhibit.verdicts if one.column != CLAIM_COLUMN and one.verdict != "not-computable"]
        if not verdicts:
            continue
        wrong = [one for one in verdicts if one.verdict not in HOLDING]
        if not wrong:
            found.safe.append(exhibit)
        elif all(one.corrected or one.verdict == "near" for one in wrong):
            found.corrected.append(exhibit)
        else:
            found.beware.append(exhibit)
    return found
