"""The rightmost pole that is guessed and proven: beside Lambert's W, and where there must be no proof."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.special import lambertw

from replicate.loops import PI, PID, Loop, Plant
from replicate.loops.closed_loop_poles.proven_pole import proven_pole_with_others
from replicate.loops.frequency_domain.loop_transfer import LoopTransfer

RANDOM = np.random.default_rng(1960)


@pytest.mark.parametrize(("k", "ratio"), RANDOM.uniform((0.01, 0.05), (3.0, 20.0), (40, 2)).tolist())
def test_the_rightmost_pole_of_a_lag_under_proportional_control_is_a_value_of_lamberts_w(
    k: float, ratio: float
) -> None:
    # s + 1/T + (k/T) e^{-sL} = 0 with L = 1: z e^z = -(k/T) e^{1/T} for z = s + 1/T; the principal branch is rightmost
    lag = 1.0 / ratio
    exact = complex(lambertw(-k * ratio * np.exp(ratio))) - ratio
    found = proven_pole_with_others(LoopTransfer.of(Plant.foptd(1.0, lag, 1.0), PI(k)))
    assert found is not None
    assert found[0] == pytest.approx(complex(exact.real, abs(exact.imag)), rel=1e-11)


@pytest.mark.parametrize(
    "loop",
    [
        Loop(Plant.foptd(1.0, 1.0, 1.0), PI(1.0 / math.e, 1.0 / math.e)),  # a double pole
        Loop(Plant([1.0], [1.0, 0.0], 1.0), PI(1.0 / math.e * (1.0 - 1e-6))),  # two that are about to meet
        Loop(Plant([1.0], [1.0], 1.0), PI(0.6)),  # infinitely many poles with one real part
        Loop(Plant([1.0], [1.0, 0.0], 0.0), PI(0.6)),  # no dead time
        Loop(Plant.foptd(1.0, 1.0, 1.0) + Plant.foptd(1.0, 2.0, 0.3), PI(0.1)),  # two dead times
        Loop(Plant.foptd(1.0, 1.0, 1.0), PI(0.0)),  # no feedback
    ],
    ids=str,
)
def test_what_cannot_be_proven_is_left_to_the_search(loop: Loop) -> None:
    assert proven_pole_with_others(loop._transfer) is None
    assert np.isfinite(loop.rightmost_pole())


def test_a_neutral_loop_with_poles_near_its_asymptote_is_left_to_the_search() -> None:
    # |L| tends to kd/T = 0.9: poles crowd at Re s = ln 0.9, to the right of all others
    loop = Loop(Plant.foptd(1.0, 1.0, 1.0), PID(0.1, 0.3, 0.9))
    found = proven_pole_with_others(loop._transfer)
    assert found is None or found[0].real > np.log(0.9) - 1e-9
