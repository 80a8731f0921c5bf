"""Definitions of the wrong form or type: one line that says what is expected, with file and line."""

from __future__ import annotations

import dataclasses
import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from replicate.errors import PaperDefinitionError
from replicate.exhibits import Near, Paper, Table
from replicate.exhibits.comparisons import bound, rank
from replicate.exhibits.definitions import check_id

Run = Callable[..., tuple[int, str, str]]

BAD_IDS = [
    "",
    "../x",
    "a/b",
    "a\\b",
    ".hidden",
    "-x",
    "_x",
    "a b",
    "a.",
    "<script>",
    "é",
    "a\n",
    "a\0",
    "x" * 101,
    3,
    None,
]
GOOD_IDS = ["table-1", "I-fig-2", "eq-7a", "p-1.667", "a_b", "7"]


def paper(**changes: Any) -> Paper:
    fields: dict[str, Any] = {
        "id": "lab",
        "package": "lab",
        "title": "A laboratory",
        "authors": ("N. N.",),
        "citation": "N. N., 2000.",
        "year": 2000,
        "modules": (),
        "numbered": (),
    }
    return Paper(**(fields | changes))


def with_table(id: Any = "table-1", **changes: Any) -> Paper:
    made = paper()
    made.table(id, **({"title": "T", "rows": ("a",), "columns": ("x",)} | changes))
    return made


def with_reading(id: Any, **changes: Any) -> None:
    table = with_table().exhibits["table-1"]
    table.reading("as-written", "As written")(dict)  # type: ignore[union-attr]
    table.reading(id, **({"title": "R"} | changes))(dict)  # type: ignore[union-attr]


def two_rows() -> Table:
    return paper().table("table-1", "T", rows=("a", "b"), columns=("x", "y"))


def with_ranking(**changes: Any) -> None:
    rank(two_rows(), **({"quantity": "x", "cases": ("a", "b"), "says": "S"} | changes))


def with_claim(id: Any, **changes: Any) -> None:
    paper().claims().claim(id, **({"text": "It is so."} | changes))(dict)  # type: ignore[arg-type]


def with_figure(id: Any, **changes: Any) -> None:
    paper().figure(id, **({"title": "F"} | changes))(print)


def with_chart(id: Any, **changes: Any) -> None:
    paper().chart(id, **({"title": "C", "parameters": {"x": "any"}} | changes))(print)


MAKERS: list[Callable[[Any], object]] = [
    lambda id: paper(id=id),
    with_table,
    with_reading,
    with_claim,
    with_figure,
    with_chart,
    lambda id: paper().not_computable(id, "N", "It is not."),
    lambda id: paper().claims(id),
]


@pytest.mark.parametrize("make", MAKERS)
def test_ids_are_checked_where_they_are_defined(make: Callable[[Any], object]) -> None:
    for good in GOOD_IDS:
        make(good)
    for bad in BAD_IDS:
        with pytest.raises(PaperDefinitionError, match="allowed: letters and digits first"):
            make(bad)


@given(st.text(max_size=8))
def test_an_id_never_leads_out_of_a_folder_or_into_markup(id: str) -> None:
    try:
        check_id("exhibit", id)
    except PaperDefinitionError:
        return
    assert (Path("here") / f"{id}.csv").resolve().parent == Path("here").resolve()
    assert re.fullmatch(r"[\w.-]+", id, re.ASCII)


@pytest.mark.parametrize("id", ["index", "Methods", "errata", "whatif"])
def test_no_paper_takes_the_name_of_another_page(id: str) -> None:
    with pytest.raises(PaperDefinitionError, match="the report has pages of the names"):
        paper(id=id)


def test_ids_differ_by_more_than_case() -> None:
    made = with_table()
    for id, said in (("table-1", "is defined twice"), ("Table-1", "differs from 'table-1' only in case")):
        with pytest.raises(PaperDefinitionError, match=said):
            made.not_computable(id, "N", "It is not.")
    table = made.exhibits["table-1"]
    table.reading("as-written", "As written")(dict)  # type: ignore[union-attr]
    with pytest.raises(PaperDefinitionError, match="only in case"):
        table.reading("As-Written", "As written")(dict)  # type: ignore[union-attr]
    claims = made.claims()
    claims.claim("big", "It is big.")(dict)  # type: ignore[arg-type]
    with pytest.raises(PaperDefinitionError, match="only in case"):
        claims.claim("BIG", "It is big.")(dict)  # type: ignore[arg-type]


WRONG: list[tuple[Callable[[], object], str]] = [
    (lambda: paper(authors="A. Author"), "authors is 'A. Author' (str); expected: a list of texts"),
    (lambda: paper(modules="exhibits"), "modules is 'exhibits' (str); expected: a list of texts"),
    (lambda: paper(numbered="table-1"), "numbered is 'table-1' (str)"),
    (lambda: paper(authors=("A", 3)), "an element of authors is 3 (int); expected: a text"),
    (lambda: paper(authors=None), "authors is missing"),
    (lambda: paper(title=None), "title is missing; expected: a text"),
    (lambda: paper(title=b"T"), "title is b'T' (bytes)"),
    (lambda: paper(year="2000"), "year is '2000'; expected: a whole number"),
    (lambda: paper(year=True), "year is True"),
    (lambda: paper(year=-1), "year is -1; expected: a whole number, 1 to 9999"),
    (lambda: with_table(printed="no"), "printed is 'no'; allowed: True, False"),
    (lambda: with_table(kind=np.array(["table", "x"])), "kind is array(['table', 'x'], dtype='<U5'); allowed: 'table'"),
    (lambda: with_table(rows=["a", ["b"]]), "an element of rows is ['b'] (list); expected: a text"),
    (lambda: with_table(rows=np.array([1, 2])), "an element of rows is np.int64(1) (int64); expected: a text"),
    (lambda: with_table(rows={"a"}), "rows is {'a'} (set); expected: a list of texts"),
    (lambda: with_table(labels=False), "labels is False (bool); expected: texts by key"),
    (lambda: with_table(spans=np.zeros(2)), "spans is array([0., 0.]) (ndarray); expected: by cell a list of others"),
    (lambda: with_table(title=pd.Series([1, 2])), "title is 0 1 1 2 dtype: int64 (Series); expected: a text"),
    (lambda: with_table(significant_digits=10**30), "significant_digits is 1" + "0" * 30 + "; expected: at most 100"),
    (lambda: with_figure("fig-1", points="no"), "points is 'no'; allowed: True, False"),
    (
        lambda: with_chart("c", parameters=np.zeros(2)),
        "parameters is array([0., 0.]) (ndarray); expected: texts by key",
    ),
    (lambda: with_chart("c", parameters={}), "chart 'c' has no parameters"),
    (lambda: with_ranking(cases=None), "cases is missing; expected: a list of texts"),
    (lambda: with_ranking(quantity=np.zeros(2)), "quantity is array([0., 0.]) (ndarray); expected: a text"),
    (lambda: with_ranking(says=3), "says is 3 (int); expected: a text"),
    (lambda: with_ranking(consequence="death"), "consequence is 'death'; allowed: 'none'"),
    (lambda: bound(two_rows(), "x", ("a",), "S", above="1"), "above is '1' (str); expected: a number"),  # type: ignore[arg-type]
    (lambda: bound(two_rows(), "x", (), "S", above=1.0), "a bound of no number says nothing"),
    (lambda: two_rows().frame(3), "what holds the rows is 3 (int); expected: a dictionary"),  # type: ignore[arg-type]
    (lambda: paper(title="a\x1b[2J"), "title holds the character U+001B"),
    (lambda: paper(citation="1\u202e2"), "citation holds the character U+202E RIGHT-TO-LEFT OVERRIDE"),
    (lambda: with_table(rows="abc"), "rows is 'abc' (str); expected: a list of texts"),
    (lambda: with_table(columns=7), "columns is 7 (int)"),
    (lambda: with_table(rows=("a", 2)), "an element of rows is 2 (int)"),
    (lambda: with_table(labels={"a": 1}), "labels of 'a' is 1 (int)"),
    (lambda: with_table(units="s"), "units is 's' (str); expected: texts by key"),
    (lambda: with_table(near=2), "near is 2 (int); expected: Near(...)"),
    (lambda: with_table(notation={"a": "percent"}), "notation of 'a' is 'percent' (str); expected: Notation(...)"),
    (lambda: with_table(notation=[]), "notation is [] (list); expected: Notation(...)"),
    (lambda: Near(units=-1), "near: units is -1; expected: a number, 0 or more"),
    (lambda: Near(fraction=math.nan), "near: fraction is nan; expected: a number, 0 or more"),
    (lambda: with_table(kind="tabel"), "kind is 'tabel'; allowed: 'table', 'example', 'formula'"),
    (lambda: with_figure("fig-1", size="big"), "size is 'big'; expected: width and height in inches"),
    (lambda: with_figure("fig-1", size=(1.0, -1.0)), "size is (1.0, -1.0)"),
    (lambda: with_figure("fig-1", alt=3), "alt is 3 (int)"),
    (lambda: paper().figure("fig-1", "F")("no function"), "what draws it is 'no function' (str)"),  # type: ignore[arg-type]
    (lambda: with_claim("c", text=None), "text is missing"),
    (lambda: with_claim("c", printed=1.5), "printed is 1.5 (float); expected: a text"),
    (lambda: with_claim("c", consequence="death"), "consequence is 'death'; allowed: 'none'"),
    (lambda: with_reading("other", note=None), "note is missing"),
    (lambda: with_table(labels="abc"), "labels is 'abc' (str); expected: texts by key"),
    (lambda: with_table(shared_labels=["x"]), "shared_labels is ['x'] (list); expected: texts by key"),
    (lambda: with_table(spans="ab"), "spans is 'ab' (str); expected: by cell a list of others, each (row, column)"),
    (lambda: with_table(spans={("a", "x"): 3}), "expected: by cell a list of others, each (row, column)"),
    (lambda: with_table(spans={("a", "x"): ("b", "x")}), "expected: by cell a list of others, each (row, column)"),
    (lambda: with_table(depends=3), "depends is 3 (int); expected: a list of texts"),
    (lambda: with_table(depends="data.csv"), "depends is 'data.csv' (str); expected: a list of texts"),
    (
        lambda: with_table(significant_digits="3"),
        "significant_digits is '3' (str); expected: a whole number, 1 or more",
    ),
    (lambda: with_table(significant_digits=0), "significant_digits is 0 (int); expected: a whole number, 1 or more"),
    (lambda: with_table(significant_digits=2.5), "significant_digits is 2.5 (float)"),
    (lambda: with_reading("other", inputs="abc"), "reading 'other': inputs is 'abc' (str); expected: a list of texts"),
    (lambda: with_reading("other", inputs=3), "inputs is 3 (int); expected: a list of texts"),
    (lambda: with_reading("other", inputs=[3]), "an element of inputs is 3 (int); expected: a text"),
    (lambda: with_reading("other", inputs_of=["a"]), "inputs_of is ['a'] (list); expected: a dictionary"),
    (lambda: with_reading("other", inputs_of={"a": "x"}), "inputs_of of 'a' is 'x' (str); expected: a list of texts"),
    (lambda: with_reading("other", tried="ab"), "tried is 'ab' (str); expected: a dictionary"),
    (lambda: with_reading("other", tried={"a": None}), "tried of 'a' is missing; expected: a whole number, 1 or more"),
    (lambda: with_reading("other", tried={"a": -1}), "tried of 'a' is -1 (int); expected: a whole number, 1 or more"),
    (lambda: with_reading("other", tried={1: 2}), "a key of tried is 1 (int); expected: a text"),
    (lambda: with_reading("other", rules_out={"x": 3}), "rules_out of 'x' is 3 (int); expected: a function"),
    (lambda: paper().not_computable("fig-1", "N", None), "reason is missing"),  # type: ignore[arg-type]
]


@pytest.mark.parametrize(("define", "said"), WRONG)
def test_wrong_types_are_named(define: Callable[[], object], said: str) -> None:
    with pytest.raises(PaperDefinitionError, match=re.escape(said)):
        define()


def test_rows_may_be_anything_that_has_an_order() -> None:
    for rows in (["a", "b"], np.array(["a", "b"]), (key for key in "ab"), {"a": 1, "b": 2}):
        assert paper().table("table-1", "T", rows=rows, columns=("x",)).rows == ("a", "b")  # type: ignore[arg-type]


PLACES = [
    ('authors=("N. N.",)', 'authors="N. N."', "lab_paper/__init__.py:4: paper 'lab': authors is 'N. N.'"),
    ('modules=("exhibits",)', 'modules="exhibits"', "lab_paper/__init__.py:4: paper 'lab': modules is 'exhibits'"),
    ('id="lab"', 'id="index"', "lab_paper/__init__.py:4: 'index' is not an id of a paper"),
    (
        '"fig-1", "A decaying',
        '"../fig-1", "A decaying',
        "lab_paper/exhibits.py:26: '../fig-1' is not an id of an exhibit",
    ),
    (
        '"decimal", "Log',
        '"as-written", "Log',
        "lab_paper/exhibits.py:21: reading of table-1 'as-written' is defined twice",
    ),
    (
        "\n@table.reading",
        "\n# @table.reading",
        "lab_paper/exhibits.py: table-1 has no reading; expected: one or more, ",
    ),
    ('"as-written", "As', '"first", "As', "lab_paper/exhibits.py:14: table-1: the first reading must be 'as-written'"),
]


@pytest.mark.parametrize(("before", "after", "said"), PLACES)
def test_file_and_line_of_a_wrong_definition(replicate: Run, folder: Path, before: str, after: str, said: str) -> None:
    for path in folder.glob("*.py"):
        path.write_text(path.read_text().replace(before, after))
    status, out, err = replicate("check", "lab", "-j1", "--accepted", "nowhere")
    assert (status, out) == (2, "")
    assert said in err
    assert "Traceback" not in err
    assert "unexpected" not in err


def test_records_cannot_be_changed_into_wrong_ones() -> None:
    made = with_table()
    with pytest.raises(PaperDefinitionError):
        dataclasses.replace(made.exhibits["table-1"], id="a/b")
