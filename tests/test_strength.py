"""The strength of a match, against counting by brute force and on tables of random numbers."""

from __future__ import annotations

import math
from itertools import product
from math import prod

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from replicate.exhibits import AS_WRITTEN, Notation, Table
from replicate.exhibits.printed import Key, PrintedValue
from replicate.exhibits.results import TableResult
from replicate.verdicts.ledger import Ledger
from replicate.verdicts.matches import reading_matches
from replicate.verdicts.strength import LEVEL, PARTS, Strength, as_many_digits, choices_of, strengths
from replicate.verdicts.tables import TableJudge

ROWS, COLUMNS = tuple("ABCDEFGH"), ("x", "y", "z")


@given(parts=st.lists(st.tuples(st.integers(0, 4 * PARTS), st.booleans()), min_size=1, max_size=8))
def test_the_digits_of_accidents_against_all_outcomes(parts: list[tuple[int, bool]]) -> None:
    goal = sum(part for part, met in parts if met)
    odds = [10.0 ** (-part / PARTS) for part, _ in parts]
    expected = sum(
        prod(p if happens else 1.0 - p for p, happens in zip(odds, outcome, strict=True))
        for outcome in product((False, True), repeat=len(parts))
        if sum(part for (part, _), happens in zip(parts, outcome, strict=True) if happens) >= goal
    )
    found = as_many_digits([part / PARTS for part, met in parts if met], [part / PARTS for part, _ in parts])
    assert found == pytest.approx(expected, rel=1e-9, abs=1e-15)


def test_a_long_number_explains_more_than_a_short_one() -> None:
    table = Table("table-1", "table", "T", rows=("A", "B"), columns=("x",))
    printed = {("A", "x"): PrintedValue("6.9684", "A", "x"), ("B", "x"): PrintedValue("6.9", "B", "x")}
    for id in (AS_WRITTEN, "long", "short"):
        table.reading(id, "R")(lambda: None)
    off = {(row, "x"): 7.9 for row in "AB"}
    given_: dict[str, dict[Key, float | str | None]] = {
        AS_WRITTEN: dict(off),
        "long": {**off, ("A", "x"): 6.9684, ("B", "x"): 8.0},
        "short": {**off, ("A", "x"): 8.0, ("B", "x"): 6.9},
    }
    found = strengths(table, {id: reading_matches(table, id, printed, cells) for id, cells in given_.items()})
    assert (found["long"].met, found["short"].met) == (1, 1)
    assert found["long"].digits > found["short"].digits + 2.9
    assert found["long"].strong
    assert not found["short"].strong


@pytest.mark.parametrize(
    ("notation", "text", "digits"),
    [
        (Notation(interval="ends"), "[6.96, 8.10]", 2 * 2.0),  # each end one of some hundred numbers
        (Notation(uncertainty=True), "6.96 ± 1.10", 2 * 2.0),
        (Notation(words=("yes", "no")), "yes", math.log10(2)),
    ],
)
def test_a_pair_explains_the_digits_of_both_its_numbers_and_a_word_next_to_nothing(
    notation: Notation, text: str, digits: float
) -> None:
    table = Table("table-1", "table", "T", rows=("A",), columns=("x",), notation=notation)
    printed = {("A", "x"): PrintedValue(text, "A", "x", notation=notation)}
    for id in (AS_WRITTEN, "other"):
        table.reading(id, "R")(lambda: None)
    right, off = {
        "interval": ("6.9604 8.1002", "5.9604 9.1002"),
        "number": ("6.9604 1.1002", "5.9604 0.6"),
        "word": ("yes", "no"),
    }[printed["A", "x"].statement.kind]
    given_: dict[str, dict[Key, float | str | None]] = {AS_WRITTEN: {("A", "x"): off}, "other": {("A", "x"): right}}
    found = strengths(table, {id: reading_matches(table, id, printed, cells) for id, cells in given_.items()})
    assert (found[AS_WRITTEN].met, found["other"].met) == (0, 1)
    assert found["other"].digits == pytest.approx(digits, abs=0.7)
    assert found["other"].strong == (digits > 1.0)


def judged(prints: np.ndarray, readings: list[np.ndarray], tried: int = 1) -> dict[str, Strength]:
    table = Table("table-1", "table", "T", rows=ROWS, columns=COLUMNS)
    printed = {}
    for (i, row), (j, column) in product(enumerate(ROWS), enumerate(COLUMNS)):
        printed[row, column] = PrintedValue(f"{prints[i, j]:.2f}", row, column)
    computed = {}
    for place, numbers in enumerate(readings):
        id = AS_WRITTEN if place == 0 else f"reading-{place}"
        table.reading(id, "R", tried={"formula": tried} if place else None)(lambda: None)
        cells: dict[Key, float | str | None] = {
            (row, column): float(numbers[i, j])
            for (i, row), (j, column) in product(enumerate(ROWS), enumerate(COLUMNS))
        }
        computed[id] = reading_matches(table, id, printed, cells)
    return strengths(table, computed)


def random_table(rng: np.random.Generator) -> np.ndarray:
    return rng.uniform(1.0, 9.0, (len(ROWS), len(COLUMNS)))


@pytest.mark.parametrize("spread", [0.003, 0.03, 0.3])
@pytest.mark.parametrize("count", [2, 6])
def test_random_readings_are_chance(spread: float, count: int) -> None:
    """Numbers scattered around the print meet some of it; only about one best reading in a hundred looks strong."""
    rng = np.random.default_rng(17)
    strong = 0
    for _ in range(200):
        prints = random_table(rng)
        readings = [prints * (1.0 + spread * rng.uniform(-1.0, 1.0, prints.shape)) for _ in range(count + 1)]
        found = judged(prints, readings)
        strong += any(one.strong for id, one in found.items() if id != AS_WRITTEN)
    assert strong <= 200 * LEVEL * 3  # three times what is promised, for two hundred tables


def test_the_truth_is_strong_and_its_neighbours_are_not() -> None:
    rng = np.random.default_rng(3)
    truth = random_table(rng)
    off = [truth * (1.0 + 0.02 * rng.uniform(-1.0, 1.0, truth.shape)) for _ in range(3)]
    found = judged(truth, [off[0], truth, *off[1:]])
    assert found["reading-1"].met == len(ROWS) * len(COLUMNS)
    assert found["reading-1"].strong
    assert not found["reading-2"].strong
    assert found["reading-1"].digits > 10.0


def test_alternatives_that_were_tried_weaken_a_match() -> None:
    rng = np.random.default_rng(5)
    truth = random_table(rng)
    wrong = truth + 0.2
    few = truth + 0.2
    few[:2, 0] = truth[:2, 0]
    once, often = (judged(truth, [wrong, few], tried)["reading-1"] for tried in (1, 1000))
    assert once.chance < often.chance
    assert often.choices == 1000
    assert often.chance == pytest.approx(1.0 - (1.0 - once.chance) ** 1000, rel=1e-9)


def test_what_the_text_leaves_open_counts_for_the_first_reading_too() -> None:
    rng = np.random.default_rng(5)
    truth = random_table(rng)
    table = Table("table-1", "table", "T", rows=ROWS, columns=COLUMNS)
    table.reading(AS_WRITTEN, "R", tried={"definition": 5, "band": 6})(lambda: None)
    table.reading("other", "R", tried={"definition": 5})(lambda: None)
    assert [choices_of(table, id) for id in table.readings] == [30, 5]
    assert judged(truth, [truth])[AS_WRITTEN].choices == 1


def test_a_quantity_whose_neighbours_fail_is_not_explained() -> None:
    rng = np.random.default_rng(5)
    truth = random_table(rng)
    other = truth + 0.3
    reading = truth.copy()
    reading[1:, 1] += 0.3 + 1e-6  # of y it meets one value only
    found = judged(truth, [other, reading])["reading-1"]
    assert found.strong
    assert found.holds_for("x")
    assert not found.holds_for("y")


def test_a_reading_is_judged_by_what_it_says_differently() -> None:
    rng = np.random.default_rng(5)
    truth = random_table(rng)
    reading = truth.copy()
    reading[0, 0] += 0.5
    found = judged(truth, [truth, reading])
    assert (found["reading-1"].compared, found["reading-1"].met) == (1, 0)
    assert found["reading-1"].chance == 1.0
    assert found[AS_WRITTEN].met == len(ROWS) * len(COLUMNS)


def test_a_reading_that_gives_the_same_number_is_no_rival() -> None:
    """Where all readings agree on a value, its distance from zero says how much meeting it tells."""
    rng = np.random.default_rng(23)
    truth = random_table(rng)
    alone, agreed = judged(truth, [truth]), judged(truth, [truth, truth, truth])
    assert agreed[AS_WRITTEN].digits == pytest.approx(alone[AS_WRITTEN].digits)
    assert agreed[AS_WRITTEN].strong


def test_a_value_is_not_reconstructed_by_the_lesser_of_two_readings() -> None:
    rng = np.random.default_rng(29)
    truth = random_table(rng)
    first, lesser = truth.copy(), truth.copy()
    first[0, 0] += 0.1  # the one value that only the lesser reading meets
    lesser[1:4, 0] += 0.1
    table = Table("table-1", "table", "T", rows=ROWS, columns=COLUMNS)
    readings = {AS_WRITTEN: truth + 1.0, "first": first, "lesser": lesser}
    cells = [(row, column) for row in ROWS for column in COLUMNS]
    printed = {key: PrintedValue(f"{truth.flat[i]:.2f}", *key) for i, key in enumerate(cells)}
    frames = {}
    for id, numbers in readings.items():
        table.reading(id, "R")(lambda: None)
        frames[id] = pd.DataFrame(numbers, index=list(ROWS), columns=list(COLUMNS))
    judge = TableJudge("toy", table, TableResult("toy", table.id, frames, {}), printed, Ledger())
    judge.judge()
    found = {(row.row, row.column): (row.verdict, row.reading) for row in judge.judgement.verdicts}
    assert found.pop(("A", "x"))[0] != "reconstructed"
    assert set(found.values()) == {("reconstructed", "first")}
