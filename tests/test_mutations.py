"""Every verdict is earned: a changed digit changes it, and an unexplained one does not pass.

The results are those of a full run of every paper; they come from the same cache as `make report` and `make check`.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from decimal import ROUND_CEILING, ROUND_FLOOR, Decimal
from pathlib import Path

import pytest
from kept_results import kept_results

from replicate.diff.check import check
from replicate.exhibits import Paper
from replicate.exhibits.printed import PrintedValue
from replicate.run.library import Library
from replicate.run.outcome import Outcome, recompute
from replicate.verdicts.inputs import Inputs, read_inputs
from replicate.verdicts.judge import judge
from replicate.verdicts.rows import Computed

ROOT = Path(__file__).parent.parent
HOLDS = {"reproduced", "consistent", "reconstructed", "near"}
EXPLAINED = {"misprint", "damaged", "discrepant", "unexplained", "not-computable"}

PAPERS = {paper.id: paper for paper in Library(bundled=True).papers()}


@pytest.fixture(scope="module", params=sorted(PAPERS))
def outcome(request: pytest.FixtureRequest) -> Outcome:
    with kept_results() as kept:
        return recompute([PAPERS[request.param]], cache_dir=kept)


def altered(text: str, by: int = 3) -> str:
    """Change the leading digit by a few units: '1.43' -> '4.43', '-0.52' -> '-0.82', '0' -> '3'."""
    place = next((i for i, c in enumerate(text) if c.isdigit() and c != "0"), None)
    if place is None:
        place = text.index("0")
    digit = int(text[place])
    return text[:place] + str(digit + by if digit + by <= 9 else digit - by) + text[place + 1 :]


def test_altering() -> None:
    assert [altered(t) for t in ("1.43", "-0.52", "0", "0.00", "972", "8e-3")] == [
        "4.43",
        "-0.82",
        "3",
        "3.00",
        "672",
        "5e-3",
    ]


def _mutants(paper: Paper, cells: Collection[tuple[str, str, str]], by: int) -> Inputs:
    inputs = read_inputs(paper)
    printed = {
        exhibit: {
            key: PrintedValue(altered(value.text, by), *key, value.line, significant_digits=value.significant_digits)
            if (exhibit, *key) in cells
            else value
            for key, value in values.items()
        }
        for exhibit, values in inputs.printed.items()
    }
    return Inputs(printed, inputs.ledger)


def test_an_altered_print_changes_its_verdict_and_fails_check(outcome: Outcome) -> None:
    (paper,) = outcome.papers
    before = outcome.judgements[paper.id]
    cells = {(v.exhibit, v.row, v.column) for v in before.verdicts if v.verdict in HOLDS}
    assert cells
    after = judge(paper, outcome.results, _mutants(paper, cells, 3))
    old = {(v.exhibit, v.row, v.column): v.verdict for v in before.verdicts}
    new = {(v.exhibit, v.row, v.column): v.verdict for v in after.verdicts}
    unchanged = {cell for cell in cells if new[cell] == old[cell]}
    # among many readings one may meet the mutant by chance; it will not meet a second one
    again = judge(paper, outcome.results, _mutants(paper, unchanged, 2))
    assert not sorted(
        (v.exhibit, v.row, v.column)
        for v in again.verdicts
        if (v.exhibit, v.row, v.column) in unchanged and v.verdict == old[v.exhibit, v.row, v.column]
    )
    assert len(unchanged) <= max(1, len(cells) // 100)
    changed = cells - unchanged
    told = "\n".join(check(replace(outcome, judgements={paper.id: after}), ROOT / "figures"))
    silent = sorted(cell for cell in changed if cell[0] not in told or cell[1] not in told)
    assert not silent


def _beyond(value: PrintedValue, computed: Computed, side: int) -> str:
    """Return the print nearest to the range of a consistent value that no number of the range rounds to."""
    assert computed.upper is not None
    assert computed.lower is not None
    end = Decimal(repr(computed.upper if side > 0 else computed.lower)) + side * value.unit
    rounding = ROUND_CEILING if side > 0 else ROUND_FLOOR
    return f"{end.quantize(value.unit, rounding=rounding):f}"


@pytest.mark.parametrize("side", [1, -1])
def test_a_consistent_value_altered_beyond_its_interval_is_not_consistent(outcome: Outcome, side: int) -> None:
    (paper,) = outcome.papers
    inputs = read_inputs(paper)
    verdicts = outcome.judgements[paper.id].verdicts
    cells = {
        (row.exhibit, row.row, row.column): next(one for one in row.values if one.reading == row.reading)
        for row in verdicts
        if row.verdict == "consistent"
    }
    printed = {
        exhibit: {
            key: replace(value, text=_beyond(value, cells[exhibit, *key], side)) if (exhibit, *key) in cells else value
            for key, value in values.items()
        }
        for exhibit, values in inputs.printed.items()
    }
    after = judge(paper, outcome.results, Inputs(printed, inputs.ledger))
    still = [
        (row.exhibit, row.row, row.column)
        for row in after.verdicts
        if (row.exhibit, row.row, row.column) in cells and row.verdict == "consistent"
    ]
    assert not still
    told = "\n".join(check(replace(outcome, judgements={paper.id: after}), ROOT / "figures"))
    assert not [cell for cell in cells if f"{cell[1]} {cell[2]}" not in told]


def test_a_verdict_without_its_ledger_entry_fails_check(outcome: Outcome) -> None:
    (paper,) = outcome.papers
    before = outcome.judgements[paper.id]
    cells = [(v.exhibit, v.row, v.column) for v in before.verdicts if v.verdict in EXPLAINED and v.cause]
    after = judge(paper, outcome.results, Inputs(read_inputs(paper).printed))
    told = "\n".join(after.problems)
    changed = {(v.exhibit, v.row, v.column): v.verdict for v in after.verdicts}
    old = {(v.exhibit, v.row, v.column): v.verdict for v in before.verdicts}
    silent = [
        (exhibit, row, column)
        for exhibit, row, column in cells
        if changed[exhibit, row, column] == old[exhibit, row, column]
        and f"{exhibit}: row '{row}', column '{column}'" not in told
    ]
    assert not silent


def test_the_paper_as_it_is_passes(outcome: Outcome) -> None:
    assert check(outcome, ROOT / "figures") == []
