"""Searches side by side find what each of them finds alone, answered point by point."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from replicate.errors import PaperDefinitionError
from replicate.exhibits import Table
from replicate.exhibits.printed import Key, PrintedValue
from replicate.exhibits.results import Ranges
from replicate.exhibits.rounded_inputs import compute_reading
from replicate.exhibits.rounds import Asking, Sampled, in_rounds

Numbers = Mapping[str, float]
Point = tuple[str, Numbers]
CASES = ("A", "B", "C", "D")
INPUTS = tuple(f"x{i}" for i in range(7))
QUANTITIES = ("smooth", "bent", "jump", "hole")


class Functions:
    """For each case some functions of one to seven inputs: smooth, of a jump, of nothing beyond an edge."""

    def __init__(self, seed: int) -> None:
        rng = np.random.default_rng(seed)
        # more than six are searched in another way
        sizes = [1 + seed % 6, 7, *rng.integers(1, 4, 2)]
        self.inputs = {case: INPUTS[:size] for case, size in zip(CASES, sizes, strict=True)}
        self.weights = {case: rng.uniform(-2.0, 2.0, (4, len(own))) for case, own in self.inputs.items()}
        self.texts = {case: [f"{x:.1f}" for x in rng.uniform(-3.0, 3.0, len(own))] for case, own in self.inputs.items()}
        self.asked: list[int] = []

    def __call__(self, case: str, given: Numbers) -> dict[str, float]:
        x, middle = np.array(list(given.values())), np.array([float(text) for text in self.texts[case]])
        one, two, three, four = self.weights[case] @ (x - middle)
        if four > 0.03:
            message = "nothing there"
            raise ValueError(message)
        hole = math.nan if three > 0.01 else 1.0 + one
        return {"smooth": math.exp(one), "bent": one + 40.0 * two * two, "jump": 1.0 + float(two > 0.004), "hole": hole}

    def many(self, points: Sequence[Point]) -> list[dict[str, float] | None]:
        self.asked.append(len(points))
        found: list[dict[str, float] | None] = []
        for case, numbers in points:
            try:
                found.append(self(case, numbers))
            except ValueError:
                found.append(None)
        return found

    def ranges(self, cases: Sequence[str], *, many: bool) -> Ranges:
        table = Table("table-1", "table", "T", rows=tuple(cases), columns=(*INPUTS, *QUANTITIES))
        table.reading(
            "as-written", "T", inputs_of={case: self.inputs[case] for case in cases}, many=self.many if many else None
        )(self)
        values: dict[Key, PrintedValue] = {}
        for case in cases:
            texts = dict(zip(self.inputs[case], self.texts[case], strict=True)) | {"smooth": "1.02", "bent": "0.01"}
            values |= {(case, name): PrintedValue(text, case, name) for name, text in texts.items()}
        return compute_reading(table, table.readings["as-written"], values)[1]


def same(one: Mapping[Key, float], other: Mapping[Key, float]) -> bool:
    return one.keys() == other.keys() and all(
        a == other[key] or (math.isnan(a) and math.isnan(other[key])) for key, a in one.items()
    )


@given(seed=st.integers(0, 10**6))
@settings(max_examples=18, deadline=None)
def test_all_cases_together_find_what_each_finds_alone(seed: int) -> None:
    functions = Functions(seed)
    together = functions.ranges(CASES, many=True)
    for case in CASES:
        alone = functions.ranges([case], many=False)
        keys = [key for key in together.lower if key[0] == case]
        for name in ("lower", "upper", "joint"):
            own: Mapping[Key, float] = getattr(together, name)
            assert same({key: own[key] for key in keys}, getattr(alone, name)), name
        assert together.points[case] == alone.points[case]


@given(seed=st.integers(0, 10**6))
@settings(max_examples=12, deadline=None)
def test_both_ends_are_taken_and_the_smooth_function_is_nowhere_beyond_them(seed: int) -> None:
    functions = Functions(seed)
    functions.weights = {case: rows * [[1.0], [1.0], [1.0], [0.0]] for case, rows in functions.weights.items()}
    found = functions.ranges(CASES, many=True)
    for case in CASES:
        # exp of a sum is monotonic in each input, which runs 0.05 to either side
        reach = 0.05 * np.abs(functions.weights[case][0]).sum()
        assert found.lower[case, "smooth"] == pytest.approx(math.exp(-reach), rel=1e-9)
        assert found.upper[case, "smooth"] == pytest.approx(math.exp(reach), rel=1e-9)


def test_the_points_of_all_cases_are_asked_for_in_few_rounds() -> None:
    functions = Functions(3)
    functions.weights = {case: 0.001 * rows for case, rows in functions.weights.items()}
    functions.ranges(CASES, many=True)
    # the middle, the sides and the corners of all boxes; then where each case is best
    assert len(functions.asked) <= 3
    assert functions.asked[0] >= sum(1 + 2 * len(own) for own in functions.inputs.values())


def test_a_point_is_asked_for_once() -> None:
    known = Sampled(np.zeros(2), np.array([0.5, 0.0]))
    asked: list[float] = []

    def search() -> Asking[np.ndarray]:
        points = [np.array([x, 0.0]) for x in (0.5, 0.1, 0.5)]
        first = yield from known.ask(points)
        second = yield from known.ask([*points, np.array([0.2, 0.0])])
        return np.concatenate([first, second])

    def answer(points: list[tuple[int, np.ndarray]]) -> list[np.ndarray]:
        asked.extend(float(point[0]) for _, point in points)
        return [10.0 * point[:1] for _, point in points]

    [found] = in_rounds([search()], answer)
    assert asked == [0.5, 0.1, 0.2]
    assert found.ravel().tolist() == [5.0, 1.0, 5.0, 5.0, 1.0, 5.0, 2.0]
    assert known.at(np.array([0.1, 0.0])).tolist() == [1.0]


@pytest.mark.parametrize("size", [0, 1])
def test_as_many_answers_as_questions(size: int) -> None:
    table = Table("table-1", "table", "T", rows=("A",), columns=("x", "y"))
    answers: Callable[[Sequence[Point]], list[dict[str, float]]] = lambda _: [{"y": 1.0}] * size  # noqa: E731
    table.reading("as-written", "T", inputs=("x",), many=answers)(lambda _, given: {"y": given["x"]})
    with pytest.raises(ValueError, match=f"returns {size} results for 5 cases at once; expected: as many"):
        compute_reading(table, table.readings["as-written"], {("A", "x"): PrintedValue("1.0", "A", "x")})


def test_what_computes_many_is_a_function() -> None:
    table = Table("table-1", "table", "T", rows=("A",), columns=("x", "y"))
    with pytest.raises(PaperDefinitionError, match="what computes many cases at once"):
        table.reading("as-written", "T", inputs=("x",), many=3)(lambda _, given: {"y": given["x"]})  # type: ignore[arg-type]
