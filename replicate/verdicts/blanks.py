"""Cells in which the first reading computes nothing although the paper prints something: the ledger must say why.

A number that is not there by accident, such as 0/0, would otherwise pass for one that nobody can explain.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace

from replicate.exhibits import AS_WRITTEN, Paper, Table
from replicate.exhibits.printed import Key
from replicate.exhibits.results import Results, TableResult
from replicate.verdicts.inputs import Inputs
from replicate.verdicts.ledger import EXCUSING_CAUSES, Ledger


def without_blanks(papers: Collection[Paper], results: Results, inputs: Mapping[str, Inputs]) -> Results:
    """Return the results, those of a first reading that leaves a printed cell blank without an excuse as failed.

    Parameters
    ----------
    results
        By (paper, exhibit).
    inputs
        Printed numbers and ledger, by paper.
    """
    found = dict(results)
    for paper in papers:
        given = inputs[paper.id]
        for id, exhibit in paper.exhibits.items():
            result = results.get((paper.id, id))
            if isinstance(exhibit, Table) and isinstance(result, TableResult) and exhibit.printed:
                blank = list(unexcused(exhibit, blanks(exhibit, result, given.printed[id]), given.ledger))
                if blank:
                    found[paper.id, id] = _failed(result, _reason(blank))
    return found


def blanks(table: Table, result: TableResult, printed: Collection[Key]) -> list[Key]:
    """Return the printed cells, or cells that a printed number stands for, in which the first reading has nothing."""
    if AS_WRITTEN not in result.frames:
        return []
    cells = result.cells[AS_WRITTEN]
    return [
        key for key in printed if any(cells.numbers.get(cell, 0.0) is None for cell in (key, *table.spans.get(key, ())))
    ]


def unexcused(table: Table, keys: Collection[Key], ledger: Ledger) -> Iterator[Key]:
    """Yield the cells of which no entry says that they were measured, or that an input is not given."""
    excuses = [entry for entry in ledger.of(table.id) if entry.cause in EXCUSING_CAUSES]
    return (key for key in keys if not any(entry.covers(*key) for entry in excuses))


def _reason(blank: Collection[Key]) -> str:
    (row, column), *others = blank
    more = f" and {len(others)} more cell{'s' if len(others) > 1 else ''}" if others else ""
    allowed = " or ".join(f"'{cause}'" for cause in sorted(EXCUSING_CAUSES))
    return (
        f"the reading computes nothing for row '{row}', column '{column}'{more}, where the paper prints something; "
        f"allowed where an entry in ledger.toml says why: cause {allowed}"
    )


def _failed(result: TableResult, why: str) -> TableResult:
    frames = {id: frame for id, frame in result.frames.items() if id != AS_WRITTEN}
    ranges = {id: found for id, found in result.ranges.items() if id != AS_WRITTEN}
    return replace(result, frames=frames, ranges=ranges, errors={AS_WRITTEN: why, **result.errors})
