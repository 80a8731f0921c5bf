"""The peak of |S| wherever it falls between the bands in which it is searched."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from replicate.loops import PI, Loop, Plant

# The peak lies in the last interval of one band, or just before the first grid point of the next.
GAINS = [
    (0.565441012084144, 0.44003360363731403),
    (0.7921160265031207, 0.9929935457096606),
    (0.5856268509511058, 0.6855622855437802),
]


@pytest.mark.parametrize(("k", "ki"), GAINS)
def test_a_peak_next_to_the_end_of_a_band_is_found(k: float, ki: float) -> None:
    def modulus(w: NDArray[np.float64]) -> NDArray[np.float64]:
        s = 1j * w
        return np.asarray(np.abs(1.0 / (1.0 + (k + ki / s) * np.exp(-0.5 * s) / (1.0 + s))))

    w = np.linspace(0.01, 10.0, 100_001)
    at = int(np.argmax(modulus(w)))
    found = minimize_scalar(
        lambda x: -float(modulus(np.array(x))),
        bounds=(w[at - 1], w[at + 1]),
        method="bounded",
        options={"xatol": 1e-12},
    )
    peak = Loop(Plant([1.0], [1.0, 1.0], dead_time=0.5), PI(k=k, ki=ki)).sensitivity_peak()
    assert peak.value == pytest.approx(-found.fun, rel=1e-12)
    assert peak.frequency == pytest.approx(found.x, rel=1e-6)
