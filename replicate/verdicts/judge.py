"""The verdict on every printed value and claim of a paper, and everything that speaks against accepting them.

`judge` is a pure function of the paper's description, its printed numbers, its ledger and the results of a
run: it draws nothing, computes no exhibit and writes no file. What goes wrong in one exhibit becomes a
*problem*, one line that names the place, and never hides the verdicts on the others.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace

from replicate.errors import TemplateError
from replicate.exhibits import Claims, Figure, NotComputable, Paper, Table
from replicate.exhibits.results import ClaimsResult, FigureResult, Result, TableResult
from replicate.verdicts.claims import judge_claims
from replicate.verdicts.inputs import Inputs
from replicate.verdicts.inventory import NOT_COMPUTED, inventory_row
from replicate.verdicts.ledger import LedgerEntry
from replicate.verdicts.prose import Prose
from replicate.verdicts.rows import Judgement
from replicate.verdicts.tables import TableJudge


def judge(
    paper: Paper,
    results: Mapping[tuple[str, str], Result],
    inputs: Inputs,
    *,
    exhibits: Collection[str] | None = None,
) -> Judgement:
    """Compare what a run computed with what the paper prints.

    Parameters
    ----------
    paper
        The loaded paper.
    results
        By (paper, exhibit); results of other papers are ignored.
    inputs
        The paper's printed numbers and ledger, as `replicate.verdicts.inputs.read_inputs` returns them.
    exhibits
        The exhibits to judge, for a partial run. Default: all, and a missing result is a problem.

    Returns
    -------
    Judgement
        Rows in the order of the paper, its rows, columns and readings.
    """
    judgement = Judgement()
    if exhibits is None:
        unused = [
            f"{paper.id}: numbered exhibit '{id}' is not in the inventory; defined: {', '.join(paper.exhibits)}"
            for id in paper.numbered
            if id not in paper.exhibits
        ]
        unused += inputs.unused
        judgement.problems.extend(unused)
        judgement.unused.extend(unused)
    explained: list[tuple[int, LedgerEntry]] = []
    for id, exhibit in paper.exhibits.items():
        if exhibits is not None and id not in exhibits:
            continue
        result = results.get((paper.id, id))
        part = Judgement()
        if isinstance(exhibit, Table) and isinstance(result, TableResult):
            values = inputs.printed.get(id, {}) if exhibit.printed else {}
            table = TableJudge(paper.id, exhibit, result, values, inputs.ledger, part)
            explained += [(len(judgement.verdicts) + index, entry) for index, entry in table.judge()]
        elif isinstance(exhibit, Claims) and isinstance(result, ClaimsResult):
            part = judge_claims(paper.id, exhibit, result)
        elif isinstance(exhibit, Figure) and isinstance(result, FigureResult):
            if result.error:
                part.problems.append(f"{paper.id} {id}: drawing failed: {result.error}")
        elif not isinstance(exhibit, NotComputable):
            part.problems.append(f"{paper.id} {id}: {NOT_COMPUTED}")
        part.exhibits.append(inventory_row(paper.id, exhibit, result, part.verdicts))
        judgement.extend(part)
    _explain(paper, results, judgement, explained)
    return judgement


def _explain(
    paper: Paper,
    results: Mapping[tuple[str, str], Result],
    judgement: Judgement,
    explained: list[tuple[int, LedgerEntry]],
) -> None:
    """Fill the results into the explanations; they may speak of any verdict, so all must be known by now."""
    prose = Prose(paper, results, judgement.verdicts)
    for index, entry in explained:
        verdict = judgement.verdicts[index]
        try:
            text = prose.render(verdict.explanation, entry.file, entry.line, row=verdict.row, column=verdict.column)
        except TemplateError as error:
            text = f"(This text cannot be shown: {error})"
            if str(error) not in judgement.problems:
                judgement.problems.append(str(error))
                judgement.unreadable.append(str(error))
        judgement.verdicts[index] = replace(verdict, explanation=text)
