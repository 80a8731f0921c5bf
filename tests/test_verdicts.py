from __future__ import annotations

import copy
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import synthetic
from synthetic import frame, printed, results

from replicate.exhibits import AS_WRITTEN, Finding
from replicate.exhibits.matching import Match
from replicate.exhibits.printed import PrintedValue
from replicate.exhibits.results import FigureResult, Results, TableResult
from replicate.verdicts.inputs import Inputs, read_inputs
from replicate.verdicts.judge import judge
from replicate.verdicts.ledger import Ledger, LedgerEntry
from replicate.verdicts.rows import Computed, ExhibitRow, Judgement, ResultRow, VerdictRow

A_X = ("A", "x")


def entry(
    cause: str = "method",
    rows: tuple[str, ...] = ("A",),
    columns: tuple[str, ...] = ("x",),
    *,
    explanation: str = "Because.",
    reading: str = AS_WRITTEN,
    corrected: str = "",
    evidence: str = "",
) -> LedgerEntry:
    return LedgerEntry(
        "table-1",
        rows,
        columns,
        cause,  # type: ignore[arg-type]  # parametrised tests hand in plain text
        explanation,
        reading,
        corrected,
        evidence,
        file="toy/ledger.toml",
        line=7,
    )


def judged(*entries: LedgerEntry, run: Results | None = None, **texts: str) -> Judgement:
    """Judge the tiny paper with some of its printed texts changed."""
    return judge(
        synthetic.paper(),
        results() if run is None else run,
        Inputs(printed(significant_digits=None, **texts), Ledger(entries)),
    )


def verdict(judgement: Judgement, row: str = "A", column: str = "x") -> VerdictRow:
    (found,) = [item for item in judgement.verdicts if (item.row, item.column) == (row, column)]
    return found


def exhibit(judgement: Judgement, id: str) -> ExhibitRow:
    (found,) = [item for item in judgement.exhibits if item.exhibit == id]
    return found


def test_everything_holds() -> None:
    judgement = judged()
    assert judgement.problems == []
    table = [row for row in judgement.verdicts if row.exhibit == "table-1"]
    assert [(row.row, row.column, row.verdict) for row in table] == [
        ("A", "x", "reproduced"),
        ("A", "y", "reproduced"),
        ("B", "x", "reproduced"),
        ("B", "y", "reproduced"),
    ]
    assert judgement.results[:2] == [
        ResultRow("toy", "table-1", "A", "x", "1.0", "as-written", "1", "equal", "either"),
        ResultRow("toy", "table-1", "A", "x", "1.0", "authors", "1", "equal", "either"),
    ]
    assert judgement.exhibits == [
        ExhibitRow("toy", "table-1", "table", "Numbers", "done"),
        ExhibitRow("toy", "fig-1", "figure", "Curves", "done"),
        ExhibitRow("toy", "claims", "claims", "Claims made in the text", "done"),
        ExhibitRow("toy", "fig-2", "figure", "A photograph", "not-computable", "It shows the plant."),
    ]


def test_another_reading_reconstructs() -> None:
    found = verdict(judged(run=results(as_written=frame(ax=1.7)), ax="1.000"))
    assert (found.verdict, found.reading, found.computed) == ("reconstructed", "authors", "1")
    assert found.explanation == "As the authors computed"


@pytest.mark.parametrize(
    ("run", "reading", "remark"),
    [
        (results(as_written=frame(ax=1.15), authors=frame(ax=1.16)), "as-written", ""),
        (
            results(as_written=frame(ax=1.7), authors=frame(ax=1.16)),
            "authors",
            "Near under the reading “authors” only, one of 2.",  # which nothing else speaks for
        ),
    ],
)
def test_near_needs_no_entry(run: dict, reading: str, remark: str) -> None:  # type: ignore[type-arg]
    judgement = judged(run=run)
    found = verdict(judgement)
    assert (found.verdict, found.reading, found.explanation) == ("near", reading, remark)
    assert judgement.problems == []


def test_silence_is_a_problem() -> None:
    judgement = judged(ax="1.7")
    assert verdict(judgement).verdict == "unexplained"
    assert judgement.problems == [
        "toy table-1: row 'A', column 'x': printed 1.7, computed as-written 1, authors 1: has no ledger entry"
    ]


@pytest.mark.parametrize(
    ("cause", "expected"),
    [
        ("misprint", "misprint"),
        ("scan", "damaged"),
        ("print-or-copy", "damaged"),
        ("definition", "discrepant"),
        ("method", "discrepant"),
        ("optimiser", "discrepant"),
        ("rounding", "discrepant"),
        ("measured", "not-computable"),
        ("unavailable", "not-computable"),
        ("unknown", "unexplained"),
    ],
)
@pytest.mark.parametrize("where", [(("A",), ("x",)), (("*",), ("x",)), (("*",), ("*",))])
def test_an_entry_explains(cause: str, expected: str, where: tuple[tuple[str], tuple[str]]) -> None:
    judgement = judged(entry(cause, *where, evidence="See there."), ax="1.7")
    found = verdict(judgement)
    assert (found.verdict, found.cause, found.explanation) == (expected, cause, "Because. See there.")
    assert found.corrected == ("1.0" if expected in {"misprint", "damaged"} else "")
    assert verdict(judgement, "A", "y").verdict == "reproduced"
    assert judgement.problems == []


def test_an_entry_goes_before_near() -> None:
    judgement = judged(entry("rounding"), ax="1.1")
    assert verdict(judgement).verdict == "discrepant"


def test_a_cell_that_is_named_wins_over_a_star() -> None:
    judgement = judged(entry("unknown", ("*",), ("*",)), entry("definition"), ax="1.7", by="4.9")
    assert verdict(judgement).cause == "definition"
    assert verdict(judgement, "B", "y").cause == "unknown"
    assert judgement.problems == []


@pytest.mark.parametrize(
    ("found", "texts", "message"),
    [
        (entry(), {}, "toy/ledger.toml:7: table-1 row 'A', column 'x' no longer differs"),
        (
            entry(rows=("A", "B")),
            {"ax": "1.7"},
            "toy/ledger.toml:7: table-1 row 'B', column 'x' no longer differs",
        ),
        (entry(), {"ax": ""}, "toy/ledger.toml:7: table-1 row 'A', column 'x' is blank in the paper"),
        (
            entry(rows=("*",)),
            {},
            "toy/ledger.toml:7: table-1: explains no printed value that differs",
        ),
    ],
)
def test_an_entry_that_no_longer_applies_is_a_problem(found: LedgerEntry, texts: dict[str, str], message: str) -> None:
    assert judged(found, run=results(), **texts).problems == [message]


def test_a_reconstructed_value_needs_no_entry() -> None:
    judgement = judged(entry(), run=results(as_written=frame(ax=1.7)), ax="1.000")
    assert verdict(judgement).verdict == "reconstructed"
    assert judgement.problems == ["toy/ledger.toml:7: table-1 row 'A', column 'x' no longer differs"]


def test_the_right_value_comes_from_the_named_reading() -> None:
    run = results(as_written=frame(ax=1.4), authors=frame(ax=1.26))
    found = verdict(judged(entry("misprint", reading="authors"), run=run, ax="9.2"))
    assert (found.verdict, found.reading, found.computed, found.corrected) == (
        "misprint",
        "authors",
        "1.26",
        "1.3",
    )


def test_a_reading_that_gives_the_print_does_not_say_how_far_off_it_is() -> None:
    """One that is too weak to reconstruct a cell would call it wrong and right at once."""
    run = results(as_written=frame(ax=1.7))
    found = verdict(judged(entry(reading="authors"), run=run))
    assert (found.verdict, found.reading, found.computed) == ("discrepant", "as-written", "1.7")


@pytest.mark.parametrize("corrected", ["1.3", "1.2", "1"])
def test_a_stated_right_value_is_checked(corrected: str) -> None:
    run = results(as_written=frame(ax=1.26), authors=frame(ax=1.26))
    judgement = judged(entry("misprint", corrected=corrected), run=run, ax="9.2")
    assert verdict(judgement).corrected == corrected
    assert judgement.problems == []


@pytest.mark.parametrize(
    ("corrected", "message"),
    [
        ("1.5", "corrected = '1.5', but reading 'as-written' gives 1.26"),
        ("1.26", "corrected = '1.26' has more digits than its evidence: 1.3"),
    ],
)
def test_a_wrong_right_value_explains_nothing(corrected: str, message: str) -> None:
    run = results(as_written=frame(ax=1.26), authors=frame(ax=1.26))
    judgement = judged(entry("misprint", corrected=corrected), run=run, ax="9.2")
    assert verdict(judgement).verdict == "unexplained"
    assert judgement.problems[0] == f"toy/ledger.toml:7: table-1 row 'A', column 'x': {message}"
    assert judgement.problems[1].endswith("has no ledger entry")


def test_a_misprint_needs_a_computed_value() -> None:
    judgement = judged(entry("misprint"), run=results(frame(ax=math.nan), frame(ax=math.nan)), ax="9.2")
    assert verdict(judgement).verdict == "unexplained"
    assert judgement.problems[0].endswith("reading 'as-written' gives no value that could be the right one")


def test_if_the_first_reading_raised_there_is_no_verdict() -> None:
    judgement = judged(run=results(errors={AS_WRITTEN: "ZeroDivisionError: no gain"}))
    assert not [row for row in judgement.verdicts if row.exhibit == "table-1"]
    assert judgement.problems == ["toy table-1: reading 'as-written' failed: ZeroDivisionError: no gain"]


def test_another_reading_that_raised_does_not_take_the_first_down() -> None:
    judgement = judged(run=results(errors={"authors": "no grid"}))
    assert {row.verdict for row in judgement.verdicts if row.exhibit == "table-1"} == {"reproduced"}


def test_if_all_readings_raised_that_is_the_problem() -> None:
    judgement = judged(run=results(errors={AS_WRITTEN: "no gain", "authors": "no grid"}))
    assert not [row for row in judgement.verdicts if row.exhibit == "table-1"]
    assert judgement.problems == [
        "toy table-1: reading 'as-written' failed: no gain",
        "toy table-1: reading 'authors' failed: no grid",
    ]
    assert exhibit(judgement, "table-1").status == "not-computable"
    assert "reading 'as-written' failed: no gain" in exhibit(judgement, "table-1").reason


def test_a_reading_without_frame_or_error_is_a_problem() -> None:
    run = results()
    run["toy", "table-1"] = TableResult("toy", "table-1", {AS_WRITTEN: frame()})
    assert judged(run=run).problems == ["toy table-1: reading 'authors' was not computed"]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda made: made.drop(index="A"), "row 'A' is missing"),
        (lambda made: made.drop(columns="y"), "column 'y' is missing"),
        (lambda made: made.reset_index(drop=True), "row 'A' is missing"),
        (lambda made: pd.concat([made, made.loc[["B"]]]), "row 'B' appears twice"),
    ],
)
def test_missing_keys_are_named_once(change: Callable[[pd.DataFrame], pd.DataFrame], message: str) -> None:
    judgement = judged(run=results(as_written=change(frame())))
    assert f"toy table-1: reading 'as-written': {message}" in judgement.problems
    assert len(set(judgement.problems)) == len(judgement.problems)


@pytest.mark.parametrize("nothing", [math.nan, None, pd.NA, np.float64("nan")])
def test_nothing_computed(nothing: object) -> None:
    judgement = judged(entry("unavailable"), run=results(frame(ax=nothing), frame(ax=nothing)))
    assert judgement.problems == []
    assert verdict(judgement).verdict == "not-computable"
    assert (judgement.results[0].computed, judgement.results[0].match) == ("", "none")
    assert exhibit(judgement, "table-1") == ExhibitRow(
        "toy",
        "table-1",
        "table",
        "Numbers",
        "partly",
        "1 of 4 printed values cannot be computed (inputs not given)",
    )


@pytest.mark.parametrize(
    ("value", "shown"), [("1.0", r"text ('1.0')"), (True, "bool (True)"), (1 + 0j, "complex ((1+0j))")]
)
def test_only_numbers_are_numbers(value: object, shown: str) -> None:
    made = frame().astype(object)
    made["x"] = pd.Series([value, *made["x"].tolist()[1:]], made.index, dtype=object)
    judgement = judged(run=results(as_written=made), ax="1.000")
    assert judgement.problems == [
        f"toy table-1: reading 'as-written': row 'A', column 'x' holds {shown}; expected: a number"
    ]
    assert verdict(judgement).verdict == "reconstructed"


@pytest.mark.parametrize("value", [1, np.int64(1), np.float64(1.0), 1.0])
def test_numbers_of_any_type_are_numbers(value: object) -> None:
    assert verdict(judged(run=results(as_written=frame(ax=value).astype(object)))).verdict == "reproduced"


def test_measured_values_leave_an_exhibit_not_computable() -> None:
    texts = {"ax": "8.1", "ay": "8.2", "bx": "8.3", "by": "8.4"}
    judgement = judged(entry("measured", ("*",), ("*",)), run=results(), **texts)
    assert exhibit(judgement, "table-1").status == "not-computable"
    assert judgement.problems == []


def test_blank_cells_have_no_rows() -> None:
    judgement = judged(ax="")
    assert [row for row in judgement.verdicts if (row.row, row.column) == A_X] == []
    assert len([row for row in judgement.results if row.exhibit == "table-1"]) == 6


def test_significant_digits() -> None:
    run = results(as_written=frame(ax=6.968004), authors=frame(ax=6.96801))
    made = printed("6.968", significant_digits=6)
    judgement = judge(synthetic.paper(significant_digits=6), run, Inputs(made))
    kinds = [row.match for row in judgement.results if (row.row, row.column) == A_X]
    assert kinds == ["equal", "near"]


def test_claims() -> None:
    judgement = judged()
    assert verdict(judgement, "big", "claim") == VerdictRow(
        "toy",
        "claims",
        "big",
        "claim",
        "2.5",
        "holds",
        "as-written",
        "3.1",
        explanation="The smallest is 3.1.",
        value=PrintedValue("2.5"),
        values=(Computed("as-written", 3.1, Match("differs")),),
    )
    assert verdict(judgement, "smooth", "claim").verdict == "fails"
    assert [row for row in judgement.results if row.exhibit == "claims"] == [
        ResultRow("toy", "claims", "big", "claim", "2.5", "as-written", "3.1", "differs", "")
    ]


@pytest.mark.parametrize("kind", ["fails", "holds-partly"])
def test_a_claim_that_fails_needs_evidence(kind: str) -> None:
    findings = {"big": Finding(kind, 3.1, " "), "smooth": Finding("holds", 0.0, "")}  # type: ignore[arg-type]
    assert judged(run=results(findings=findings)).problems == [
        f"toy claims: claim 'big': {kind}, but its evidence is empty"
    ]


def test_a_claim_that_was_not_checked() -> None:
    judgement = judged(run=results(findings={"big": Finding("holds", 3.1, "")}))
    assert judgement.problems == ["toy claims: claim 'smooth': was not checked"]
    assert not [row for row in judgement.verdicts if row.row == "smooth"]
    assert exhibit(judgement, "claims").status == "partly"


def test_a_figure_that_raised() -> None:
    run = results()
    drawn = run["toy", "fig-1"]
    assert isinstance(drawn, FigureResult)
    run["toy", "fig-1"] = FigureResult("toy", "fig-1", "", b"", drawn.curves, [], "ValueError: no ink")
    judgement = judged(run=run)
    assert judgement.problems == ["toy fig-1: drawing failed: ValueError: no ink"]
    assert exhibit(judgement, "fig-1").status == "not-computable"


def test_an_exhibit_that_was_not_run_is_a_problem() -> None:
    run = results()
    del run["toy", "fig-1"]
    judgement = judged(run=run)
    assert judgement.problems == ["toy fig-1: was not computed"]
    assert exhibit(judgement, "fig-1").reason == "was not computed"


def test_a_partial_run_judges_what_was_asked_for() -> None:
    judgement = judge(
        synthetic.paper(),
        {("toy", "table-1"): results()["toy", "table-1"]},
        Inputs(printed()),
        exhibits=["table-1"],
    )
    assert judgement.problems == []
    assert [row.exhibit for row in judgement.exhibits] == ["table-1"]


def test_numbered_exhibits_must_be_in_the_inventory() -> None:
    paper = synthetic.paper()
    paper.numbered += ("table-2",)
    judgement = judge(paper, results(), Inputs(printed()))
    problem = "toy: numbered exhibit 'table-2' is not in the inventory; defined: table-1, fig-1, claims, fig-2"
    assert judgement.problems == judgement.unused == [problem]


def test_explanations_pull_results_of_any_exhibit() -> None:
    text = (
        "{{ row }} {{ column }}: {{ printed('table-1', 'A', 'x') }} for {{ value('table-1', 'A', 'x', 'authors') }}, "
        "{{ count('table-1', 'discrepant') }} so, {{ claim('big').evidence }}"
    )
    found = verdict(judged(entry(explanation=text), ax="1.7"))
    assert found.explanation == "A x: 1.7 for 1, 1 so, The smallest is 3.1."


def test_an_explanation_that_cannot_be_filled_is_a_problem() -> None:
    judgement = judged(entry(explanation="{{ value('table-1', 'A', 'z') }}"), ax="1.7")
    (problem,) = judgement.problems
    assert problem.startswith("toy/ledger.toml:7: value('table-1', 'A', 'z', 'as-written'): ")
    assert verdict(judgement).verdict == "discrepant"
    assert problem in verdict(judgement).explanation


def test_files_are_read_from_the_papers_folder(tmp_path: Path) -> None:
    folder = tmp_path / "toy"
    (folder / "printed").mkdir(parents=True)
    (folder / "printed" / "table-1.csv").write_text("r,x,y\nA,1.7,2.0\nB,3.0,4.0\n", encoding="utf-8")
    (folder / "ledger.toml").write_text(
        '[[entry]]\nexhibit = "table-1"\nrows = ["A"]\ncolumns = ["x"]\ncause = "method"\nexplanation = "Coarse."\n',
        encoding="utf-8",
    )
    paper = synthetic.paper(folder)
    judgement = judge(paper, results(), read_inputs(paper))
    assert judgement.problems == []
    assert verdict(judgement).explanation == "Coarse."


def test_judging_is_pure() -> None:
    run = results(as_written=frame(ax=1.7))
    before = copy.deepcopy(run)
    first, second = (
        judged(entry(rows=("*",)), run=run, bx="9.9"),
        judged(entry(rows=("*",)), run=run, bx="9.9"),
    )
    assert first == second
    for key, result in run.items():
        untouched = before[key]
        if isinstance(result, TableResult) and isinstance(untouched, TableResult):
            for reading, made in untouched.frames.items():
                pd.testing.assert_frame_equal(result.frames[reading], made)
