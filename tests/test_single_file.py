"""A paper as one file: complete, self-contained, and without a link that leads nowhere."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from urllib.parse import unquote_to_bytes

import pytest

Run = Callable[..., tuple[int, str, str]]


def test_one_file_holds_the_paper_and_its_data(replicate: Run) -> None:
    code, out, _ = replicate("report", "lab", "--single-file")
    assert code == 0
    assert out.rstrip().endswith("in one file: build/lab.html")
    page = Path("build/lab.html").read_text(encoding="utf-8")
    addresses = re.findall(r' (?:href|src)="([^"]*)"', page)
    ids = set(re.findall(r' id="([^"]*)"', page))
    assert addresses
    for address in addresses:
        assert address.startswith(("#", "data:text/csv;charset=utf-8,")), address
        if address.startswith("#") and len(address) > 1:
            assert address[1:] in ids
    for nowhere in ("All papers", ">Search", "Environment"):
        assert nowhere not in page
    data = [unquote_to_bytes(one.partition(",")[2]) for one in addresses if one.startswith("data:")]
    assert Path("build/tables/lab/table-1.as-written.csv").read_bytes() in data
    assert Path("build/figures/lab/fig-1.csv").read_bytes() in data
    for text in ("Roots and logarithms", "A decaying oscillation", "A photograph", "The root of two is below 1.5."):
        assert text in page


def test_the_file_goes_when_it_is_not_wanted_any_more(replicate: Run) -> None:
    replicate("report", "lab", "--single-file")
    replicate("report", "lab")
    assert not Path("build/lab.html").exists()


@pytest.mark.parametrize("name", ["results.csv", "verdicts.csv", "columns.csv", "tables/lab/table-1.decimal.csv"])
def test_the_report_carries_the_same_data(replicate: Run, name: str) -> None:
    replicate("report", "lab")
    assert Path("build", name).read_bytes() == Path("build/report/data", name).read_bytes()


def test_columns_are_named(replicate: Run) -> None:
    replicate("report", "lab")
    rows = Path("build/columns.csv").read_text(encoding="utf-8").splitlines()
    assert rows[0] == "file,panel,column,label,unit"
    assert "tables/lab/table-1.*.csv,,root,root," in rows
    assert "figures/lab/fig-1.csv,panel 1,x,time," in rows
