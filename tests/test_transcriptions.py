"""Two transcriptions of one table."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

Run = Callable[..., tuple[int, str, str]]


def write(name: str, text: str) -> str:
    Path(name).write_text(text, encoding="utf-8")
    return name


def test_every_difference_is_named_with_both_places(replicate: Run) -> None:
    one = write("one.csv", "row,x,y\nA,1.0,2\nB,3,\nC,5,6\n")
    other = write("other.csv", "row,x,z\nA,1.00,2\nB,3,4\n")
    status, out, _ = replicate("printed", "compare", one, other)
    assert status == 1
    assert out.splitlines() == [
        "one.csv:4: row 'C' is not in other.csv",
        "one.csv:1: column 'y' is not in other.csv",
        "other.csv:1: column 'z' is not in one.csv",
        "one.csv:2 and other.csv:2: row 'A', column 'x': '1.0' and '1.00'",
        "cells compared: 2; differences: 4",
    ]


def test_blank_cells_count(replicate: Run) -> None:
    one, other = write("one.csv", "row,x\nA,1\n\nB,\n"), write("other.csv", "row,x\nA,1\nB,2\n")
    status, out, _ = replicate("printed", "compare", one, other)
    assert status == 1
    assert "one.csv:4 and other.csv:3: row 'B', column 'x': blank and '2'" in out


def test_equal_transcriptions(replicate: Run) -> None:
    one = write("one.csv", "row,x\nA,1\n")
    assert replicate("printed", "compare", one, one)[:2] == (0, "cells compared: 1; differences: 0\n")


def test_another_order_is_a_difference(replicate: Run) -> None:
    one, other = write("one.csv", "row,x\nA,1\nB,2\n"), write("other.csv", "row,x\nB,2\nA,1\n")
    status, out, _ = replicate("printed", "compare", one, other)
    assert (status, out.splitlines()[0]) == (1, "one.csv and other.csv: rows or columns are in another order")


def test_a_damaged_file_is_named(replicate: Run) -> None:
    one, other = write("one.csv", "row,x\nA,1\n"), write("other.csv", "row,x\nA,1\nA,2\n")
    status, _, err = replicate("printed", "compare", one, other)
    assert (status, err) == (2, "replicate: other.csv:3: row 'A' appears twice (first in line 2)\n")
    assert replicate("printed", "compare", one, "nothing.csv")[0] == 2
