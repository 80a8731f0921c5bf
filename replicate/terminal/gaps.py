"""What of a paper cannot be computed, and why: from its definition, its ledger and the accepted state."""

from __future__ import annotations

from pathlib import Path

from replicate.diff.accepted import TableState, read_state
from replicate.exhibits import Exhibit, NotComputable, Paper, Table
from replicate.exhibits.results import TableResult
from replicate.verdicts.ledger import Ledger, LedgerEntry

LOST = ("measured", "unavailable")  # causes that leave nothing to compute


def standing(paper: Paper, exhibit: Exhibit, accepted: Path) -> str:
    """Return ``done``, ``partly`` or ``not computable``; nothing for a table that has no accepted state yet."""
    if isinstance(exhibit, NotComputable):
        return "not computable"
    if not isinstance(exhibit, Table) or not exhibit.printed:
        return "done"
    counted = _missing(paper, exhibit, accepted)
    if counted is None:
        return ""
    missing, printed = counted
    return "done" if not missing else "partly" if missing < printed else "not computable"


def reasons(paper: Paper, accepted: Path) -> dict[str, list[str]]:
    """Return why something cannot be computed, each reason with the exhibits it holds for."""
    found = dict[str, list[str]]()
    ledger = Ledger.load_all(paper.folder(), paper)
    for exhibit in paper.exhibits.values():
        if isinstance(exhibit, NotComputable):
            found.setdefault(exhibit.reason, []).append(exhibit.id)
        elif isinstance(exhibit, Table) and exhibit.printed:
            counted = _missing(paper, exhibit, accepted)
            if counted is not None and counted[0]:
                causes = dict.fromkeys(_plain(entry) for entry in ledger.of(exhibit.id) if entry.cause in LOST)
                place = f"{exhibit.id} ({counted[0]} of {counted[1]} printed values)"
                found.setdefault(" ".join(causes), []).append(place)
    return found


def _missing(paper: Paper, table: Table, accepted: Path) -> tuple[int, int] | None:
    """Return how many printed values cannot be computed, and how many there are."""
    state = read_state(accepted, paper.id, table.id, TableResult)
    if not isinstance(state, TableState):
        return None
    verdicts = {key[:2]: cell["verdict"] for key, cell in state.cells.items() if cell["printed"]}
    return sum(verdict == "not-computable" for verdict in verdicts.values()), len(verdicts)


def _plain(entry: LedgerEntry) -> str:
    """Return the sentences of an explanation before the first that pulls in a result."""
    before, pulls, _ = entry.explanation.partition("{{")
    return before.rpartition(". ")[0] + "." if pulls else before.strip()
