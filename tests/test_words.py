"""What is said of an exhibit is state like its numbers: whatever changes in it is told by diff and accepted."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import synthetic

from replicate.diff.accept import accept
from replicate.diff.comparison import compare
from replicate.exhibits import Claims, Paper, Table
from replicate.run.outcome import Outcome
from replicate.verdicts.inputs import Inputs
from replicate.verdicts.judge import judge
from replicate.verdicts.ledger import Ledger, LedgerEntry

ENTRY = LedgerEntry("table-1", ("B",), ("y",), "scan", "The page is torn: {{ value('table-1', 'B', 'y') }}.")


def outcome(
    folder: Path, change: Callable[[Paper], Any] = lambda _: None, entry: LedgerEntry | None = ENTRY
) -> Outcome:
    folder.mkdir(exist_ok=True)
    toy = synthetic.paper(folder)
    change(toy)
    inputs = Inputs(synthetic.printed(by="4.6"), Ledger((entry,) if entry else ()))
    results = synthetic.results()
    del results["toy", "fig-1"]
    return Outcome([toy], results, {"toy": judge(toy, results, inputs)}, inputs={"toy": inputs})


def table(paper: Paper) -> Table:
    found = paper.exhibits["table-1"]
    assert isinstance(found, Table)
    return found


def note(paper: Paper) -> None:
    readings = table(paper).readings
    readings["authors"] = replace(readings["authors"], note="Grid of 0.1.", title="As computed then")


def wording(paper: Paper) -> None:
    claims = paper.exhibits["claims"]
    assert isinstance(claims, Claims)
    claims.claims["big"] = replace(claims.claims["big"], text="x is above 2.4")


CASES: list[tuple[Callable[[Paper], Any], LedgerEntry | None, list[str]]] = [
    (
        lambda _: None,
        replace(ENTRY, cause="misprint", corrected="4.0"),
        [
            "toy/table-1: explanation of B / y: cause 'scan' -> 'misprint'",
            "toy/table-1: explanation of B / y: corrected nothing -> '4.0'",
        ],
    ),
    (
        lambda _: None,
        replace(ENTRY, explanation="The page is torn: {{ value('table-1', 'B', 'x') }}."),
        ["toy/table-1: explanation of B / y: explanation '… is torn: {{ value('table-1', 'B', 'y') }}.' -> "],
    ),
    (lambda _: None, None, ["toy/table-1: explanation of B / y: cause 'scan' -> nothing"]),
    (
        note,
        ENTRY,
        [
            "toy/table-1: reading 'authors': title 'As the authors computed' -> 'As computed then'",
            "toy/table-1: reading 'authors': note nothing -> 'Grid of 0.1.'",
        ],
    ),
    (wording, ENTRY, ["toy/claims: claim 'big' 'x is above 2.5' -> 'x is above 2.4'"]),
]


@pytest.mark.parametrize(("change", "entry", "said"), CASES)
def test_words_that_change_are_told_and_accepted(
    tmp_path: Path, change: Callable[[Paper], Any], entry: LedgerEntry | None, said: list[str]
) -> None:
    accepted = tmp_path / "accepted"
    accept(outcome(tmp_path / "data"), accepted, "first")
    assert compare(outcome(tmp_path / "data"), accepted).lines == []
    present = outcome(tmp_path / "data", change, entry)
    lines = compare(present, accepted).lines
    for sentence in said:
        assert any(line.startswith(sentence) for line in lines), lines
    accept(present, accepted, "said better")
    assert compare(present, accepted).lines == []
    log = (accepted / "CHANGES.md").read_text()
    assert all(sentence in log for sentence in said)


def test_words_that_were_never_accepted_or_are_damaged(tmp_path: Path) -> None:
    accepted, present = tmp_path / "accepted", outcome(tmp_path / "data")
    accept(present, accepted, "first")
    path = accepted / "toy/table-1.json"
    good = path.read_text()
    path.unlink()
    (line,) = compare(present, accepted).lines
    assert "what is said of it has no accepted state: toy/table-1.json is missing" in line
    for text, why in (
        (good.replace("{", "", 1), "is not valid JSON"),
        ("[]", "needed: an object"),
        (good.replace('"version": 1', '"version": 2'), "needed: an object"),
        (json.dumps({**json.loads(good), "words": {"title": 1}}), "needed: an object"),
    ):
        path.write_text(text)
        (line,) = compare(present, accepted).lines
        assert "table-1.json" in line
        assert why in line
