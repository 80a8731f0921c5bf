"""Exhibits, claims, readings and charts appear in the paper's order, whatever imports what."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from replicate.errors import PaperDefinitionError
from replicate.exhibits import Claims, Paper, Table

INIT = """
from replicate.exhibits import Paper

paper = Paper("order_lab", __name__, "A laboratory", ("N. N.",), "N. N., 2000.", 2000, {modules}, numbered=())
"""

#: The first module needs something of each later one, and so defines its own exhibits last.
MODULES = {
    "first": """
from order_lab import paper
from order_lab.second import LIMIT
from order_lab.third import claims

table = paper.table("table-1", "Numbers", printed=False)

@paper.chart("one", "A chart", parameters={"x": "a number"})
def chart(fig, x): ...

@claims.claim("a", "It is small.")
def small(): ...
""",
    "second": """
from order_lab import paper

LIMIT = 2.0

for number in (1, 2):
    @paper.figure(f"fig-{number}", "Curves")
    def draw(fig): ...

@paper.chart("two", "A chart", parameters={"x": "a number"})
def chart(fig, x): ...
""",
    "third": """
from order_lab import paper

claims = paper.claims()
paper.not_computable("fig-9", "A photograph", "It shows the plant.")

@claims.claim("b", "It is large.")
def large(): ...
""",
    "helper": """
from order_lab.first import table

@table.reading("as-written", "As written")
def numbers(): ...
""",
    "another": """
from order_lab.first import table
import order_lab.helper

@table.reading("rounded", "Rounded")
def numbers(): ...
""",
}


@pytest.fixture
def lab(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Lab]:
    def make(modules: tuple[str, ...]) -> Paper:
        folder = tmp_path / "order_lab"
        folder.mkdir()
        (folder / "__init__.py").write_text(INIT.format(modules=modules), encoding="utf-8")
        for name, code in MODULES.items():
            (folder / f"{name}.py").write_text(code, encoding="utf-8")
        monkeypatch.syspath_prepend(str(tmp_path))
        importlib.invalidate_caches()
        paper: Paper = importlib.import_module("order_lab").paper
        return paper

    yield make
    for name in [name for name in sys.modules if name.split(".")[0] == "order_lab"]:
        del sys.modules[name]


Lab = Callable[[tuple[str, ...]], Paper]


@pytest.mark.parametrize("imported_before", ["", "third", "second", "first", "another"])
def test_the_list_of_modules_decides_not_who_imports_what(lab: Lab, imported_before: str) -> None:
    paper = lab(("first", "second", "third", "another", "helper"))
    if imported_before:
        importlib.import_module(f"order_lab.{imported_before}")
    paper.load()
    assert list(paper.exhibits) == ["table-1", "fig-1", "fig-2", "claims", "fig-9"]
    assert list(paper.charts) == ["one", "two"]
    claims, table = paper.exhibits["claims"], paper.exhibits["table-1"]
    assert isinstance(claims, Claims)
    assert list(claims.claims) == ["a", "b"]
    assert isinstance(table, Table)
    assert list(table.readings) == ["as-written", "rounded"]


def test_another_list_gives_another_order(lab: Lab) -> None:
    assert list(lab(("third", "second", "first")).load().exhibits) == ["claims", "fig-9", "fig-1", "fig-2", "table-1"]


def test_a_module_that_is_not_listed_has_no_place(lab: Lab) -> None:
    with pytest.raises(PaperDefinitionError, match="order_lab: module 'second' defines 'fig-1' but is not listed"):
        lab(("first", "third")).load()
