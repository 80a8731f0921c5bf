"""Tests of the paper's own code against closed forms of L = exp(-s)/(2 s). Run: pytest papers/skogestad2003."""

import math

import pytest

from skogestad2003.table_1 import as_written


def test_margins_of_the_first_order_process_in_closed_form():
    computed = as_written()["first-order"]
    phase = math.pi / 2 - 0.5  # |L| = 1 at a frequency of 1/2
    assert computed["GM"] == pytest.approx(math.pi, rel=1e-10)
    assert computed["PM"] == pytest.approx(math.degrees(phase), rel=1e-10)
    assert computed["delay"] == pytest.approx(2 * phase, rel=1e-10)
