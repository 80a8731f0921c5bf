r"""One smooth formula for the overshoot of the loop of Figure 2, for every gain and every ph.

The first peak has a closed form F(ph, Kh) for Kh >= e^{-ph} (`replicate.papers.khan.closed_form`). Below that, F
turns negative where the true overshoot goes smoothly to zero. A soft ramp of width w mends this and is invisible
where F is large compared with w:

.. math:: M = w \ln(1 + e^{F/w}), \qquad w = a\,e^{-b\,ph} (x e^{-x})^n, \qquad x = Kh\,e^{ph}.

The scaled gain x is 1/e at the breakpoint and 1 where the closed form begins to hold, for every ph.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from replicate.papers.khan.closed_form import first_peak

Array = NDArray[np.float64]

NARROWEST = 1e-12  # per cent: w underflows for large x, where M and F are the same number


def smooth_overshoot(ph: ArrayLike, kh: ArrayLike, coefficients: tuple[float, float, float]) -> Array:
    """Return the estimate M in per cent.

    Parameters
    ----------
    ph, kh
        Normalised dead time, 0 to 10, and gain.
    coefficients
        a (per cent), b and n.
    """
    ph, kh = np.asarray(ph, dtype=float), np.asarray(kh, dtype=float)
    a, b, n = coefficients
    log_x = np.log(kh) + ph
    with np.errstate(under="ignore", over="ignore"):
        width = np.maximum(a * np.exp(-b * ph + n * (log_x - np.exp(log_x))), NARROWEST)
    return np.asarray(width * np.logaddexp(0.0, first_peak(ph, kh) / width))
