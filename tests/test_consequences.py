"""What follows from an error, how many digits a correction has, and where an error stands."""

from __future__ import annotations

from dataclasses import replace

import pytest
import synthetic
from synthetic import frame, printed, results

from replicate.display.addresses import anchor, pages_of
from replicate.display.consequences import consequential, errors
from replicate.errors import PaperDefinitionError
from replicate.exhibits import Finding, Table, bound, rank
from replicate.exhibits.printed import PrintedValue
from replicate.run.library import Library
from replicate.verdicts.corrections import Correction, correction
from replicate.verdicts.inputs import Inputs
from replicate.verdicts.judge import judge
from replicate.verdicts.ledger import Ledger, LedgerEntry
from replicate.verdicts.rows import VerdictRow

PLAIN = VerdictRow("toy", "table-1", "A", "x", "1.0", "reproduced", "as-written", "1")


def wrong(verdict: str, consequence: str) -> VerdictRow:
    return replace(PLAIN, verdict=verdict, consequence=consequence, row=f"{verdict} {consequence}")  # type: ignore[arg-type]


def test_errors_come_worst_first() -> None:
    mixed = [
        wrong("discrepant", "none"), PLAIN, wrong("fails", "comparison"), wrong("damaged", "formula"),
        wrong("misprint", "none"), wrong("misprint", "safety"), replace(PLAIN, verdict="unexplained"),
    ]  # fmt: skip
    assert [row.row for row in errors(mixed)] == [
        "misprint safety", "damaged formula", "fails comparison", "misprint none", "discrepant none",
    ]  # fmt: skip
    assert len(consequential(mixed)) == 3


def test_the_ledger_declares_a_consequence_and_what_the_authors_said() -> None:
    entry = LedgerEntry(
        "table-1",
        ("A",),
        ("x",),
        "misprint",
        "Why.",
        evidence="See.",
        consequence="formula",
        informed="2001",
        answer="Yes.",
    )
    judgement = judge(synthetic.paper(), results(), Inputs(printed(ax="9.2"), Ledger((entry,))))
    (found,) = [row for row in judgement.verdicts if row.row == "A" and row.column == "x"]
    assert (found.consequence, found.informed, found.answer) == ("formula", "2001", "Yes.")
    assert {row.consequence for row in judgement.verdicts if row.verdict == "reproduced"} == {""}


def test_a_claim_that_holds_has_no_consequence() -> None:
    paper = synthetic.paper()
    claims = paper.exhibits["claims"].claims  # type: ignore[union-attr]
    claims["big"] = replace(claims["big"], consequence="safety")
    for verdict, expected in (("holds", ""), ("undecided", ""), ("holds-partly", "safety"), ("fails", "safety")):
        found = {"big": Finding(verdict, 3.1, "It is."), "smooth": Finding("holds", 1.0, "")}  # type: ignore[arg-type]
        judgement = judge(paper, results(findings=found), Inputs(printed()))
        assert [row.consequence for row in judgement.verdicts if row.row == "big"] == [expected]


@pytest.mark.parametrize(
    ("neighbour", "corrected"),
    [(2.0, "12.56"), (2.02, "13"), (2.1, "10"), (2.5, "10")],  # half a unit covers 0, 1, 5 and 25 % of 12.56
)
def test_a_correction_has_no_more_digits_than_the_reading_shows_elsewhere(neighbour: float, corrected: str) -> None:
    entry = LedgerEntry("table-1", ("A",), ("x",), "print-or-copy", "Why.")
    texts = {"A": "5.47", "B": "2.00", "C": "4.00", "D": "1.00"}
    values = {(row, "x"): PrintedValue(text, row, "x") for row, text in texts.items()}
    numbers = {("A", "x"): 12.56, ("B", "x"): neighbour, ("C", "x"): 2 * neighbour, ("D", "x"): 1.0}
    assert correction(("A", "x"), entry, values, numbers) == Correction(corrected)
    stated = correction(("A", "x"), replace(entry, corrected="12.56"), values, numbers)
    assert ("more digits than its evidence" in stated.problem) == (neighbour > 2)
    assert correction(("A", "x"), replace(entry, corrected=corrected), values, numbers).text in {corrected, ""}


@pytest.mark.parametrize(
    ("wrong", "stated", "fits"),
    [
        ("5.47", "12.560", False), ("5.47", "12.56", True), ("0.57", "12.56", True), ("5", "12.6", True),
        ("5", "12.56", True),        ("0.47", "0.04712", False), ("0.47", "0.0471", True),
    ],
)  # fmt: skip
def test_a_stated_correction_has_no_more_digits_than_its_column(wrong: str, stated: str, fits: bool) -> None:
    entry = LedgerEntry("table-1", ("A",), ("x",), "print-or-copy", "Why.", corrected=stated)
    texts = {"A": wrong, "B": "2.00", "C": "4.00", "D": "1.00"}
    values = {(row, "x"): PrintedValue(text, row, "x") for row, text in texts.items()}
    numbers = {("A", "x"): float(stated), ("B", "x"): 2.0, ("C", "x"): 4.0, ("D", "x"): 1.0}
    found = correction(("A", "x"), entry, values, numbers)
    assert (found.text == stated) if fits else ("more digits than its evidence" in found.problem)


def test_a_correction_is_measured_by_cells_of_its_own_quantity() -> None:
    """Where the columns are the cases, the neighbours of a cell are the others of its row."""
    paper = synthetic.paper()
    table = paper.exhibits["table-1"]
    assert isinstance(table, Table)
    table.cases = "columns"
    entry = LedgerEntry("table-1", ("A",), ("x",), "scan", "Why.")
    run = results(frame(ax=1.26, ay=2.0, bx=9.0, by=4.0), frame(ax=1.26, ay=2.0, bx=9.0, by=4.0))
    judgement = judge(paper, run, Inputs(printed(ax="9.26"), Ledger((entry,))))
    assert judgement.verdicts[0].corrected == "1.26"


def test_one_other_cell_does_not_limit_a_correction() -> None:
    entry = LedgerEntry("table-1", ("A",), ("x",), "scan", "Why.")
    run = results(frame(ax=1.26, bx=9.0), frame(ax=1.26, bx=9.0))
    judgement = judge(synthetic.paper(), run, Inputs(printed(ax="9.2"), Ledger((entry,))))
    assert (judgement.verdicts[0].verdict, judgement.verdicts[0].corrected) == ("damaged", "1.3")


def test_every_cell_of_a_paper_has_an_address_of_its_own() -> None:
    for paper in Library(bundled=True).papers():
        pages = pages_of(paper.load())
        cells = [
            (pages[id], anchor(id, row, column))
            for id, exhibit in paper.exhibits.items()
            for row in getattr(exhibit, "rows", ())
            for column in getattr(exhibit, "columns", ())
        ]
        assert cells
        assert len(cells) == len(set(cells))


def ranked(ax: str, entry: LedgerEntry, *, computed: float) -> VerdictRow:
    """Judge the tiny paper, which says that A has the smaller x, with one print that does not hold."""
    paper = synthetic.paper()
    table = paper.exhibits["table-1"]
    assert isinstance(table, Table)
    rank(table, "x", ("A", "B"), "A has the smaller x")
    bound(table, "x", ("A",), "A is stable", below=3.5)
    run = results(frame(ax=computed), frame(ax=computed))
    return judge(paper, run, Inputs(printed(ax=ax), Ledger((entry,)))).verdicts[0]


@pytest.mark.parametrize(
    ("right", "consequence"),
    [(2.4, "none"), (3.3, "comparison"), (3.6, "safety")],  # B prints 3.0, the bound is 3.5
)
def test_what_an_error_upsets_is_computed(right: float, consequence: str) -> None:
    found = ranked("1.0", LedgerEntry("table-1", ("A",), ("x",), "misprint", "Why."), computed=right)
    assert (found.verdict, found.consequence) == ("misprint", consequence)
    assert ("this does not follow from the table" in found.explanation) == (consequence != "none")


def test_a_worse_consequence_that_is_declared_stays() -> None:
    entry = LedgerEntry("table-1", ("A",), ("x",), "misprint", "Why.", evidence="E.", consequence="formula")
    assert ranked("1.0", entry, computed=3.3).consequence == "formula"


def test_a_number_by_another_definition_upsets_nothing() -> None:
    entry = LedgerEntry("table-1", ("A",), ("x",), "definition", "Why.")
    found = ranked("1.0", entry, computed=3.3)  # as a misprint it would upset the ranking
    assert (found.verdict, found.consequence) == ("discrepant", "none")


def test_a_comparison_of_what_is_not_there_is_refused() -> None:
    table = synthetic.paper().exhibits["table-1"]
    assert isinstance(table, Table)
    with pytest.raises(PaperDefinitionError, match="table-1: there is no cell in row 'C', column 'x' to compare"):
        rank(table, "x", ("A", "C"), "C is larger")
    with pytest.raises(PaperDefinitionError, match="two or more"):
        rank(table, "x", ("A",), "A is larger")
    with pytest.raises(PaperDefinitionError, match="a bound has no end"):
        bound(table, "x", ("A",), "A is bounded")
