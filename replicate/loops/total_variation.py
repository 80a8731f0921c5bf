"""How much a signal moves: the sum of all its ups and downs, jumps included."""

from __future__ import annotations

import numpy as np
from numpy.polynomial import chebyshev as cheb

from replicate.loops import chebyshev
from replicate.loops.piecewise import Piecewise


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
    jumps = abs(starts[0]) + float(np.sum(np.abs(starts[1:] - ends[:-1])))
    slopes = np.asarray(cheb.chebder(coefficients, axis=1), dtype=float)
    # sum |c_k| bounds the rest of a slope: where the mean slope exceeds it, the piece is monotone
    monotone = np.abs(slopes[:, 0]) > np.sum(np.abs(slopes[:, 1:]), axis=1)
    moved = float(np.sum(np.abs(ends - starts)[monotone]))
    for piece in np.nonzero(~monotone)[0]:
        points = np.concatenate([[-1.0], chebyshev.real_roots(slopes[piece]), [1.0]])
        moved += float(np.sum(np.abs(np.diff(cheb.chebval(points, coefficients[piece])))))
    return float(jumps + moved)
