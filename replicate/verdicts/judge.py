"""The verdict on every printed value and claim of a paper, and everything that speaks against accepting them.

`judge` is a pure function of the paper's description, its printed numbers, its ledger and the results of a
run: it draws nothing, computes no exhibit and writes no file. What goes wrong in one exhibit becomes a
*problem*, one line that names the place, and never hides the verdicts on the others; only a malformed data
file raises.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace

from replicate.errors import TemplateError
from replicate.exhibits import Claims, Exhibit, Figure, NotComputable, Paper, Table
from replicate.exhibits.printed import Key, PrintedValue, read_printed
from replicate.exhibits.results import ClaimsResult, FigureResult, Result, TableResult
from replicate.verdicts.claims import judge_claims
from replicate.verdicts.ledger import Ledger, LedgerEntry
from replicate.verdicts.prose import Prose
from replicate.verdicts.rows import ExhibitRow, Judgement, ResultRow, Status, VerdictRow
from replicate.verdicts.tables import TableJudge

__all__ = ["ExhibitRow", "Judgement", "ResultRow", "VerdictRow", "judge", "read_all_printed"]

Printed = Mapping[str, Mapping[Key, PrintedValue]]


def read_all_printed(paper: Paper) -> dict[str, dict[Key, PrintedValue]]:
    """Read the printed numbers of every table of a paper, by exhibit id.

    Raises
    ------
    PrintedFileError
        If a file is missing or malformed.
    """
    folder = paper.load().folder() / "printed"
    return {
        id: read_printed(folder / f"{id}.csv", exhibit)
        for id, exhibit in paper.exhibits.items()
        if isinstance(exhibit, Table) and exhibit.printed
    }


def judge(
    paper: Paper,
    results: Mapping[tuple[str, str], Result],
    *,
    exhibits: Collection[str] | None = None,
    printed: Printed | None = None,
    ledger: Ledger | None = None,
) -> Judgement:
    """Compare what a run computed with what the paper prints.

    Parameters
    ----------
    paper
        The paper; it is loaded if it is not yet.
    results
        By (paper, exhibit); results of other papers are ignored.
    exhibits
        The exhibits to judge, for a partial run. Default: all, and a missing result is a problem.
    printed, ledger
        The paper's printed numbers and ledger. Default: read from its folder.

    Returns
    -------
    Judgement
        Rows in the order of the paper, its rows, columns and readings.

    Raises
    ------
    PrintedFileError, LedgerError
        If a data file of the paper is malformed.
    """
    paper.load()
    printed = read_all_printed(paper) if printed is None else printed
    ledger = Ledger.load_all(paper.folder(), paper) if ledger is None else ledger
    judgement = Judgement()
    if exhibits is None:
        judgement.problems.extend(
            f"{paper.id}: numbered exhibit '{id}' is not in the inventory"
            for id in paper.numbered
            if id not in paper.exhibits
        )
    explained: list[tuple[int, LedgerEntry]] = []
    for id, exhibit in paper.exhibits.items():
        if exhibits is not None and id not in exhibits:
            continue
        result = results.get((paper.id, id))
        if isinstance(exhibit, NotComputable):
            judgement.exhibits.append(_row(paper, exhibit, "not-computable", exhibit.reason))
        elif isinstance(exhibit, Table) and isinstance(result, TableResult):
            values = printed.get(id, {}) if exhibit.printed else {}
            table = TableJudge(paper.id, exhibit, result, values, ledger)
            explained += [(len(judgement.verdicts) + index, entry) for index, entry in table.judge()]
            judgement.extend(table.judgement)
            judgement.exhibits.append(_row(paper, exhibit, *table.status()))
        elif isinstance(exhibit, Figure) and isinstance(result, FigureResult):
            if result.error:
                judgement.problems.append(f"{paper.id} {id}: drawing failed: {result.error}")
            status: Status = "not-computable" if result.error else "done"
            judgement.exhibits.append(_row(paper, exhibit, status, result.error))
        elif isinstance(exhibit, Claims) and isinstance(result, ClaimsResult):
            judgement.extend(judge_claims(paper.id, exhibit, result))
        else:
            judgement.problems.append(f"{paper.id} {id}: was not computed")
            judgement.exhibits.append(_row(paper, exhibit, "not-computable", "was not computed"))
    _explain(paper, results, judgement, ledger, explained)
    return judgement


def _row(paper: Paper, exhibit: Exhibit, status: Status, reason: str) -> ExhibitRow:
    return ExhibitRow(paper.id, exhibit.id, exhibit.kind, exhibit.title, status, reason)


def _explain(
    paper: Paper,
    results: Mapping[tuple[str, str], Result],
    judgement: Judgement,
    ledger: Ledger,
    explained: list[tuple[int, LedgerEntry]],
) -> None:
    """Fill the results into the explanations; they may speak of any verdict, so all must be known by now."""
    prose = Prose(paper, results, judgement.verdicts)
    for index, entry in explained:
        verdict = judgement.verdicts[index]
        try:
            text = prose.render(
                verdict.explanation, entry.file or ledger.name, entry.line, row=verdict.row, column=verdict.column
            )
        except TemplateError as error:
            text = f"(This text cannot be shown: {error})"
            if str(error) not in judgement.problems:
                judgement.problems.append(str(error))
        judgement.verdicts[index] = replace(verdict, explanation=text)
