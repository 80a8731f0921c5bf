"""The exhibits of the bundled papers appear as the papers number them."""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from importlib.util import find_spec
from pathlib import Path

import pytest

from replicate.exhibits import Paper
from replicate.run.library import Library

PAPERS = Library(bundled=True).papers()
by_paper = pytest.mark.parametrize("paper", PAPERS, ids=[paper.id for paper in PAPERS])


@by_paper
def test_tables_figures_and_examples_are_numbered_upwards(paper: Paper) -> None:
    numbers = defaultdict(list)
    for id in paper.exhibits:
        found = re.fullmatch(r"(.*(?:table|fig|example))-([\d-]+)([a-z]?)", id)
        if found:
            family, number, letter = found.groups()
            numbers[family].append((*map(int, number.split("-")), letter))
    assert numbers
    assert {family: sorted(found) for family, found in numbers.items()} == numbers


@pytest.mark.parametrize(
    ("id", "earlier", "later"),
    [
        ("krajewski", "fig-5", "table-1"),
        ("krajewski", "table-1", "fig-6"),
        ("khan", "fig-5", "example-2-1"),
        ("khan", "example-2-3", "fig-6"),
        ("khan", "fig-7", "example-3-1"),
        ("khan", "table-1", "fig-8a"),
        ("panagopoulos", "IIs-fig-3", "IIs-example"),
        ("panagopoulos", "IIs-example", "IIs-fig-4"),
    ],
)
def test_what_stands_before_what_in_the_paper(id: str, earlier: str, later: str) -> None:
    (paper,) = Library().papers([id])
    order = list(paper.exhibits)
    assert order.index(earlier) < order.index(later)


@by_paper
def test_a_module_takes_nothing_from_one_that_comes_later_in_the_paper(paper: Paper) -> None:
    place = {f"{paper.package}.{name}": n for n, name in enumerate(paper.modules)}
    wrong = []
    for name, n in place.items():
        spec = find_spec(name)
        assert spec is not None
        assert spec.origin is not None
        tree = ast.parse(Path(spec.origin).read_text(encoding="utf-8"))
        modules = [node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) and node.module]
        wrong += [f"{name} imports {module}" for module in modules if place.get(module, -1) > n]
    assert not wrong
