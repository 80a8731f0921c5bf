from __future__ import annotations

from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import pytest
import synthetic

from replicate.errors import PrintedFileError
from replicate.exhibits import Table
from replicate.exhibits.matching import match
from replicate.exhibits.numerals import parse_number
from replicate.exhibits.printed import PrintedValue, read_printed

ALLOWED = r"digits with an optional sign, .*, \? for a lost last digit, exponent"


def table(significant_digits: int | None = None) -> Table:
    exhibit = synthetic.paper(significant_digits=significant_digits).exhibits["table-1"]
    assert isinstance(exhibit, Table)
    return exhibit


def write(folder: Path, content: str | bytes) -> Path:
    path = folder / "toy" / "printed" / "table-1.csv"
    path.parent.mkdir(parents=True)
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def test_reads_text_position_and_blanks(tmp_path: Path) -> None:
    path = write(tmp_path, "rule,x,y\nA,6.9680,\n\nB, \N{MINUS SIGN}0.50 ,1.2e-3\n")
    values = read_printed(path, table())
    assert list(values) == [("A", "x"), ("B", "x"), ("B", "y")]
    assert values["A", "x"] == PrintedValue("6.9680", "A", "x", 2)
    assert values["B", "x"].text == "\N{MINUS SIGN}0.50"
    assert values["B", "x"].value == Decimal("-0.50")
    assert values["B", "y"].line == 4


@pytest.mark.parametrize("content", ["\ufeffrule,x,y\r\nA,1,2\r\nB,3,4\r\n", 'rule,"x","y"\nA,"1",2\nB,3,4'])
def test_reads_what_spreadsheets_write(tmp_path: Path, content: str) -> None:
    assert [value.text for value in read_printed(write(tmp_path, content), table()).values()] == list("1234")


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("", "toy/printed/table-1.csv:1: the file is empty; expected: a header with the columns 'x', 'y'"),
        (
            'r,x,y\nA,1,2\nB,3,"1,2"\n',
            f"toy/printed/table-1.csv:3: column 'y': '1,2' is not a number; allowed: {ALLOWED}; .*would accept it",
        ),
        ("r;x;y\nA;1;2\nB;3;4\n", "toy/printed/table-1.csv:1: cells are separated by semicolons; allowed: commas, .*"),
        ("r,x,y\nA,nan,2\nB,3,4\n", "toy/printed/table-1.csv:2: column 'x': 'nan' is not a number; .*"),
        ("r,x,y\nA,1,2\n", "toy/printed/table-1.csv:2: row 'B' is missing"),
        ("r,x,y\n", "toy/printed/table-1.csv: row 'A', 'B' is missing"),
        (
            "r,x,y\nA,1,2\nB,3,4\nC,5,6\n",
            "toy/printed/table-1.csv:4: row 'C' is not one of the exhibit's; allowed: 'A', 'B'",
        ),
        (
            "r,x,y\nA,1,2\nA,1,2\nB,3,4\n",
            r"toy/printed/table-1.csv:3: row 'A' appears twice \(first in line 2\)",
        ),
        ("r,x,y\nB,1,2\nA,3,4\n", "toy/printed/table-1.csv:2: row 'B' is out of order, 'A' comes first; .*"),
        ("r,x\nA,1\nB,3\n", "toy/printed/table-1.csv:1: column 'y' is missing"),
        ("r,x,y,z\nA,1,2,3\nB,1,2,3\n", "toy/printed/table-1.csv:1: column 'z' is not one of .*: 'x', 'y'"),
        ("r,x,x\nA,1,2\nB,3,4\n", "toy/printed/table-1.csv:1: column 'x' appears twice"),
        (
            "r,y,x\nA,1,2\nB,3,4\n",
            "toy/printed/table-1.csv:1: column 'y' is out of order, 'x' comes first; .*",
        ),
        ("r,x,y\nA,1\nB,3,4\n", "toy/printed/table-1.csv:2: row 'A' has 2 cells, the header has 3"),
        ("r,x,y\nA,1,2,3\nB,3,4\n", "toy/printed/table-1.csv:2: row 'A' has 4 cells, the header has 3"),
        ('r,x,y\nA,1,"2\n', "toy/printed/table-1.csv:2: is not a CSV file: .*"),
        (b"r,x,y\nA,1,\xff\n", "toy/printed/table-1.csv:2: is not UTF-8 text"),
    ],
)
def test_refuses_naming_file_line_and_cell(tmp_path: Path, content: str | bytes, message: str) -> None:
    with pytest.raises(PrintedFileError, match=f"^{message}$"):
        read_printed(write(tmp_path, content), table())


def test_a_missing_file_is_named_without_the_machine(tmp_path: Path) -> None:
    with pytest.raises(PrintedFileError, match=r"^toy/printed/none\.csv: cannot be read: No such file"):
        read_printed(tmp_path / "toy" / "printed" / "none.csv", table())


@pytest.mark.parametrize(
    "text",
    [
        "1,2",
        "",
        " ",
        "--1",
        "1e",
        "1.2.3",
        "inf",
        "NaN",
        "0x1",
        "1_000",
        "٣",
        "1 2",
        ".",
        "0.[]",
        "[6]",
        "1[6]",
        "0.9[6]1",
    ],
)
def test_not_numbers(text: str) -> None:
    assert parse_number(text) is None
    with pytest.raises(PrintedFileError, match="is not a number; allowed: digits"):
        PrintedValue(text)


@pytest.mark.parametrize(
    ("text", "digits", "unit"),
    [
        ("6.968", None, "0.001"),
        ("6.9680", None, "0.0001"),
        ("100", None, "1"),
        ("5.", None, "1"),
        (".5", None, "0.1"),
        ("1.2e-3", None, "0.0001"),
        ("1e3", None, "1000"),
        ("-0.50", None, "0.01"),
        ("0.00", None, "0.01"),
        ("6.968", 6, "0.00001"),
        ("0.0068", 6, "0.00000001"),
        ("100", 6, "0.001"),
        ("1234567", 6, "10"),
        ("0", 6, "0.000001"),
        ("0.91[6]", None, "1e-12"),
        ("2.[2]", 3, "1e-11"),
    ],
)
def test_weight_of_the_last_digit(text: str, digits: int | None, unit: str) -> None:
    assert PrintedValue(text, significant_digits=digits).unit == Decimal(unit)


def test_more_digits_than_the_table_prints_are_refused(tmp_path: Path) -> None:
    path = write(tmp_path, "r,x,y\nA,1.2300000,0.123\nB,1230000,0.1234\n")
    with pytest.raises(
        PrintedFileError, match=r"^toy/printed/table-1\.csv:3: column 'y': '0\.1234' has more than the 3"
    ):
        read_printed(path, table(3))


@pytest.mark.parametrize(
    ("text", "fraction"),
    [
        ("0.91[6]", Fraction(11, 12)),
        ("2.[2]", Fraction(20, 9)),
        ("-.[142857]", Fraction(-1, 7)),
        ("1.[3]e2", Fraction(400, 3)),
    ],
)
def test_repeating_decimals_are_fractions(text: str, fraction: Fraction) -> None:
    printed = PrintedValue(text)
    assert abs(Fraction(printed.value) - fraction) < Fraction(1, 10**25)
    assert match(printed, float(fraction)).kind == "equal"
    assert match(printed, float(fraction) * (1 + 1e-10)).kind == "near"
