"""A reading's rows become the table in the paper's order; rows or columns that are not the table's are refused."""

from __future__ import annotations

import math
import re

import pandas as pd
import pytest

from replicate.errors import PaperDefinitionError
from replicate.exhibits import Paper, Table

NAMED = Table("table-1", "table", "Numbers", rows=("A", "B"), columns=("x", "y"))
FREE = Table("evidence", "table", "What was tried", printed=False)
ONE_COLUMN = Table("example-1", "example", "An example", rows=("k", "ki"), columns=("value",))


def test_rows_and_columns_stand_in_the_papers_order() -> None:
    expected = pd.DataFrame([[1.0, 2.0], [3.0, math.nan]], index=["A", "B"], columns=["x", "y"])
    pd.testing.assert_frame_equal(NAMED.frame({"B": {"x": 3.0}, "A": {"y": 2.0, "x": 1.0}}), expected)
    pd.testing.assert_frame_equal(NAMED.frame({"B": (3.0, None), "A": [1.0, 2.0]}), expected)


def test_a_number_is_a_row_of_the_only_column() -> None:
    expected = pd.DataFrame({"value": [0.5, 0.25]}, index=["k", "ki"])
    pd.testing.assert_frame_equal(ONE_COLUMN.frame({"ki": 0.25, "k": 0.5}), expected)


def test_a_table_that_names_nothing_takes_what_is_given() -> None:
    expected = pd.DataFrame([[1.0, math.nan], [math.nan, 2.0]], index=["b", "a"], columns=["v", "u"])
    pd.testing.assert_frame_equal(FREE.frame({"b": {"v": 1.0}, "a": {"u": 2.0}}), expected)


def test_blank_cells_hold_no_number() -> None:
    frame = NAMED.blank()
    assert (list(frame.index), list(frame.columns)) == (["A", "B"], ["x", "y"])
    assert frame.isna().all(axis=None)


def test_cells_may_hold_words_and_pairs() -> None:
    frame = NAMED.frame({"A": {"x": "n.s.", "y": (1.25, 3.5)}, "B": ["yes", None]})
    assert frame.loc["A", "x"] == "n.s."
    assert frame.loc["A", "y"] == (1.25, 3.5)
    assert ONE_COLUMN.frame({"k": "yes", "ki": 1.0}).loc["k", "value"] == "yes"


@pytest.mark.parametrize(
    ("table", "rows", "message"),
    [
        (NAMED, {"A": [1, 2]}, "table-1: row 'B' is missing"),
        (NAMED, {"A": [1, 2], "B": [3, 4], "C": [5, 6]}, "row 'C' is not one of the table's; allowed: A, B"),
        (NAMED, {"A": {"x": 1, "z": 2}, "B": [3, 4]}, "column 'z' is not one of the table's; allowed: x, y"),
        (NAMED, {"A": [1, 2], "B": [3]}, "table-1: row 'B' has 1 cells for 2 columns"),
        (NAMED, {"A": 1.0, "B": [3, 4]}, "table-1: row 'A' has 1 cells for 2 columns"),
        (FREE, {"A": [1.0]}, "evidence: row 'A' has 1 cells for 0 columns"),
    ],
)
def test_what_does_not_fit_is_refused(table: Table, rows: dict[str, object], message: str) -> None:
    with pytest.raises(PaperDefinitionError, match=re.escape(message)):
        table.frame(rows)  # type: ignore[arg-type]


def test_of_the_labels_that_tables_share_a_table_takes_its_own() -> None:
    paper = Paper("lab", "lab", "A laboratory", ("N. N.",), "N. N., 2000.", 2000, modules=(), numbered=())
    shared = {"k": "$k$", "Ti": "$T_i$", "A": "plant A"}
    table = paper.table("t", "Numbers", rows=("A",), columns=("k",), shared_labels=shared, labels={"A": "this plant"})
    assert table.labels == {"k": "$k$", "A": "this plant"}
    with pytest.raises(PaperDefinitionError, match="there is no row or column 'Ti'"):
        paper.table("u", "Numbers", rows=("A",), columns=("k",), labels=shared)


def test_a_table_that_leaves_its_rows_to_the_reading_may_label_them() -> None:
    paper = Paper("lab", "lab", "A laboratory", ("N. N.",), "N. N., 2000.", 2000, modules=(), numbered=())
    assert paper.table("t", "Numbers", columns=("k",), printed=False, labels={"A": "plant A"}).labels == {
        "A": "plant A"
    }
