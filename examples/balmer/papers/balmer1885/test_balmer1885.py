"""Tests of the paper's own code, against fractions of whole numbers. Run: pytest papers/balmer1885"""

from fractions import Fraction

import pytest

from balmer1885.lines import as_written

# 36456 times numerator, over ten times denominator, of the coefficients as the note writes them.
EXACT = {"H-alpha": (9, 5), "H-beta": (4, 3), "H-gamma": (25, 21), "H-delta": (9, 8)}


@pytest.mark.parametrize("line", EXACT)
def test_the_formula_in_fractions(line):
    numerator, denominator = EXACT[line]
    exact = Fraction(36456 * numerator, 10 * denominator)
    assert as_written().loc[line, "formula"] == pytest.approx(float(exact), rel=1e-15)
