"""Gaps between intervals, beside the definition: a point is in a gap where no interval covers it."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from replicate.loops.numerics.gaps import Gaps

ROWS, INTERVALS = 4, 12


@given(st.integers(0, 10**6), st.floats(0.05, 3.0), st.floats(0.0, 0.5))
def test_a_point_is_in_a_gap_exactly_where_no_interval_covers_it(seed: int, width: float, missing: float) -> None:
    random = np.random.default_rng(seed)
    low = random.uniform(-1.0, 4.0, (ROWS, INTERVALS))
    high = low + random.exponential(width, low.shape)
    none = random.uniform(size=low.shape) < missing
    low, high = np.where(none, np.inf, low), np.where(none, -np.inf, high)
    names = np.arange(INTERVALS)
    gaps = Gaps.between([(low[:3], high[:3], names), (low[3:], high[3:], names)], rounding=1e-12)
    for row in range(ROWS):
        found = [gap for point, gap in gaps if point == (row,)]
        assert found == sorted(found)
        for gap in found:
            assert low[row, gap.bound] == gap.top
        for point in random.uniform(0.0, 5.0, 50):
            covered = bool(np.any((low[row] < point) & (point < high[row])))
            bounded = bool(np.any(np.isfinite(low[row]) & (low[row] >= point)))
            assert any(g.bottom < point < g.top for g in found) == (bounded and not covered)
        assert gaps.uppermost[row] == max(0.0, float(high[row].max()))
