"""Nothing without a unit depends on units: the same loops in other units of time and gain."""

from __future__ import annotations

from itertools import islice

import numpy as np
import pytest

from loops.equivariance import Case, cases, design_differences, differences
from replicate.loops import PID, Loop, Plant

SAMPLE = list(islice(cases(24), 24))


@pytest.mark.parametrize("case", SAMPLE, ids=range(len(SAMPLE)))
def test_a_loop_in_other_units_is_the_same_loop(case: Case) -> None:
    wrong = {name: value for name, value in differences(case).items() if not value < 1e-10}
    assert not wrong


@pytest.mark.parametrize("case", SAMPLE[:6], ids=range(6))
def test_a_design_in_other_units_is_the_same_design(case: Case) -> None:
    wrong = {name: value for name, value in design_differences(case).items() if not value < 1e-10}
    assert not wrong


@pytest.mark.parametrize("unit", [1e-12, 1e-6, 1e-3, 3.7e5, 1e12])
def test_four_lags_in_any_unit_of_time(unit: float) -> None:
    def step(unit: float) -> np.ndarray:
        den = np.poly([-1.0 / unit] * 4) * unit**4
        controller = PID(0.7, 0.35 / unit, 0.4 * unit, derivative_filter=0.05 * unit)
        return Loop(Plant([1.0], den, 0.3 * unit), controller).step(until=30.0 * unit)(
            unit * np.linspace(0.1, 29.0, 50)
        )

    assert np.max(np.abs(step(unit) - step(1.0))) < 1e-13
