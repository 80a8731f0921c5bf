"""The loop of the benchmarks, (k + ki/s) e^{-s}/(s + 1), in closed form and by arithmetic of 50 digits.

Nothing here uses the package: what is measured is compared with these values.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import mpmath as mp
import numpy as np
from numpy.polynomial import chebyshev

K, KI, UNTIL = 0.6, 0.5, 60.0  # at the end the error has decayed to rounding
TERMS = 50  # of a power series on one dead time: 1/50! is far below the arithmetic
DEGREE = 20  # of the polynomials that stand for the exact response on one dead time: far below rounding

mp.mp.dps = 50


@cache
def _series() -> list[list[mp.mpf]]:
    """Return the response on each dead time as a power series from its left end, by the method of steps.

    y' = -y + u(t - 1) and I' = 1 - y give each coefficient from the one before; the series are those of entire
    functions.
    """
    y, integral, u = mp.mpf(0), mp.mpf(0), [mp.mpf(0)] * TERMS
    found = []
    for _ in range(int(UNTIL) + 1):
        ys, integrals = [y], [integral]
        for n in range(TERMS - 1):
            ys.append((u[n] - ys[n]) / (n + 1))
            integrals.append(((1 if n == 0 else 0) - ys[n]) / (n + 1))
        found.append(ys)
        u = [K * ((1 if n == 0 else 0) - ys[n]) + KI * integrals[n] for n in range(TERMS)]
        y, integral = mp.fsum(ys), mp.fsum(integrals)
    return found


def response(t: float) -> mp.mpf:
    """Return the step response."""
    piece = int(t)
    return mp.polyval(_series()[piece][::-1], mp.mpf(t) - piece)


@cache
def metrics() -> dict[str, float]:
    """Return the metrics of the response, from polynomials through exact values on each dead time."""
    x = np.cos(np.pi * (np.arange(DEGREE + 1) + 0.5) / (DEGREE + 1))
    series = [
        chebyshev.chebfit(x, [float(response(n + 0.5 * (v + 1.0))) - 1.0 for v in x], DEGREE)
        for n in range(1, int(UNTIL))
    ]
    extrema, crossings, absolute = [], [0.0], 1.0  # the error is one during the dead time
    reached: dict[float, float] = {}
    for n, piece in enumerate(series, start=1):

        def time(at: float, start: int = n) -> float:
            return start + 0.5 * (at + 1.0)

        extrema += [(chebyshev.chebval(v, piece), time(v)) for v in _roots(chebyshev.chebder(piece))]
        for level in (0.02, -0.02):
            crossings += [time(v) for v in _roots(chebyshev.chebsub(piece, [level]))]
        for fraction in (0.1, 0.9):
            at_fraction = _roots(chebyshev.chebsub(piece, [fraction - 1.0]))
            if at_fraction:
                reached.setdefault(fraction, time(at_fraction[0]))
        integral = chebyshev.chebint(piece)
        points = np.array([-1.0, *_roots(piece), 1.0])
        absolute += 0.5 * float(np.sum(np.abs(np.diff(chebyshev.chebval(points, integral)))))
    peak, at = max(extrema)
    return {
        "overshoot": float(peak), "peak_time": at, "settling_time": max(crossings),
        "rise_time": reached[0.9] - reached[0.1], "iae": absolute, **margins(),
    }  # fmt: skip


def _roots(series: np.ndarray) -> list[float]:
    found = chebyshev.chebroots(series)
    return sorted(float(r.real) for r in found if abs(r.imag) < 1e-9 and -1.0 <= r.real <= 1.0)


def margins() -> dict[str, float]:
    """Return Ms, gain margin and phase margin, by Newton's method on the exact transfer function."""

    def loop(w: mp.mpf) -> mp.mpc:
        return _loop(w, K, KI, 0.0)

    def root(f: Callable[[mp.mpf], mp.mpf], near: float) -> mp.mpf:
        return mp.findroot(f, (near, near * 1.001))

    gain_crossover = root(lambda w: abs(loop(w)) - 1, 0.5)
    phase_crossover = root(lambda w: mp.im(loop(w)), 1.5)
    return {
        "ms": sensitivity_peak(K, KI),
        "gain_margin": float(1 / abs(loop(phase_crossover))),
        "rightmost_pole": rightmost_pole(),
        "phase_margin": float(mp.degrees(mp.arg(loop(gain_crossover)) + mp.pi)),
    }


def _loop(w: mp.mpf, k: float, ki: float, kd: float) -> mp.mpc:
    s = mp.mpc(0, w)
    return (mp.mpf(k) + mp.mpf(ki) / s + mp.mpf(kd) * s) * mp.exp(-s) / (s + 1)


def sensitivity_peak(k: float, ki: float, kd: float = 0.0) -> float:
    """Return the largest |S| of a PID controller on the same plant: the highest peak on a grid, polished."""

    def distance(w: mp.mpf) -> mp.mpf:
        return abs(1 + _loop(w, k, ki, kd))

    s = 1j * np.linspace(0.01, 60.0, 20_000)
    nearest = s[np.argmin(np.abs(1.0 + (k + ki / s + kd * s) * np.exp(-s) / (s + 1.0)))].imag
    return float(1 / distance(mp.findroot(lambda w: mp.diff(distance, w), nearest)))


def rightmost_pole() -> float:
    """Return the rightmost zero of s (s + 1) + (k s + ki) e^{-s}, which is real here."""
    return float(mp.findroot(lambda s: s * (s + 1) + (mp.mpf(K) * s + mp.mpf(KI)) * mp.exp(-s), (-0.6, -0.65)))
