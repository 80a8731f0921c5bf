"""`replicate whatif`: a page for one loop, errors in one line, and no file of somebody else's replaced."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import pytest

from replicate.exhibits import Paper
from replicate.exhibits.results import Results, TableResult
from replicate.exhibits.trials import TableTrials, Trial
from replicate.whatif import NAME, Row, unreadable_loops, whatif_page, write_whatif
from replicate.whatif.reference import optimal

Run = Callable[..., tuple[int, str, str]]
PLANT = ("--plant", "e^{-s}/(s+1)")


def test_a_page_is_made_and_made_again(replicate: Run, tmp_path: Path) -> None:
    out = tmp_path / "lecture" / "loop.html"
    for gain in ("0.6", "0.7"):
        status, _, _ = replicate("whatif", *PLANT, "--controller", f"k={gain},ki=0.5", "--out", str(out))
        assert status == 0
        assert f"k={gain},ki=0.5" in out.read_text(encoding="utf-8")
    assert [path.name for path in out.parent.iterdir()] == [out.name]


def test_a_file_of_somebody_else_stays(replicate: Run, tmp_path: Path) -> None:
    out = tmp_path / "notes.html"
    out.write_text("mine", encoding="utf-8")
    status, _, said = replicate("whatif", *PLANT, "--controller", "k=0.6", "--out", str(out))
    assert status == 2
    assert "is in the way, and is not as an earlier run wrote it" in said
    assert out.read_text(encoding="utf-8") == "mine"


@pytest.mark.parametrize(
    ("plant", "controller", "reason"),
    [
        ("1/(s+1)(s+2)", "k=1", "column 8: is this above or below the division?"),
        ("e^{-s}/(s+1)", "PI", "'PI' is not known; allowed are k, ki, kd"),
        ("e^{-sqrt(s)}", "k=1", "rational plants with one dead time, of order 15 at most"),
        ("e^{-s}/(s+1)+e^{-2s}/(s+2)", "k=1", "rational plants with one dead time"),
        ("1/(s+1)^16", "k=1", "of order 15 at most"),
        ("(s+1)/(s+2)", "k=1", "answers at once"),
        ("1/(s+1)", "k=1,measurement_filter=0.1", "draws no measurement filter"),
        ("1/(s+1)", "k=1e308", "with a number beyond 1e+09"),
        ("1e300/(s+1)", "k=1", "whose numbers lie so far apart"),
        ("e^{-1e-308s}/(s+1)", "k=1,ki=1", "whose numbers lie so far apart"),
        ("s/(s+1)^2", "k=1,ki=1", "lets nothing through at rest"),
    ],
)
def test_what_cannot_be_drawn_is_refused_in_one_line(
    replicate: Run, tmp_path: Path, plant: str, controller: str, reason: str
) -> None:
    out = tmp_path / "f.html"
    status, _, said = replicate("whatif", "--plant", plant, "--controller", controller, "--out", str(out))
    assert status == 2
    assert reason in said
    assert len(said.strip().splitlines()) == 1
    assert not out.exists()


def lab(*trials: Trial) -> tuple[list[Paper], Results]:
    """Return a paper with one table, and loops of its rows as a run has listed them."""
    paper = Paper(
        id="mine", package="mine", title="T", authors=("A",), citation="C", year=2020, modules=(), numbered=()
    )
    paper.table(
        "table-2", "Table II: rows", labels={"b": "*b* of mine"}, rows=("a", "b"), columns=("k",), printed=False
    )
    return [paper], {("mine", "table-2"): TableResult("mine", "table-2", trials=TableTrials(trials))}


def test_rows_that_are_not_drawn_are_left_out_of_a_report(tmp_path: Path) -> None:
    given = lab(Trial("a", "", "e^{-sqrt(s)}", "k=1"), Trial("b", "", "e^{-s}/(s+1)", "k=0.5,ki=0.4"))
    assert write_whatif(*given, tmp_path) == [tmp_path / NAME]
    page = (tmp_path / NAME).read_text(encoding="utf-8")
    assert "A 2020, Table II: b of mine" in page
    assert "Table II: a" not in page
    assert not unreadable_loops(*given)


def test_a_loop_that_is_not_understood_is_named_with_its_row() -> None:
    given = lab(Trial("a", "", "1/s", "k=1"), Trial("b", "fast", "1/(s+", "k=1"))
    (said,) = unreadable_loops(*given).values()
    assert said.startswith("mine/table-2: b, fast: plant '1/(s+'")


def test_the_page_is_the_same_each_time() -> None:
    rows = [Row("one", "e^{-s}/(s+1)", "k=0.6,ki=0.5"), Row("<two>", "1/(s+1)^3", "k=1,ki=0.5")]
    page = whatif_page(rows, "What if?")
    assert page == whatif_page(rows, "What if?")
    assert "<two>" not in page


def test_a_plant_of_higher_order_has_the_rule_of_its_stability_limit() -> None:
    marked = {rule["name"]: rule for rule in optimal("1/(s+1)^4")}
    k, ki = 0.45 * 4.0, 0.45 * 4.0 * 1.2 / (2.0 * math.pi)  # Ku = 4 and Tu = 2 pi: the phase of (1 + i)^4 is pi
    assert [marked["ZN"]["k"], marked["ZN"]["ki"]] == pytest.approx([k, ki])
    assert list(marked) == ["Ms 1.4", "Ms 2.0", "ZN"]
    assert [rule["name"] for rule in optimal("e^{-s}/(s+1)")] == ["Ms 1.4", "Ms 2.0"]  # the page knows ZN itself
