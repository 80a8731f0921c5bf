r"""What the fits (2) and (3) approximate, in closed form.

Until the feedback of the first rise arrives, and for one dead time after that, the response of the loop is
elementary. With h = 1, P = ph, k = Kh:

* On 1 <= t <= 2 it is :math:`(k/P)(1 - e^{-P(t-1)})`. Where 90 % of the final value k/(k + P) is reached there,
  :math:`t_r = \frac{1}{P} \ln\frac{k + 0.9P}{k + 0.1P}`.
* On 2 <= t <= 3 its slope is :math:`e^{-P(t-2)} (k e^{-P} - k^2 (t-2))`, so that for :math:`k \ge e^{-P}` the first
  peak is at :math:`t = 2 + e^{-P}/k` and, with :math:`z = P e^{-P}/k`,

  .. math:: \frac{y_{max}}{y_{ss}} - 1 = (k+P)\left[\frac{1-e^{-P}}{P} + \frac{e^{-2P}}{k}\,\varphi(z)\right] - 1,
            \qquad \varphi(z) = \frac{z - 1 + e^{-z}}{z^2}.

For smaller gains the time of the first peak still depends on :math:`x = k e^{P}` alone, and at x = 1/e, the paper's
breakpoint, it goes to infinity.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


def first_peak(ph: ArrayLike, kh: ArrayLike) -> Array:
    """Return the overshoot of the first peak in per cent: exact for Kh >= e^{-ph}, its continuation below."""
    P, k = np.asarray(ph, dtype=float), np.asarray(kh, dtype=float)
    share = _phi(P * np.exp(-P) / k)
    return np.asarray(100.0 * ((k + P) * (_mean_decay(P) + np.exp(-2.0 * P) / k * share) - 1.0))


def has_first_peak(ph: ArrayLike, kh: ArrayLike) -> NDArray[np.bool_]:
    """Return where `first_peak` is exact."""
    return np.asarray(np.asarray(kh, dtype=float) >= np.exp(-np.asarray(ph, dtype=float)))


def rise_time(ph: ArrayLike, kh: ArrayLike) -> Array:
    """Return t_r/h: exact where `has_rise_time`."""
    P, k = np.asarray(ph, dtype=float), np.asarray(kh, dtype=float)
    ratio = 0.8 / (k + 0.1 * P)  # (k + 0.9 P)/(k + 0.1 P) = 1 + P ratio
    safe = np.where(P > 0.0, P, 1.0)
    return np.asarray(np.where(P > 0.0, np.log1p(P * ratio) / safe, ratio))


def has_rise_time(ph: ArrayLike, kh: ArrayLike) -> NDArray[np.bool_]:
    """Return where 90 % is reached before the feedback arrives: everywhere for ph >= ln 10."""
    P, k = np.asarray(ph, dtype=float), np.asarray(kh, dtype=float)
    return np.asarray((k + P) * _mean_decay(P) >= 0.9)


def _mean_decay(P: Array) -> Array:
    """Return (1 - e^-P)/P."""
    safe = np.where(P > 0.0, P, 1.0)
    return np.asarray(np.where(P > 0.0, -np.expm1(-safe) / safe, 1.0))


def _phi(z: Array) -> Array:
    """Return (z - 1 + e^-z)/z^2; the series where the difference would cancel."""
    series = 0.5 - z / 6.0 + z**2 / 24.0 - z**3 / 120.0 + z**4 / 720.0 - z**5 / 5040.0 + z**6 / 40320.0
    safe = np.where(z > 0.05, z, 1.0)
    return np.asarray(np.where(z > 0.05, (safe + np.expm1(-safe)) / safe**2, series))
