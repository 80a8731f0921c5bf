"""A table as the report shows it: heads over groups of columns, values shown once, every cell of a note named."""

from __future__ import annotations

import math

import pandas as pd
import pytest

from replicate.display.spanners import spans
from replicate.display.tables import TableView, table_view
from replicate.exhibits import Table
from replicate.exhibits.frames import read_frame
from replicate.exhibits.results import TableResult
from replicate.exhibits.trials import TableTrials, Trial, computed_trials, declared_trials
from replicate.run.library import Library

COLUMNS = ("k_1", "Ti_1", "k_2", "Ti_2")
LABELS = {"k_1": "$k$, first loop", "Ti_1": "$T_i$, first loop", "k_2": "$k$, $f(1, 2)$", "Ti_2": "$T_i$, $f(1, 2)$"}


def view(*values: list[list[float]]) -> TableView:
    table = Table("table-1", "table", "Gains", rows=("A", "B"), columns=COLUMNS, labels=LABELS, printed=False)
    frames = {
        id: pd.DataFrame(rows, index=["A", "B"], columns=list(COLUMNS))
        for id, rows in zip(("as-written", "other"), values, strict=False)
    }
    for id, frame in frames.items():
        table.reading(id, id)(frame.copy)
    return table_view(table, TableResult("p", "table-1", frames), [])


def test_columns_with_a_common_end_stand_under_one_head() -> None:
    found = view([[1.0, 2.0, 3.0, 4.0], [5.0, 6.0, 7.0, 8.0]]).pieces[0].spans
    assert [span.label for span in found] == ["first loop", "$f(1, 2)$"]
    assert [[label for _, label in span.columns] for span in found] == [["$k$", "$T_i$"]] * 2


@pytest.mark.parametrize(
    ("labels", "heads"),
    [
        (["a", "b", "c"], ["", "", ""]),
        (["a, 1", "b, 2"], ["", ""]),  # one column is no group
        (["a, 1", "b, 1", "c, 2", "d, 1"], ["1", "", ""]),  # only neighbours are
        (["n, 1", "n, 2", "n, 3", "none"], ["n", ""]),
        ([], []),
    ],
)
def test_groups_are_of_neighbours(labels: list[str], heads: list[str]) -> None:
    found = spans(labels)
    assert [span.label for span in found] == heads
    assert [place for span in found for place, _ in span.columns] == list(range(len(labels)))


def test_what_the_line_above_says_is_marked() -> None:
    shown = view([[1.0, 2.0, 3.0, 4.0], [5.0, 6.0, 7.0, 8.0]], [[1.0, 2.5, 3.0, 4.5], [5.0, 6.0, 7.0, 8.0]])
    (_, first), (_, second) = shown.rows
    assert [line.repeats for line in shown.lines(first)] == [[False] * 4, [True, False, True, False]]
    assert [line.readings for line in shown.lines(second)] == [["as-written", "other"]]


def test_readings_that_agree_in_the_promised_digits_share_a_line() -> None:
    shown = view([[1.0, 2.0, 3.0, 4.0], [5.0, 6.0, 7.0, 8.0]], [[1.0 + 1e-11, 2.0, 3.0, 4.0], [5.0, 6.0, 7.0, 8.0001]])
    (_, first), (_, second) = shown.rows
    assert [line.readings for line in shown.lines(first)] == [["as-written", "other"]]
    assert [ids for ids, _ in first[0].alike] == [["as-written"], ["other"]]  # a card shows all digits
    assert len(shown.lines(second)) == 2


@pytest.mark.parametrize(
    ("other", "later"),
    [(1.0 + 3e-8, True), (1.0 + 1e-11, False), (1.001, False)],  # of six digits shown, and ten promised
)
def test_a_table_says_where_numbers_that_look_alike_differ(other: float, later: bool) -> None:
    row = [5.0, 6.0, 7.0, 8.0]
    assert view([[1.0, 2.0, 3.0, 4.0], row], [[other, 2.0, 3.0, 4.0], row]).differ_later is later


def test_very_many_columns_stand_below_each_other() -> None:
    many = [f"c{place}" for place in range(60)]
    table = Table("table-1", "table", "Wide", rows=("A",), columns=tuple(many), printed=False)
    table.reading("as-written", "As written")(lambda: pd.DataFrame([range(60)], index=["A"], columns=many))
    shown = table_view(table, TableResult("toy", "table-1", {"as-written": table.readings["as-written"].compute()}), [])
    assert [len(piece.columns) for piece in shown.pieces] == [15] * 4
    assert [column for piece in shown.pieces for column in piece.columns] == many
    cells = [cell.column for piece in shown.pieces for _, _, row in piece.rows for cell in row]
    assert cells == many
    assert [piece.first for piece in shown.pieces] == [0, 15, 30, 45]


def test_a_reading_that_computes_nothing_in_a_row_has_no_line_there() -> None:
    nan = float("nan")
    shown = view([[1.0, nan, 3.0, 4.0], [nan] * 4], [[nan] * 4, [nan] * 4])
    (_, first), (_, second) = shown.rows
    assert [line.readings for line in shown.lines(first)] == [["as-written"]]
    assert len(shown.lines(second)) == 1  # of a row that nothing was printed for, one line remains


def test_a_row_leads_to_its_loops() -> None:
    table = Table("table-1", "table", "Gains", rows=("A", "B"), columns=("k", "Ti"), printed=False)
    frame = pd.DataFrame([[1.0, 2.0], [math.nan, 4.0]], index=["A", "B"], columns=["k", "Ti"])
    table.reading("as-written", "as written")(frame.copy)
    declared = declared_trials(lambda: {("A", "slow"): ("1/s", "k=1"), ("A", "fast"): ("1/s", "k=2")}, table.rows)
    trial = lambda _row, numbers: (f"1/(s+{numbers['Ti']:g})", f"k={numbers['k']:g}")  # noqa: E731
    computed = computed_trials(trial, read_frame(frame))
    assert computed == (Trial("A", "", "1/(s+2)", "k=1"),)  # nothing for B, whose gain was not computed
    result = TableResult("p", "table-1", {"as-written": frame}, trials=TableTrials(declared, computed))
    assert table_view(table, result, []).trials == {
        "A": [
            ("slow", "whatif.html#plant=1%2Fs&controller=k%3D1"),
            ("fast", "whatif.html#plant=1%2Fs&controller=k%3D2"),
            ("", "whatif.html#plant=1%2F%28s%2B2%29&controller=k%3D1"),
        ]
    }


PROPORTIONAL = {"k", "K", "Kp", "Kp_41", "KKp", "K_P"}
INTEGRAL = {"ki", "Ki", "Ti", "Ti_41", "K_I"}


def test_every_row_of_tuning_parameters_can_be_tried_out() -> None:
    missing = {}
    for paper in Library(bundled=True).papers():
        for table in paper.exhibits.values():
            if not (isinstance(table, Table) and PROPORTIONAL & {*table.columns} and INTEGRAL & {*table.columns}):
                continue
            rows = {*table.rows} - {trial.row for trial in declared_trials(table.trials)}
            if rows and table.computed_trial is None:
                missing[f"{paper.id} {table.id}"] = rows
    assert missing == {"panagopoulos I-table-2": {"G9 Ms=1.4", "G9 Ms=2.0"}}  # e^{-sqrt(s)}, which the page cannot draw


def test_every_column_of_tuning_parameters_can_be_tried_out() -> None:
    missing = {}
    for paper in Library(bundled=True).papers():
        for table in paper.exhibits.values():
            if not (isinstance(table, Table) and PROPORTIONAL & {*table.rows} and INTEGRAL & {*table.rows}):
                continue
            tried = declared_trials(table.trials)
            if {trial.row for trial in tried} - PROPORTIONAL or len(tried) < len(table.columns):
                missing[f"{paper.id} {table.id}"] = len(table.columns) - len(tried)
    assert missing == {
        "panagopoulos IIs-table-1": 6,  # filters in the measurement, which the page does not draw
        "panagopoulos IV-table-1": 4,  # the plant is not in the paper
    }
