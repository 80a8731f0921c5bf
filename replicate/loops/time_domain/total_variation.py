"""How much a signal moves: the sum of all its ups and downs, jumps included."""

from __future__ import annotations

import numpy as np
from numpy.polynomial import chebyshev as cheb

from replicate.loops.time_domain.piecewise import Piecewise
from replicate.loops.time_domain.sign_changes import ups_and_downs


def total_variation(signal: Piecewise) -> float:
    r"""Return :math:`\int |\dot u|\, dt` over [0, horizon], jumps with their height; the signal is zero before t = 0.

    Between stationary points a polynomial is monotone, so that the variation is a sum of differences of its values
    there; nothing is sampled. For the control signal it measures the wear of an actuator.

    References
    ----------
    S. Skogestad, "Simple analytic rules for model reduction and PID controller tuning", J. Process Control 13 (2003)
    291, where the measure is used.
    """
    coefficients = signal.coefficients
    signs = (-1.0) ** np.arange(coefficients.shape[1])
    starts, ends = coefficients @ signs, coefficients.sum(axis=1)
    jumps = abs(float(starts[0])) + float(np.sum(np.abs(starts[1:] - ends[:-1])))
    return jumps + ups_and_downs(np.asarray(cheb.chebder(coefficients, axis=1), dtype=float), coefficients)
