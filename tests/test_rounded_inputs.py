"""Ranges over printed inputs and joint points, against closed forms and random inputs that round to the print."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import combinations_with_replacement, product
from typing import TypeVar

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from replicate.exhibits import Table
from replicate.exhibits.conventions import Tally, settle, tallies
from replicate.exhibits.joint_point import Target, candidates
from replicate.exhibits.matching import Match, match
from replicate.exhibits.printed import Key, PrintedValue
from replicate.exhibits.quadratic_model import Part, Search, grid_point
from replicate.exhibits.results import TableResult
from replicate.exhibits.rounded_inputs import compute_reading
from replicate.exhibits.rounds import Asking, in_rounds
from replicate.verdicts.inventory import inventory_row
from replicate.verdicts.ledger import Ledger
from replicate.verdicts.tables import TableJudge

Function = Callable[[np.ndarray], np.ndarray]
Ends = tuple[np.ndarray, np.ndarray]
T = TypeVar("T")


def answered(asking: Asking[T], function: Function) -> T:
    """Return the result of a search that is answered point by point."""
    [found] = in_rounds([asking], lambda asked: [np.atleast_1d(function(point)) for _, point in asked])
    return found


def searched(function: Function, middle: list[float], widths: list[float], tolerance: float = 1e-4) -> Search:
    centre, half = np.array(middle), np.array(widths)
    search = Search(centre, half, np.full(len(np.atleast_1d(function(centre))), tolerance))
    answered(search.divide(), function)
    return search


def joint_point(search: Search, target: Target, function: Function) -> np.ndarray:
    points = candidates(search, target)
    answered(search.ask(points), function)
    return target.best(search, points)


def range_of(function: Function, middle: list[float], widths: list[float], tolerance: float = 1e-4) -> Ends:
    search = searched(function, middle, widths, tolerance)
    answered(search.ask(search.extremes()), function)
    return search.ends()


@given(a=st.floats(0.5, 5.0), b=st.floats(0.5, 5.0), places=st.tuples(st.integers(1, 3), st.integers(1, 3)))
@settings(max_examples=40)
def test_monotonic_functions_have_their_extrema_at_corners(a: float, b: float, places: tuple[int, int]) -> None:
    half = [0.5 * 10.0**-place for place in places]
    low, high = range_of(lambda x: np.array([x[0] / x[1], np.sqrt(x[0] * x[1])]), [a, b], half)
    assert low[0] == pytest.approx((a - half[0]) / (b + half[1]), rel=1e-12)
    assert high[0] == pytest.approx((a + half[0]) / (b - half[1]), rel=1e-12)
    assert high[1] == pytest.approx(np.sqrt((a + half[0]) * (b + half[1])), rel=1e-12)


@given(place=st.floats(-0.9, 0.9), size=st.floats(0.01, 0.5))
@settings(max_examples=40)
def test_an_extremum_inside_is_found(place: float, size: float) -> None:
    # cos has its maximum 1 at 0, which is inside the box
    low, high = range_of(lambda x: np.array([np.cos(x[0]) + x[1]]), [-place * size, 0.0], [size, 0.1], 1e-6)
    assert high[0] == pytest.approx(1.1, abs=2e-5)
    assert low[0] == pytest.approx(np.cos(size * (1 + abs(place))) - 0.1, abs=1e-12)


def test_a_model_without_vanishing_derivative_is_settled_by_its_corners() -> None:
    def function(x: np.ndarray) -> np.ndarray:
        return np.array([x[0] + 0.1 * x[0] * x[1], x[0] ** 2 + x[1], x[0] + x[1] - 0.4 * x[1] ** 2])

    search = searched(function, [0.0, 0.0], [1.0, 1.0], 1e-9)
    (part,) = search.parts
    # of the first two functions the derivatives 0.1 x and 2 x vanish inside
    assert part.monotonic.tolist() == [False, False, True]
    answered(search.ask(search.extremes()), function)
    low, high = search.ends()
    assert (low[2], high[2]) == pytest.approx((-2.4, 1.6))
    assert (low[1], high[1]) == pytest.approx((-1.0, 2.0))  # the smallest at x = 0, between the corners


def test_a_jump_is_inside_the_range() -> None:
    # the location of the larger of two peaks jumps where they are equal
    low, high = range_of(lambda x: np.array([1.0 if x[0] > 0.3 else 5.0]), [0.0], [1.0])
    assert (low[0], high[0]) == (1.0, 5.0)


def test_random_inputs_are_never_outside() -> None:
    def function(x: np.ndarray) -> np.ndarray:
        k, ti, td = x
        s = 1j * np.geomspace(0.05, 1.0, 401)
        value = k * (1 + 1 / (ti * s) + td * s) / (s + 1) ** 7
        return np.array([np.max(np.abs(value / (1 + value))), ti / k])

    search = searched(function, [0.982, 3.14, 1.73], [0.0005, 0.005, 0.005])
    answered(search.ask(search.extremes()), function)
    low, high = search.ends()
    assert len(search.points) < 80
    rng = np.random.default_rng(7)
    for point in rng.uniform([0.9815, 3.135, 1.725], [0.9825, 3.145, 1.735], (200, 3)):
        assert (function(point) >= low - 1e-4).all()
        assert (function(point) <= high + 1e-4).all()
    assert high[1] == pytest.approx(3.145 / 0.9815, rel=1e-12)


def test_a_quantity_that_does_not_exist_everywhere_has_no_range() -> None:
    low, high = range_of(lambda x: np.array([np.sqrt(x[0]) if x[0] >= 0 else np.nan, x[0]]), [0.1], [0.2])
    assert np.isnan(low[0])
    assert (low[1], high[1]) == pytest.approx((-0.1, 0.3))


def test_the_joint_point_is_one_for_all() -> None:
    def function(x: np.ndarray) -> np.ndarray:
        return np.array([x[0] + x[1], x[0] - x[1]])

    search = searched(function, [0.0, 0.0], [1.0, 1.0])
    # x + y = 1.5 +- 0.1 and x - y = 0.2 +- 0.1 meet at (0.85, 0.65)
    target = Target(np.array([1.4, 0.1]), np.array([1.6, 0.3]), np.array([False, False]))
    point = joint_point(search, target, function)
    assert point[0] + point[1] == pytest.approx(1.5, abs=0.1)
    assert point[0] - point[1] == pytest.approx(0.2, abs=0.1)


@pytest.mark.parametrize("needed", [0, 1])
def test_what_holds_for_the_printed_inputs_is_not_given_up(needed: int) -> None:
    def function(x: np.ndarray) -> np.ndarray:
        return np.array([x[0], -x[0]])

    search = searched(function, [0.0], [1.0])
    # x in [0.4, 0.6] and -x in [0.4, 0.6] exclude each other
    target = Target(np.array([0.4, 0.4]), np.array([0.6, 0.6]), np.arange(2) == needed)
    point = joint_point(search, target, function)
    assert abs(point[0] - (0.5 if needed == 0 else -0.5)) <= 0.1


TEXTS = {"k": "0.7", "Ti": "2.0", "ki": "0.36", "sum": "2.71", "odd": "9.9"}


def table(cases: str = "rows") -> Table:
    quantities = tuple(TEXTS)
    rows, columns = (("A", "B"), quantities) if cases == "rows" else (quantities, ("A", "B"))
    made = Table("table-1", "table", "T", rows=rows, columns=columns, cases=cases)  # type: ignore[arg-type]

    @made.reading("as-written", "From the printed gains", inputs=("k", "Ti"))
    def _row(case: str, given: Mapping[str, float]) -> dict[str, float]:
        assert case == "A"  # B prints no gains
        return {"ki": given["k"] / given["Ti"], "sum": given["k"] + given["Ti"], "odd": given["k"]}

    return made


def printed(made: Table, **texts: str) -> dict[Key, PrintedValue]:
    found = {made.key("A", quantity): text for quantity, text in (TEXTS | texts).items()}
    return {key: PrintedValue(text, *key) for key, text in found.items()}


def verdicts(made: Table, **texts: str) -> dict[str, str]:
    values = printed(made, **texts)
    frame, ranges = compute_reading(made, made.readings["as-written"], values)
    result = TableResult("toy", made.id, {"as-written": frame}, {}, {"as-written": ranges})
    judge = TableJudge("toy", made, result, values, Ledger())
    judge.judge()
    return {made.quantity(row.row, row.column): row.verdict for row in judge.judgement.verdicts}


@pytest.mark.parametrize("cases", ["rows", "columns"])
def test_a_cell_within_the_rounding_of_its_inputs_is_consistent(cases: str) -> None:
    # 0.7/2.0 = 0.35 is not 0.36, but 0.72/2.0 is; 0.72 + 1.99 = 2.71
    found = verdicts(table(cases))
    assert (found["ki"], found["sum"], found["odd"]) == ("consistent", "consistent", "unexplained")


@pytest.mark.parametrize("cases", ["rows", "columns"])
def test_what_the_first_reading_takes_from_the_print_is_given(cases: str) -> None:
    made = table(cases)
    values = printed(made)
    frame, ranges = compute_reading(made, made.readings["as-written"], values)
    result = TableResult("toy", made.id, {"as-written": frame}, {}, {"as-written": ranges})
    judge = TableJudge("toy", made, result, values, Ledger())
    judge.judge()
    given = {
        made.quantity(row.row, row.column): row for row in judge.judgement.verdicts if row.verdict == "not-computable"
    }
    assert list(given) == ["k", "Ti"]
    assert given["k"].explanation.startswith("Given")
    assert len(judge.judgement.problems) == 1  # the odd one, which has no entry
    row = inventory_row("toy", made, result, judge.judgement.verdicts)
    assert (row.status, row.reason) == ("done", "")


def test_cells_of_one_case_are_consistent_together_or_not_at_all() -> None:
    # k/Ti >= 0.375 leaves k + Ti <= 2.75: either is possible, but not both
    assert verdicts(table(), ki="0.38", sum="2.7")["ki"] == "consistent"
    assert verdicts(table(), ki="0.34", sum="2.79")["sum"] == "consistent"
    both = verdicts(table(), ki="0.38", sum="2.79")
    assert [both["ki"], both["sum"]].count("consistent") == 1


@pytest.mark.parametrize(("ki", "expected"), [("0.34", "consistent"), ("0.32", "unexplained"), ("0.39", "unexplained")])
def test_a_consistent_cell_beyond_its_interval_is_not(ki: str, expected: str) -> None:
    # k/Ti runs from 0.65/2.05 = 0.317 to 0.75/1.95 = 0.385
    assert verdicts(table(), ki=ki, sum="2.7")["ki"] == ("consistent" if ki == "0.32" else expected)


def test_ends_and_point_of_a_range() -> None:
    made = table()
    _, ranges = compute_reading(made, made.readings["as-written"], printed(made))
    assert ranges.lower["A", "ki"] == pytest.approx(0.65 / 2.05, rel=1e-12)
    assert ranges.upper["A", "ki"] == pytest.approx(0.75 / 1.95, rel=1e-12)
    point = ranges.points["A"]
    assert match("0.36", point["k"] / point["Ti"]).kind == "equal"
    assert match("2.71", point["k"] + point["Ti"]).kind == "equal"


def test_an_input_may_stand_in_another_case() -> None:
    made = Table("table-1", "table", "T", rows=("A", "B"), columns=("w", "x"))

    @made.reading("as-written", "W", inputs=("w",), inputs_of={"B": ("w@A",)})
    def _row(_: str, given: Mapping[str, float]) -> dict[str, float]:
        return {"x": 2.0 * sum(given.values())}

    values = {("A", "w"): PrintedValue("1.0", "A", "w"), ("B", "x"): PrintedValue("2.1", "B", "x")}
    frame, ranges = compute_reading(made, made.readings["as-written"], values)
    assert list(frame["x"]) == [2.0, 2.0]
    assert (ranges.lower["B", "x"], ranges.upper["B", "x"]) == pytest.approx((1.9, 2.1))


HOW = {
    "r": Match("equal", "rounded"),
    "t": Match("equal", "truncated"),
    "e": Match("equal", "either"),
    "-": Match("differs"),
}


def settled(x: str, y: str) -> str:
    rows = tuple(map(str, range(max(len(x), len(y)))))
    made = Table("table-1", "table", "T", rows=rows, columns=("x", "y"))
    matches = {(rows[i], name): HOW[how] for name, text in (("x", x), ("y", y)) for i, how in enumerate(text)}
    found = settle(made, matches)
    return "".join(found[rows[i], "x"][0].kind[0] for i in range(len(x)))


@pytest.mark.parametrize(
    ("x", "y", "kinds"),
    [
        ("rrrt", "", "eeen"),  # three round: the fourth is near
        ("tttr", "", "eeen"),  # three truncate
        ("ttr-", "rrr", "nned"),  # no clear majority: the table rounds
        ("t", "ttt", "e"),  # one cell follows its table
        ("rt", "", "en"),  # a tie rounds
        ("eeet", "", "eeen"),  # one cell makes no convention
        ("eett", "", "eeee"),  # two do, where nothing speaks against it
    ],
)
def test_a_column_is_shortened_in_one_way(x: str, y: str, kinds: str) -> None:
    assert settled(x, y) == kinds


def test_cells_that_do_not_hold_are_not_counted() -> None:
    made = Table("table-1", "table", "T", rows=("1", "2", "3"), columns=("x",), cases="rows")
    found = tallies(made, {("1", "x"): HOW["r"], ("2", "x"): HOW["-"], ("3", "x"): HOW["e"]})
    assert found == {"x": Tally(1, 0, 1)}
    assert found["x"].sentence == "2 of 2 round"


@pytest.mark.parametrize(
    ("computed", "kind"),
    [(1.271, "equal"), (1.2, "equal"), (1.1951, "equal"), (1.19, "near"), (1.3, "near")],
)
def test_a_lost_last_digit_leaves_the_others(computed: float, kind: str) -> None:
    assert match("1.2?", computed).kind == kind
    assert PrintedValue("1.2?").lost_digit
    assert tuple(map(float, PrintedValue("1.2?").interval)) == (1.195, 1.295)


@pytest.mark.parametrize("d", [1, 2, 3, 6])
def test_a_model_on_a_grid_is_what_it_is_at_each_of_its_points(d: int) -> None:
    rng = np.random.default_rng(d)
    pairs = list(combinations_with_replacement(range(d), 2))
    part = Part(np.zeros(d), np.ones(d), rng.uniform(-1.0, 1.0, (1 + d + len(pairs), 4)), np.ones(4, dtype=bool))
    axes = [rng.uniform(-1.0, 1.0, int(rng.integers(1, 5))) for _ in range(d)]
    found = part.on_grid(axes, np.array([2, 0]))
    for place, x in enumerate(product(*axes)):
        assert grid_point(axes, place).tolist() == list(x)
        for row, model in zip(found, (2, 0), strict=True):
            constant, *others = part.coefficients[:, model]
            linear = sum(a * xi for a, xi in zip(others[:d], x, strict=True))
            squares = sum(a * x[i] * x[j] for a, (i, j) in zip(others[d:], pairs, strict=True))
            assert row[place] == pytest.approx(constant + linear + squares, rel=1e-12, abs=1e-13)
    assert part.on_grid(axes, np.array([], dtype=int)).shape[0] == 0


@given(seed=st.integers(0, 10**6))
@settings(max_examples=30)
def test_the_joint_point_is_at_least_as_good_as_any_of_a_fine_grid(seed: int) -> None:
    rng = np.random.default_rng(seed)
    rows, bends = rng.uniform(-1.0, 1.0, (2, 3, 2))

    def function(x: np.ndarray) -> np.ndarray:
        return np.asarray(rows @ x + bends @ x**2)

    search = searched(function, [0.0, 0.0], [1.0, 1.0], 1e-9)
    middle, half = rng.uniform(-0.5, 0.5, 3), rng.uniform(0.05, 0.3, 3)
    needed = rng.random(3) < 0.3
    point = joint_point(search, Target(middle - half, middle + half, needed), function)

    def held(x: np.ndarray) -> tuple[int, int]:
        inside = np.abs(function(x) - middle) <= half
        return int((inside & needed).sum()), int(inside.sum())

    side = np.linspace(-1.0, 1.0, 21)  # the search has these among others
    assert held(point) >= max(held(np.array(x)) for x in product(side, side))
