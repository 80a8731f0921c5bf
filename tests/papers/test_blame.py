"""The blame is no larger than the evidence: verdicts of the accepted state that a doubt decided."""

from __future__ import annotations

import csv
import tomllib
from pathlib import Path

import pytest

from replicate.run.library import Library

ROOT = Path(__file__).parent.parent.parent
PAPERS = {paper.id: paper for paper in Library(bundled=True).papers()}


def accepted(paper: str, exhibit: str) -> dict[tuple[str, str], str]:
    """Return the accepted verdicts of an exhibit by row and column, those of claims by row."""
    with (ROOT / "figures" / paper / f"{exhibit}.csv").open(encoding="utf-8", newline="") as file:
        return {(line["row"], line.get("column", "")): line["verdict"] for line in csv.DictReader(file)}


@pytest.mark.parametrize(
    ("paper", "exhibit", "row", "column", "verdict"),
    [
        # one altered glyph, in the paper or in the copy at hand, would explain the print
        ("panagopoulos", "II-table-1", "G5 Ms=2.0", "IE/IAE", "damaged"),
        ("panagopoulos", "II-claims", "eq-16-gives-one", "", "undecided"),
        ("panagopoulos", "VI-claims", "fb-at-resonance", "", "undecided"),
        ("krajewski", "claims", "eq-25", "", "undecided"),
        # two columns print the same wrong number, a time repeats another column
        ("panagopoulos", "I-table-3", "a=2.0", "w1", "misprint"),
        ("panagopoulos", "II-table-1", "G2 Ms=2.0", "ts", "misprint"),
        # the rounding of printed inputs explains the print
        ("panagopoulos", "I-table-1", "G3 Ms=2.0", "IE", "consistent"),
        ("panagopoulos", "IIs-example", "kd=1", "IAE", "consistent"),
        ("khan", "example-3-1", "L_P", "value", "consistent"),
        # the paper does not say what would decide
        ("panagopoulos", "IV-claims", "all-met", "", "undecided"),
        ("panagopoulos", "IV-claims", "most-met", "", "undecided"),
        ("panagopoulos", "IV-claims", "little-long", "", "undecided"),
        ("ali", "claims", "larger-overshoot-setpoint", "", "undecided"),
        ("ali", "claims", "satisfactory", "", "undecided"),
        # the same number has one verdict, in the text and in its table
        ("panagopoulos", "I-claims", "overshoot-g2-zn", "", "holds-partly"),
        ("panagopoulos", "VI-claims", "k-b", "", "holds"),
        ("panagopoulos", "VI-example", "k_b", "value", "consistent"),
        # a number that one of several readings meets, not the one that meets its neighbours
        ("ali", "table-1", "0.2", "Ms", "near"),
        ("ali", "quoted-settings", "visioli-load", "Td", "not-computable"),
    ],
)
def test_a_doubt_decides(paper: str, exhibit: str, row: str, column: str, verdict: str) -> None:
    assert accepted(paper, exhibit)[row, column] == verdict


@pytest.mark.parametrize(
    ("paper", "exhibit", "claims"),
    [
        ("ali", "claims", {"visioli-load-stable", "cubic-time-unit"}),
        ("panagopoulos", "I-claims", {"condition-19"}),
        ("panagopoulos", "VI-claims", {"iae"}),
    ],
)
def test_what_the_paper_does_not_say_is_no_claim(paper: str, exhibit: str, claims: set[str]) -> None:
    assert not claims & {row for row, _ in accepted(paper, exhibit)}


def test_rounding_is_argued_in_words_only_where_no_interval_decides() -> None:
    """Left are an intermediate value that is not printed, and repeating decimals, which state all of their digits."""
    found = set()
    for paper in PAPERS.values():
        for file in Path(str(paper.folder())).glob("ledger*.toml"):
            for entry in tomllib.loads(file.read_text(encoding="utf-8")).get("entry", []):
                if entry["cause"] == "rounding":
                    found.add((paper.id, entry["exhibit"], *entry["rows"], *entry["columns"]))
    assert found == {
        ("khan", "example-2-1", "tr_estimate", "value"),
        ("krajewski", "fig-8-values", "upper", "b"),
        ("krajewski", "fig-9-values", "c", "b"),
        ("krajewski", "fig-11-values", "a", "b"),
        ("krajewski", "fig-12-values", "a", "b"),
    }
