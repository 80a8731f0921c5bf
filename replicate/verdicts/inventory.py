"""How much of an exhibit could be computed: the one place that calls something not computable."""

from __future__ import annotations

from collections.abc import Sequence

from replicate.exhibits import Claims, Exhibit, Figure, NotComputable, Table
from replicate.exhibits.results import ClaimsResult, FigureResult, Result, TableResult
from replicate.verdicts.causes import CAUSES
from replicate.verdicts.rows import ExhibitRow, Status, VerdictRow

NOT_COMPUTED = "was not computed"


def inventory_row(paper: str, exhibit: Exhibit, result: Result | None, verdicts: Sequence[VerdictRow]) -> ExhibitRow:
    """Return the row of one exhibit.

    Parameters
    ----------
    paper
        Its id.
    result
        What computing it gave; ``None`` if it was not computed.
    verdicts
        Those on the exhibit.
    """
    match exhibit, result:
        case NotComputable(), _:
            status, reason = _none(exhibit.reason)
        case Table(), TableResult():
            status, reason = _table(result, verdicts)
        case Figure(), FigureResult():
            status, reason = _none(result.error) if result.error else ("done", "")
        case Claims(), ClaimsResult():
            status, reason = _claims(exhibit, verdicts)
        case _:
            status, reason = _none(NOT_COMPUTED)
    return ExhibitRow(paper, exhibit.id, exhibit.kind, exhibit.title, status, reason)


def _none(reason: str) -> tuple[Status, str]:
    return "not-computable", reason


def _table(result: TableResult, verdicts: Sequence[VerdictRow]) -> tuple[Status, str]:
    failed = [f"reading '{reading}' failed: {error}" for reading, error in result.errors.items()]
    if not verdicts:
        done = len(result.frames) > 0
        return ("partly" if done and failed else "done" if done else "not-computable"), "; ".join(failed)
    missing = [
        verdict
        for verdict in verdicts
        if not _given(verdict) and (verdict.verdict == "not-computable" or not any(one.text for one in verdict.values))
    ]
    if not missing:
        return "done", ""
    reason = f"{len(missing)} of {len(verdicts)} printed values cannot be computed"
    causes = sorted({CAUSES[verdict.cause] for verdict in missing if verdict.cause})
    if causes:
        reason += f" ({', '.join(causes)})"
    status: Status = "partly" if len(missing) < len(verdicts) else "not-computable"
    return status, "; ".join([reason, *failed])


def _given(verdict: VerdictRow) -> bool:
    """Say whether a reading takes the value from the print: what cannot be computed for another reason has a cause."""
    return verdict.verdict == "not-computable" and not verdict.cause


def _claims(exhibit: Claims, verdicts: Sequence[VerdictRow]) -> tuple[Status, str]:
    judged = {verdict.row for verdict in verdicts}
    failed = [id for id in exhibit.claims if id not in judged]
    if not failed:
        return "done", ""
    return ("partly" if judged else "not-computable"), f"not checked: {', '.join(failed)}"
