from __future__ import annotations

from pathlib import Path

import pytest
import synthetic

from replicate.errors import LedgerError
from replicate.verdicts.causes import CAUSES
from replicate.verdicts.ledger import Ledger, LedgerEntry

ENTRY = """
[[entry]]
exhibit = "table-1"
rows = ["A"]
columns = ["x"]
cause = "misprint"
explanation = "A digit is wrong."
"""


def load(folder: Path, text: str) -> Ledger:
    path = folder / "toy" / "ledger.toml"
    path.parent.mkdir()
    path.write_text(text, encoding="utf-8")
    return Ledger.load(path, synthetic.paper())


def test_reads_every_field(tmp_path: Path) -> None:
    text = f"""# what does not hold
{ENTRY}
[[entry]]
exhibit = "table-1"
rows = "*"
columns = ["y"]
cause = "unknown"
explanation = \"\"\"
Tried two definitions,
neither fits.\"\"\"
reading = "authors"
evidence = "None."
consequence = "comparison"
informed = "Letter of 2 May 2001"
answer = "They agree."
"""
    ledger = load(tmp_path, text)
    assert ledger.entries == (
        LedgerEntry("table-1", ("A",), ("x",), "misprint", "A digit is wrong.", file="toy/ledger.toml", line=3),
        LedgerEntry(
            "table-1",
            ("*",),
            ("y",),
            "unknown",
            "Tried two definitions, neither fits.",
            reading="authors",
            evidence="None.",
            consequence="comparison",
            informed="Letter of 2 May 2001",
            answer="They agree.",
            file="toy/ledger.toml",
            line=10,
        ),
    )
    assert ledger.entries[1].place == "toy/ledger.toml:10"
    assert ledger.entries[1].covers("B", "y")
    assert not ledger.entries[1].covers("B", "x")


@pytest.mark.parametrize("every", ['"*"', '["*"]'])
def test_entries_that_name_their_cells_come_first(tmp_path: Path, every: str) -> None:
    wildcard = ENTRY.replace('["A"]', every)
    ledger = load(tmp_path, wildcard + ENTRY)
    assert [entry.explicit for entry in ledger.of("table-1")] == [True, False]
    assert ledger.of("table-2") == []


def test_no_file_is_an_empty_ledger(tmp_path: Path) -> None:
    assert Ledger.load(tmp_path / "ledger.toml", synthetic.paper()).entries == ()


@pytest.mark.parametrize("cause", CAUSES)
def test_every_cause_is_accepted(tmp_path: Path, cause: str) -> None:
    assert load(tmp_path, ENTRY.replace("misprint", cause)).entries[0].cause == cause


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('rows = ["A"]\n', "", r":2: 'rows' is missing; required: exhibit, rows, .*; allowed: reading, .*"),
        ('["A"]\n', '["A"]\nrow = "A"\n', r":2: 'row' is not a field; required: .*"),
        ('["A"]', '["C"]', r":2: rows: 'C' is not in the exhibit; allowed: 'A', 'B'"),
        ('["A"]', '["A", "A"]', r":2: rows: 'A' appears twice"),
        ('["A"]', "[]", r':2: rows = \[\]; expected: a list of keys or "\*"'),
        ('["A"]', '"A"', r""":2: rows = 'A'; expected: a list of keys or "\*\""""),
        ('["x"]', '["z"]', r":2: columns: 'z' is not in the exhibit; allowed: 'x', 'y'"),
        (
            '"table-1"',
            '"table-9"',
            r":2: exhibit 'table-9' is not an exhibit of the paper; allowed: 'table-1'",
        ),
        ('"table-1"', '"fig-1"', r":2: exhibit 'fig-1' has no printed values to explain; allowed: 'table-1'"),
        ('"table-1"', '"claims"', r":2: exhibit 'claims' has no printed values to explain; .*"),
        ('"misprint"', '"typo"', r":2: cause 'typo' is unknown; allowed: misprint, print-or-copy, scan, .*, unknown"),
        ('"misprint"', '["misprint"]', r":2: cause \['misprint'\] is unknown; allowed: .*"),
        ('"A digit is wrong."', '" "', r":2: explanation = ' '; expected: a quoted string that is not empty"),
        (
            '"misprint"',
            '"scan"\nreading = "ours"',
            r":2: 'ours' is not a reading .*: 'as-written', 'authors'",
        ),
        ('"misprint"', '"scan"\ncorrected = 1.50', r":2: corrected = 1\.5; expected: a quoted string"),
        (
            '"misprint"',
            '"scan"\ncorrected = "1,5"',
            r":2: corrected = '1,5' is not a number; allowed: digits .*",
        ),
        (
            '"misprint"',
            '"method"\ncorrected = "1"',
            r":2: 'corrected' is allowed with the causes 'misprint', .*",
        ),
        ('["A"]', '["A", "B"]\ncorrected = "1"', r":2: 'corrected' is one value, so .* exactly one row .*"),
        ('["A"]', '"*"\ncorrected = "1"', r":2: 'corrected' is one value, so .*"),
        (
            '"misprint"',
            '"misprint"\nconsequence = "bad"',
            r":2: consequence 'bad' is unknown; allowed: none, .*, formula",
        ),
        ('"misprint"', '"misprint"\nconsequence = "safety"', r":2: consequence = 'safety' needs evidence, .*"),
        ('"misprint"', '"misprint"\nanswer = "Yes."', r":2: 'answer' is given, but not when .*; expected: 'informed'"),
        ("[[entry]]", "[[entries]]", r": allowed: \[\[entry\]\] tables only; found 'entries'"),
        ("[[entry]]", "[entry]", r": allowed: \[\[entry\]\] tables only"),
        ('["A"]', '["A"', r":\d+: is not readable TOML: .*"),
    ],
)
def test_refuses_naming_file_and_line(tmp_path: Path, old: str, new: str, message: str) -> None:
    assert old in ENTRY
    with pytest.raises(LedgerError, match=f"^toy/ledger\\.toml{message}$"):
        load(tmp_path, ENTRY.replace(old, new))


def test_two_entries_for_one_cell_are_refused(tmp_path: Path) -> None:
    second = ENTRY.replace('["A"]', '["B", "A"]')
    message = r"^toy/ledger\.toml:9: table-1 row 'A', column 'x' is already named by the entry in line 2$"
    with pytest.raises(LedgerError, match=message):
        load(tmp_path, ENTRY + second)


def test_two_files_that_name_one_cell_are_refused_with_both_places(tmp_path: Path) -> None:
    load(tmp_path, ENTRY)
    (tmp_path / "toy" / "ledger-II.toml").write_text(f"\n{ENTRY}", encoding="utf-8")
    message = r"^toy/ledger-II\.toml:3: .* is already named by the entry in toy/ledger\.toml:2$"
    with pytest.raises(LedgerError, match=message):
        Ledger.load_all(tmp_path / "toy", synthetic.paper())
