"""Inputs from other tables and from the text, many of them, and proofs that none of them gives the print."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from replicate.display.tables import table_view
from replicate.exhibits import Paper, Table
from replicate.exhibits.exclusion import Box, Ends, excluded
from replicate.exhibits.joint_point import Target
from replicate.exhibits.many_inputs import ManyInputs
from replicate.exhibits.printed import Key, PrintedValue
from replicate.exhibits.results import TableResult
from replicate.exhibits.rounded_inputs import compute_reading
from replicate.exhibits.rounds import Asking, in_rounds
from replicate.run.stored_ranges import ranges_from_data, ranges_to_data
from replicate.run.units import Unit, compute
from replicate.verdicts.ledger import Ledger
from replicate.verdicts.rows import VerdictRow
from replicate.verdicts.tables import TableJudge


def explored(
    function: Callable[[np.ndarray], np.ndarray], many: ManyInputs, target: Target | None = None
) -> np.ndarray:
    """Explore a box and return the joint point, answering point by point; without a target the centre."""

    def search() -> Asking[np.ndarray]:
        yield from many.explore()
        return (yield from many.joint_point(target)) if target else many.centre

    [point] = in_rounds([search()], lambda asked: [function(point) for _, point in asked])
    return point


@given(weights=st.lists(st.floats(-3.0, 3.0), min_size=7, max_size=20))
def test_the_range_of_a_sum_is_the_sum_of_the_ranges(weights: list[float]) -> None:
    a = np.array(weights)
    found = ManyInputs(np.ones(a.size), np.full(a.size, 0.1))
    explored(lambda x: np.array([a @ x, -2.0 * a @ x]), found)
    low, high = found.ends()
    reach = 0.1 * np.abs(a).sum()
    assert (low[0], high[0]) == pytest.approx((a.sum() - reach, a.sum() + reach))
    assert (low[1], high[1]) == pytest.approx((-2 * (a.sum() + reach), -2 * (a.sum() - reach)))


@given(seed=st.integers(0, 10**6))
def test_monotonic_functions_have_their_extremes_at_two_corners(seed: int) -> None:
    rng = np.random.default_rng(seed)
    signs = rng.choice([-1.0, 1.0], 9)
    found = ManyInputs(np.zeros(9), np.full(9, 0.2))
    explored(lambda x: np.array([np.exp(signs @ x / 3.0)]), found)
    assert [float(end[0]) for end in found.ends()] == pytest.approx([math.exp(-0.6), math.exp(0.6)])


def test_the_joint_point_of_many_inputs_serves_all_that_can_hold_together() -> None:
    # three sums of ten inputs; the third contradicts the first
    rows = np.zeros((3, 10))
    rows[0, :5], rows[1, 5:], rows[2, :5] = 1.0, 1.0, -1.0
    target = Target(np.array([0.4, 0.3, 0.4]), np.array([0.45, 0.35, 0.45]), np.array([True, False, False]))
    point = explored(lambda x: rows @ x, ManyInputs(np.zeros(10), np.full(10, 0.1)), target)
    first, second, third = rows @ point
    assert 0.4 <= first <= 0.45
    assert 0.3 <= second <= 0.35
    assert third < 0.0


def sum_misses(_: str, box: Box, ends: Ends) -> bool:
    low, high = (sum(side[end] for side in box.values()) for end in (0, 1))
    return high < ends[0] or low > ends[1]


def product_misses(_: str, box: Box, ends: Ends) -> bool:
    low, high = (math.prod(side[end] for side in box.values()) for end in (0, 1))
    return high < ends[0] or low > ends[1]


def made(rules: bool = True) -> Table:
    table = Table("table-1", "table", "T", rows=("A",), columns=("k", "m", "sum", "product"))
    rules_out = {"sum": sum_misses, "product": product_misses} if rules else {}

    @table.reading("as-written", "From the printed inputs", inputs=("k", "m"), rules_out=rules_out)
    def _row(_: str, given: Mapping[str, float]) -> dict[str, float]:
        return {"sum": given["k"] + given["m"], "product": given["k"] * given["m"]}

    return table


def judgement(table: Table, total: str, product: str) -> tuple[TableResult, list[VerdictRow]]:
    texts = {"k": "2.0", "m": "3.0", "sum": total, "product": product}
    values: dict[Key, PrintedValue] = {("A", name): PrintedValue(text, "A", name) for name, text in texts.items()}
    frame, ranges = compute_reading(table, table.readings["as-written"], values)
    assert ranges_from_data(ranges_to_data(ranges)) == ranges
    result = TableResult("toy", table.id, {"as-written": frame}, {}, {"as-written": ranges})
    judge = TableJudge("toy", table, result, values, Ledger())
    judge.judge()
    return result, judge.judgement.verdicts


def judged(table: Table, total: str, product: str) -> dict[str, tuple[str, str]]:
    _, rows = judgement(table, total, product)
    found = {one.column: one for verdict in rows for one in verdict.ranges}
    verdicts = {verdict.column: verdict.verdict for verdict in rows}
    return {column: (verdicts[column], one.certainty) for column, one in found.items()}


def test_a_value_beyond_its_range_is_proven_to_be() -> None:
    # k in [1.95, 2.05], m in [2.95, 3.05]: the sum is from 4.9 to 5.1
    found = judged(made(), "5.2", "6.0")
    assert found["sum"] == ("near", "proof")
    assert found["product"] == ("reproduced", "witness")


def test_values_that_are_possible_but_not_together_are_proven_to_be() -> None:
    # a sum of 4.905 to 4.915 leaves products from 1.95 * 2.955 = 5.76 to 1.965 * 2.95 = 5.80; 6.2 needs a larger sum
    assert judged(made(), "4.91", "5.77")["product"] == ("consistent", "witness")
    found = judged(made(), "4.91", "6.2")
    assert sorted(found.values()) == [("consistent", "witness"), ("near", "joint-proof")]


def test_a_search_says_whether_the_print_is_out_of_reach_alone_or_only_with_the_others() -> None:
    assert judged(made(rules=False), "5.2", "6.0")["sum"] == ("near", "search")
    found = judged(made(rules=False), "4.91", "6.2")
    assert sorted(found.values()) == [("consistent", "witness"), ("near", "joint-search")]


def test_card_and_note_say_what_the_inputs_leave_open_and_how_certain_that_is() -> None:
    table = made()
    view = table_view(table, *judgement(table, "5.9", "6.0"))
    _given, note = view.notes
    assert note.ranges == {"none of which gives the print, by proof": [("A", "sum", "4.9 to 5.1")]}
    values = {cell.column: cell.values[0] for _, cells in view.rows for cell in cells if cell.printed}
    assert values["sum"].certainty == "none of which gives the print, by proof"
    assert (values["product"].range, values["product"].certainty) == ("5.752 to 6.252", "")
    assert [name for name, _ in values["product"].point] == ["k", "m"]


def test_without_a_rule_it_is_only_searched() -> None:
    assert judged(made(rules=False), "5.2", "6.0")["sum"] == ("near", "search")


def test_what_some_inputs_give_is_never_excluded() -> None:
    box = {"k": (1.95, 2.05), "m": (2.95, 3.05)}
    rules = {"sum": sum_misses, "product": product_misses}
    rng = np.random.default_rng(3)
    for k, m in rng.uniform([1.95, 2.95], [2.05, 3.05], (40, 2)):
        ends = {"sum": (k + m - 1e-3, k + m + 1e-3), "product": (k * m - 1e-3, k * m + 1e-3)}
        assert not excluded(rules, "A", box, ends)
        assert not excluded(rules, "A", box, ends, {"k": k, "m": m})


def test_where_the_closest_point_stays_open_only_the_box_and_the_smallest_part_are_asked() -> None:
    asked = []

    def never_out(_case: str, box: Box, _ends: Ends) -> bool:
        asked.append(box)
        return False

    box, closest = {"k": (1.95, 2.05), "m": (2.95, 3.05)}, {"k": 2.04, "m": 2.96}
    assert not excluded({"sum": never_out}, "A", box, {"sum": (4.9, 5.0)}, closest)
    whole, part = asked
    assert whole == box
    assert all(low <= closest[name] <= high for name, (low, high) in part.items())
    assert {round((high - low) / 0.1, 9) for low, high in part.values()} == {2.0**-4}


def test_inputs_of_another_table_and_of_the_text() -> None:
    from replicate.papers.khan import paper

    assert isinstance(paper, Paper)
    result = compute(Unit("khan", "replicate.papers.khan", "example-2-1", "printed-coefficients"))
    assert isinstance(result, TableResult)
    ranges = result.ranges["printed-coefficients"]
    # C2 = 0.17204 - 0.005396 ph + 1.0779 e^(-0.45261 ph) with ph = 1.82 p, p = 1.6667, by hand: extremes at corners
    ends = [
        a + b * ph + c * math.exp(d * ph)
        for a in (0.172035, 0.172045)
        for b in (-0.0053965, -0.0053955)
        for c in (1.07785, 1.07795)
        for d in (-0.452615, -0.452605)
        for ph in (1.66665 * 1.82, 1.66675 * 1.82)
    ]
    assert ranges.lower["C2", "value"] == pytest.approx(min(ends), rel=1e-12)
    assert ranges.upper["C2", "value"] == pytest.approx(max(ends), rel=1e-12)
    assert 0.428785 <= ranges.joint["C2", "value"] <= 0.428795
    assert 3.5486225 <= ranges.joint["D2", "value"] <= 3.5486235
    assert ranges.upper["A2", "value"] < 0.3031


@pytest.mark.parametrize(
    ("place", "reason"),
    [
        ("nowhere:a:value", "there is no table 'nowhere' with printed numbers"),
        ("bryant:zeta1.0:Ki", "row 'zeta1.0', column 'Ki' of bryant is not printed"),
    ],
)
def test_an_input_that_is_printed_nowhere_is_named(place: str, reason: str, monkeypatch: pytest.MonkeyPatch) -> None:
    from dataclasses import replace

    from replicate.papers.khan import paper

    table = paper.load().exhibits["example-2-1"]
    assert isinstance(table, Table)
    reading = replace(table.readings["printed-coefficients"], inputs=(place,))
    monkeypatch.setitem(table.readings, "printed-coefficients", reading)
    result = compute(Unit("khan", "replicate.papers.khan", "example-2-1", "printed-coefficients"))
    assert isinstance(result, TableResult)
    assert reason in result.errors["printed-coefficients"]
