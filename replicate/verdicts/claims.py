"""The verdicts on the sentences of a paper: the checks have decided, here the decisions go on record."""

from __future__ import annotations

from dataclasses import replace

from replicate.exhibits import AS_WRITTEN, Claims, Finding
from replicate.exhibits.matching import computed_text, match
from replicate.exhibits.numerals import ALLOWED, parse_number
from replicate.exhibits.printed import PrintedValue
from replicate.exhibits.results import ClaimsResult
from replicate.verdicts.rows import (
    CLAIM_COLUMN,
    CLAIM_VERDICTS,
    ERRORS,
    Computed,
    Judgement,
    VerdictRow,
)


def judge_claims(paper: str, exhibit: Claims, result: ClaimsResult) -> Judgement:
    """Judge the claims of one exhibit.

    Parameters
    ----------
    paper
        Its id.

    Returns
    -------
    Judgement
        One verdict per claim. A claim whose check failed has none, and is a problem.
    """
    judgement = Judgement()
    for id, claim in exhibit.claims.items():
        place = f"{paper} {exhibit.id}: claim '{id}'"
        finding = result.findings.get(id)
        wrong = _wrong(finding, result.errors.get(id))
        if finding is None or wrong:
            judgement.problems.append(f"{place}: {wrong}")
            continue
        evidence = " ".join(finding.evidence.split())
        if not evidence and finding.verdict != "holds":
            judgement.problems.append(f"{place}: {finding.verdict}, but its evidence is empty")
        row = VerdictRow(
            paper,
            exhibit.id,
            id,
            CLAIM_COLUMN,
            claim.printed,
            finding.verdict,
            AS_WRITTEN,
            computed_text(finding.value),
            explanation=evidence,
            consequence=claim.consequence if finding.verdict in ERRORS else "",
        )
        if claim.printed and parse_number(claim.printed) is None:
            judgement.problems.append(f"{place}: printed = '{claim.printed}' is not a number; allowed: {ALLOWED}")
        elif claim.printed:
            value = PrintedValue(claim.printed)
            computed = Computed(AS_WRITTEN, finding.value, match(value, finding.value))
            row = replace(row, value=value, values=(computed,))
        judgement.verdicts.append(row)
    return judgement


def _wrong(finding: Finding | None, error: str | None) -> str:
    if error is not None:
        return f"the check failed: {error}"
    if finding is None:
        return "was not checked"
    if finding.verdict not in CLAIM_VERDICTS:
        return f"verdict '{finding.verdict}'; allowed: {', '.join(CLAIM_VERDICTS)}"
    return ""
