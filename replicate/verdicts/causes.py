"""Why a print is not what is computed: the causes that a ledger may name, and how a reader is told of them."""

from __future__ import annotations

from typing import Literal

Cause = Literal[
    "misprint",
    "print-or-copy",
    "scan",
    "definition",
    "method",
    "optimiser",
    "rounding",
    "measured",
    "unavailable",
    "unknown",
]
CAUSES: dict[Cause, str] = {
    "misprint": "misprint",
    "print-or-copy": "in the paper or in the copy at hand",
    "scan": "in the copy at hand",
    "definition": "another definition",
    "method": "numerical method of the time",
    "optimiser": "optimiser stopped early",
    "rounding": "rounded intermediate values",
    "measured": "measured data",
    "unavailable": "inputs not given",
    "unknown": "unknown",
}
CORRECTING_CAUSES: frozenset[Cause] = frozenset({"misprint", "print-or-copy", "scan"})
