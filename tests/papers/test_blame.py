"""The blame is no larger than the evidence: verdicts of the accepted state that a doubt decided."""

from __future__ import annotations

import csv
import math
import tomllib
from pathlib import Path

import pytest

from replicate.exhibits import AS_WRITTEN, Table
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


def test_tables_that_are_reconstructed_say_how_many_alternatives_were_tried() -> None:
    silent = []
    for paper in PAPERS.values():
        for table in paper.load().exhibits.values():
            if not isinstance(table, Table) or not table.printed or table.points:
                continue
            others = [reading for reading in table.readings.values() if reading.id != AS_WRITTEN]
            if "reconstructed" in accepted(paper.id, table.id).values() and not any(
                reading.tried or reading.takes_inputs for reading in others
            ):
                silent.append((paper.id, table.id))
    assert not silent


def test_what_was_tried_is_what_the_tables_of_alternatives_list() -> None:
    from replicate.papers.khan import definitions
    from replicate.papers.khan.tables import table_2
    from replicate.papers.panagopoulos.part_1 import grids_tried
    from replicate.papers.panagopoulos.part_1.table_1 import table_1
    from replicate.papers.panagopoulos.part_2 import filter_grids, settling
    from replicate.papers.panagopoulos.part_2.tables import table_1 as superseded
    from replicate.papers.panagopoulos.parts_3_to_6 import v_drying

    tried = table_2.readings[AS_WRITTEN].tried
    assert tried["definition of $t_s$"] == len(definitions.SETTLING)
    assert tried["definition of $t_d$"] == len(definitions.LOAD)
    grid = superseded.readings["filter-coarse-grid"].tried
    assert math.prod(grid.values()) == 2 * len(filter_grids.GRIDS)
    assert math.prod(superseded.readings["paper-1-settling"].tried.values()) == len(list(settling.definitions()))
    authors = table_1.readings["authors"].tried
    assert authors["points of the grid"] * authors["its decades"] == len(grids_tried.GRIDS)
    assert v_drying.drying.readings["filter-coarse-grid"].tried["formula of the filter"] == len(v_drying.filters.rows)
