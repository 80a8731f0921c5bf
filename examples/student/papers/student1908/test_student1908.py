"""Tests of the paper's own code, against arithmetic in whole tenths of an hour. Run: pytest papers/student1908"""

from fractions import Fraction

import pytest

from student1908.illustration_1 import as_written, n_minus_1

# Laevo minus dextro in tenths of an hour, subtracted by hand.
TENTHS = (12, 24, 13, 13, 0, 10, 18, 8, 46, 14)


@pytest.mark.parametrize(("reading", "divisor"), [(as_written, 10), (n_minus_1, 9)])
def test_mean_and_deviation_of_the_differences_in_whole_numbers(reading, divisor):
    total = sum(TENTHS)
    squares = sum(Fraction(10 * tenth - total, 10) ** 2 for tenth in TENTHS)
    computed = reading()["difference"]
    assert computed["mean"] == pytest.approx(total / 100, rel=1e-14)
    assert computed["sd"] ** 2 == pytest.approx(float(squares / divisor / 100), rel=1e-13)
