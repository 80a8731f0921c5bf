"""What papers of other fields print, and how each print is compared."""

from __future__ import annotations

import datetime as dt
import math
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from replicate.errors import PaperDefinitionError, PrintedFileError
from replicate.exhibits import Near, Notation, Paper, Table
from replicate.exhibits.frame_check import checked_frame
from replicate.exhibits.matching import match
from replicate.exhibits.notation import PLAIN
from replicate.exhibits.printed import PrintedValue, read_printed
from replicate.exhibits.results import TableResult
from replicate.exhibits.statements import given_text
from replicate.verdicts.inputs import Inputs
from replicate.verdicts.judge import judge

BOUND = Notation(bounds=True)
STARS = Notation(stars=True)
COMMA = Notation(decimal=",", thousands=".")
PAIR = Notation(uncertainty=True)
ENDS = Notation(interval="ends")
WORDS = Notation(words=("unstable", "n.s."))


def kind(text: str, given: object, notation: Notation = PLAIN) -> str:
    value = PrintedValue(text, notation=notation)
    if isinstance(given, int | float):
        return match(value, float(given)).kind
    return match(value, None, word=given_text(given) or "").kind


@pytest.mark.parametrize(
    ("text", "notation", "equal", "differs"),
    [
        ("<0.001", BOUND, 0.0004, 0.0016),
        ("< .05", BOUND, 0.0, 0.06),
        ("≤ 0.05", BOUND, 0.049, 0.06),
        (">10", BOUND, 10.5, 9.0),
        ("0.12***", STARS, 0.1249, 0.20),
        ("0.12 †", STARS, 0.1249, 0.20),
        ("(0.045)", Notation(parentheses="negative"), -0.0451, 0.045),
        ("(0.045)", Notation(parentheses="standard-error"), 0.0451, -0.045),
        ("3.4 ± 0.2", PAIR, 3.41, 3.9),
        ("3.4(2)", PAIR, 3.36, 3.9),
        ("3.4 ± 0.2", PAIR, (3.41, 0.21), (3.41, 0.9)),
        ("1.234(12)", PAIR, (1.2341, 0.0121), (1.2341, 0.12)),
        ("(3.4 ± 0.2) × 10^-3", PAIR, (0.00341, 0.00021), (3.41, 0.21)),
        ("(3.4±0.2)e-3", PAIR, (0.00341, 0.00021), (0.00341, 0.21)),
        ("3.4(2)×10⁻³", PAIR, (0.00341, 0.00021), (0.00341, 0.21)),
        ("103.4(1.2)", PAIR, (103.41, 1.21), (103.41, 0.12)),
        ("3.4e3 ± 2e2", PAIR, (3390.0, 210.0), (3390.0, 900.0)),
        ("-1.234,5(12) · 10^3", Notation(uncertainty=True, decimal=",", thousands="."), (-1234504.0, 1190.0), -1.2),
        ("1.6021766208(98)×10^-19", PAIR, (1.60217662080e-19, 9.8e-28), (1.6021766208e-19, 9.8e-19)),
        ("12 ± 3 %", Notation(uncertainty=True, percent="fraction"), (0.121, 0.031), (12.1, 3.1)),
        ("12% ± 3%", Notation(uncertainty=True, percent="percent"), (12.1, 3.1), (0.121, 0.031)),
        ("(12 ± 3)%", Notation(uncertainty=True, percent="fraction"), 0.121, 12.1),
        ("(0.045***)", Notation(stars=True, parentheses="negative"), -0.0451, 0.0451),
        ("(0.045)**", Notation(stars=True, parentheses="standard-error"), 0.0451, -0.0451),
        ("(12%)*", Notation(stars=True, parentheses="negative", percent="fraction"), -0.1201, -12.01),
        ("<0.001***", Notation(stars=True, bounds=True), 0.0004, 0.01),
        ("≤ 0.05", BOUND, 0.05, 0.06),
        (">=10", BOUND, 10.0, 9.0),
        ("[−1.2, −0.4]", ENDS, (-1.24, -0.35), (1.24, -0.35)),
        ("[−1.2,−0.4]", ENDS, (-1.24, -0.35), (-1.24, 0.35)),
        ("−1.2 to −0.4", ENDS, (-1.24, -0.35), (-1.24, 0.35)),
        ("1.2–3.4", ENDS, (1.24, 3.35), (1.24, -3.35)),
        ("]1.2, 3.4[", ENDS, (1.24, 3.35), (1.24, 4.0)),
        ("[1,2; 3,4]*", Notation(interval="ends", decimal=",", stars=True), (1.24, 3.35), (12.0, 34.0)),
        ("[12, 15] %", Notation(interval="ends", percent="fraction"), (0.121, 0.149), (12.1, 14.9)),
        ("[-1.2?, 0.4]", Notation(interval="inside"), -1.1, 0.6),
        ("[0.[3], 0.[6]]", Notation(interval="inside"), 0.4, 0.7),
        ("10^-3", PLAIN, 0.00104, 0.01),
        ("−10⁴", PLAIN, -10400.0, 10400.0),
        ("5.670 374 419 × 10^-8", Notation(thousands=" "), 5.6703744191e-8, 6e-8),
        ("1 234,567 8", Notation(decimal=",", thousands=" "), 1234.56781, 1.2345678),
        ("1·5", Notation(decimal="·"), 1.54, 15.0),
        ("12 %", Notation(percent="percent"), 12.3, 0.12),
        ("12 %", Notation(percent="fraction"), 0.123, 12.0),
        ("1.2e-3", PLAIN, 0.00123, 0.0123),
        ("1.2 × 10^-3", PLAIN, 0.00123, 0.0123),
        ("1.2 · 10⁻³", PLAIN, 0.00123, 0.0123),
        ("−1.2x10^{4}", PLAIN, -12049.0, 12049.0),
        ("1.234,5", COMMA, 1234.52, 1.2345),
        ("0,50", COMMA, 0.5049, 0.56),
        ("12'345", Notation(thousands="'"), 12345.3, 12.345),
        ("12 345.6", Notation(thousands=" "), 12345.63, 12.0),
        ("\N{MINUS SIGN}0.50", PLAIN, -0.5, 0.5),
        ("0.91[6]", PLAIN, 11 / 12, 0.93),
        ("[1.2, 3.4]", ENDS, (1.24, 3.35), (1.24, 4.0)),
        ("(1.2; 3.4)", ENDS, (1.24, 3.35), (2.0, 3.4)),
        ("[1.2, 3.4]", Notation(interval="inside"), 2.0, 3.6),
        ("17", Notation(count=True), 17.0, 17.4),
        ("2003-05-17", Notation(date=True), pd.Timestamp("2003-05-17"), pd.Timestamp("2003-05-18")),
        ("n.s.", WORDS, "n.s.", "unstable"),
        ("0.5", WORDS, 0.5, "unstable"),
        ("unstable", WORDS, "unstable", 0.5),
    ],
)
def test_each_print_has_its_rule(text: str, notation: Notation, equal: object, differs: object) -> None:
    assert kind(text, equal, notation) == "equal"
    assert kind(text, differs, notation) == "differs"


@pytest.mark.parametrize(
    ("text", "notation", "given", "message"),
    [
        ("6.9", PLAIN, math.inf, "the number inf; expected: a number"),
        ("6.9", PLAIN, "6.9", r"text \('6.9'\); expected: a number"),
        ("6.9", PLAIN, (6.9, 0.1), r"tuple \(\(6.9, 0.1\)\); expected: a number"),
        ("17", Notation(count=True), -math.inf, "the number -inf; expected: a number"),
        ("0.5", WORDS, "stable", "text .*; expected: a number or 'unstable' or 'n.s.'"),
        ("0.5", WORDS, math.inf, "the number inf; expected: a number or 'unst"),
        (
            "3.4 ± 0.2",
            Notation(uncertainty=True),
            (3.4, math.nan),
            "expected: a number or a pair of value and uncertai",
        ),
        ("3.4", Notation(uncertainty=True), (3.4, 0.2), "expected: a number"),
        ("[1.2, 3.4]", ENDS, 2.0, "the number 2; expected: a pair of ends"),
        ("[1.2, 3.4]", ENDS, (1.2, math.inf), "expected: a pair of ends"),
        ("[1.2, 3.4]", Notation(interval="inside"), (1.2, 3.4), "expected: a number"),
        ("2003-05-17", Notation(date=True), "17 May 2003", "expected: a date"),
        ("2003-05-17", Notation(date=True), 2003.4, "the number 2003.4; expected: a date"),
    ],
)
def test_what_cannot_be_compared_is_no_result(text: str, notation: Notation, given: Any, message: str) -> None:
    table = Table("table-1", "table", "One cell", rows=("A",), columns=("x",), notation=notation)
    printed = {("A", "x"): PrintedValue(text, notation=notation)}
    with pytest.raises(PaperDefinitionError, match=f"row 'A', column 'x' holds .*{message}"):
        checked_frame(table, table.frame({"A": [given]}), printed)


@pytest.mark.parametrize(
    ("text", "notation", "given"),
    [
        (">10", BOUND, math.inf),
        ("<-3", BOUND, -math.inf),
        ("n.s.", WORDS, 0.7),
        ("0.7", WORDS, "n.s."),
        ("3.4 ± 0.2", Notation(uncertainty=True), 3.4),
        ("2003-05-17", Notation(date=True), dt.date(2003, 5, 18)),
        ("", PLAIN, "where nothing is printed, anything"),
    ],
)
def test_what_can_be_compared_is_a_result(text: str, notation: Notation, given: Any) -> None:
    table = Table("table-1", "table", "One cell", rows=("A",), columns=("x",), notation=notation)
    printed = {("A", "x"): PrintedValue(text, notation=notation)} if text else {}
    assert checked_frame(table, table.frame({"A": [given]}), printed).size == 1


def test_what_is_infinite_is_beyond_every_bound_of_its_side() -> None:
    assert [kind(text, math.inf, BOUND) for text in (">10", "≥ 10", "<10")] == ["equal", "equal", "differs"]
    assert [kind(text, -math.inf, BOUND) for text in (">10", "<10")] == ["differs", "equal"]


def test_the_border_of_a_bound_is_near() -> None:
    assert kind("<0.001", 0.00102, BOUND) == "near"
    assert kind(">10", 9.8, BOUND) == "near"


@pytest.mark.parametrize(
    ("text", "notation", "message"),
    [
        ("<0.05", PLAIN, r"notation=Notation\(bounds=True\) would accept it"),
        ("0.1**", PLAIN, r"notation=Notation\(stars=True\) would accept it"),
        ("1,5", PLAIN, r'notation=Notation\(decimal=","\) would accept it'),
        ("1,234.5", PLAIN, r'notation=Notation\(thousands=","\) would accept it'),
        ("3.4(2)", PLAIN, r"notation=Notation\(uncertainty=True\) would accept it"),
        ("[1, 2]", PLAIN, r'notation=Notation\(interval="ends"\) would accept it'),
        ("12 %", PLAIN, r'notation=Notation\(percent="percent"\) would accept it'),
        ("3,4 ± 0,2", PLAIN, r'notation=Notation\(decimal=",", uncertainty=True\) would accept it'),
        ("<0.01*", BOUND, r"notation=Notation\(bounds=True, stars=True\) would accept it"),
        ("0,123", Notation(thousands=","), r'notation=Notation\(decimal=","\) would accept it'),
        ("12.0", Notation(count=True), r"notation=Notation\(\) would accept it"),
        ("unstable", Notation(words=("n.s.",)), r'Notation\(words=\("n.s.", "unstable"\)\) would accept it'),
        ("–", PLAIN, r'notation=Notation\(none=\("–",\)\) would accept it'),
        ("–3", PLAIN, "the dash is no minus sign: write - or −"),
        ("2003-05-17", PLAIN, r"notation=Notation\(date=True\) would accept it"),
        ("3.4 ±", PAIR, r"is not a number \(allowed: an uncertainty\)"),
        ("3.4 ± 0.2 ± 0.3", PAIR, "is not a number"),
        ("3.4 ± -0.2", PAIR, "is not a number"),
        ("3.4 ± 0.2 × 10^-3", PAIR, "is not a number"),  # of both, or of the second?
        ("3,4 ± 0.2", Notation(uncertainty=True, decimal=","), "is not a number"),
        ("12% ± 3", Notation(uncertainty=True, percent="percent"), "is not a number"),
        ("1e3(2)", PAIR, "is not a number"),
        ("(-0.045)", Notation(parentheses="negative"), "is not a number or a number in parentheses"),
        ("0.123", COMMA, "is not a number"),
        ("12,34.5", Notation(thousands=","), r"is not a number \(allowed: separators of thousands\)"),
        ("stable", WORDS, "is not a number or 'unstable' or 'n.s.'"),
        ("2003-02-30", Notation(date=True), "is not a date such as 2003-05-17"),
        ("17.5", Notation(count=True), "is not a whole number"),
        ("1" * 200, PLAIN, "is not a number"),
        ("1e999", PLAIN, "is not a number"),
    ],
)
def test_what_the_notation_does_not_allow_is_refused(text: str, notation: Notation, message: str) -> None:
    with pytest.raises(PrintedFileError, match=message):
        PrintedValue(text, notation=notation)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"decimal": ";"}, r"notation: decimal is ';'; allowed: '.', ',', '·'"),
        ({"words": "unstable"}, r"notation: words is 'unstable' \(str\); expected: a list of texts, as in"),
        ({"percent": True}, r"notation: percent is True; allowed: '', 'percent', 'fraction'"),
        ({"stars": "yes"}, "notation: stars is 'yes'; allowed: False, True"),
        ({"thousands": "."}, r"notation: decimal and thousands are both '\.'"),
    ],
)
def test_a_notation_that_is_none_is_refused(given: dict[str, Any], message: str) -> None:
    with pytest.raises(PaperDefinitionError, match=message):
        Notation(**given)


def paper(**options: object) -> Paper:
    made = Paper("toy", "toy", "Toy", (), "", 2000, (), ())
    table = made.table("table-1", "T", rows=("A", "B"), columns=("x", "y"), **options)  # type: ignore[arg-type]
    table.reading("as-written", "as written")(pd.DataFrame)
    return made


def test_a_table_of_two_notations(tmp_path: Path) -> None:
    table = paper(notation={"x": BOUND, "y": Notation(words=("unstable",), none=("-",))}).exhibits["table-1"]
    path = tmp_path / "table-1.csv"
    path.write_text("row,x,y\nA,<0.1,unstable\nB,0.5,-\n", encoding="utf-8")
    values = read_printed(path, table)  # type: ignore[arg-type]
    assert {key: value.statement.kind for key, value in values.items()} == {
        ("A", "x"): "below",
        ("A", "y"): "word",
        ("B", "x"): "number",
    }


def test_words_are_judged() -> None:
    made = paper(notation={"y": WORDS})
    table = made.exhibits["table-1"]
    frame = pd.DataFrame({"x": [1.0, 2.0], "y": ["unstable", 0.5]}, index=["A", "B"])
    printed = {
        ("A", "x"): PrintedValue("1.0", "A", "x"),
        ("A", "y"): PrintedValue("unstable", "A", "y", notation=WORDS),
        ("B", "y"): PrintedValue("n.s.", "B", "y", notation=WORDS),
    }
    results = {("toy", table.id): TableResult("toy", table.id, {"as-written": frame})}
    judgement = judge(made, results, Inputs({"table-1": printed}))
    assert [row.verdict for row in judgement.verdicts] == ["reproduced", "reproduced", "unexplained"]
    assert [row.computed for row in judgement.verdicts] == ["1", "unstable", "0.5"]
    (problem,) = judgement.problems
    assert "row 'B', column 'y': printed n.s., computed as-written 0.5: has no ledger entry" in problem


def test_a_number_that_stands_for_several_cells_holds_if_all_do() -> None:
    made = paper(spans={("A", "x"): [("B", "x")]})
    printed = {"table-1": {("A", "x"): PrintedValue("1.0", "A", "x")}}
    for other, verdict in ((1.04, "reproduced"), (1.4, "unexplained")):
        frame = pd.DataFrame({"x": [1.0, other], "y": [None, None]}, index=["A", "B"])
        results = {("toy", "table-1"): TableResult("toy", "table-1", {"as-written": frame})}
        (row,) = judge(made, results, Inputs(printed)).verdicts
        assert row.verdict == verdict
        assert row.computed == f"{other if verdict == 'unexplained' else 1.0:g}"


@pytest.mark.parametrize(
    ("second", "message"),
    [
        (
            "B,2.0,3",
            "table-1.csv:3: row 'B', column 'x' is not blank, though the number in row 'A', column 'x' stands f",
        ),
        ("B,,3", ""),
    ],
)
@pytest.mark.parametrize("first", ["A,1.0,2", "A,,2"])
def test_a_number_that_stands_for_several_cells_is_entered_once(
    first: str, second: str, message: str, tmp_path: Path
) -> None:
    path = tmp_path / "table-1.csv"
    path.write_text(f"row,x,y\n{first}\n{second}\n", encoding="utf-8")
    table = paper(spans={("A", "x"): [("B", "x")]}).exhibits["table-1"]
    assert isinstance(table, Table)
    message = (
        message if ",1.0," in first else "table-1.csv: row 'A', column 'x' is blank, though it stands for other ce"
    )
    with pytest.raises(PrintedFileError, match=message) if message else nullcontext():
        read_printed(path, table)


def test_what_is_near_is_declared_for_a_table() -> None:
    assert match(PrintedValue("1.00", near=Near(units=0.6, fraction=0.0)), 0.991).kind == "differs"
    assert match(PrintedValue("1.00", near=Near(units=5, fraction=0.0)), 1.049).kind == "near"
    assert match(PrintedValue("1.00"), 0.991).kind == "near"


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"notation": {"z": BOUND}}, "table-1: there is no column 'z'; allowed: x, y"),
        ({"spans": {("A", "x"): [("C", "x")]}}, "table-1: there is no row 'C'; allowed: A, B"),
        ({"labels": {"Q": "q"}}, "table-1: there is no row or column 'Q'; allowed: A, B, x, y"),
        ({"units": {"A": "s"}}, "table-1: there is no column 'A'; allowed: x, y"),
    ],
)
def test_declarations_speak_of_the_table(options: dict[str, object], message: str) -> None:
    with pytest.raises(PaperDefinitionError, match=message):
        paper(**options)
