"""Loci of constant maximum sensitivity Ms in the (a, b) plane, for any dead time. Not in the paper.

On a ray through the origin only the loop's gain changes: (a, b) = λ (a₁, b₁), with (a₁, b₁) on the stability
boundary. The locus is the level set of 1/Ms = min |1 + λ G₁(jω)| over rays and gains λ: contoured on a grid, then
every point is moved onto the level by Newton steps along the gradient. Nothing is assumed about its shape: for
small τ, and a much larger than b, a loop can become less sensitive as its gain rises, and the locus has corners.

Frequencies above the phase crossover do not count: there |λ G₁| < λ < 1 and |1 + λ G₁| > 1 - λ, its value at the
crossover.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from replicate.papers.krajewski.loci import Locus
from replicate.papers.krajewski.normalised_loop import end_frequency, frequency_response, point

Array = NDArray[np.float64]

RAYS, GAINS, FREQUENCIES = 301, 321, 400
LEAST_GAIN = 1e-4  # of the gain on the stability boundary
LOWEST = 1e-4  # frequency, as a fraction of the phase crossover
NEWTON_STEPS, LONGEST_STEP = 5, 0.02
ZOOMS = 7  # passes in which the interval around the best frequency shrinks by twenty
JUMP = 0.5  # of the logarithm of the peak's frequency between neighbours, taken for a corner between two peaks


def _phase_crossover(tau: float, u: Array) -> Array:
    """Map u in [0, 1] to rays by their phase crossover, denser towards the ends, where the locus turns."""
    return np.asarray(end_frequency(tau) * 0.5 * (1.0 - np.cos(np.pi * u)))


def _least_distance(tau: float, u: Array, log_gain: Array) -> tuple[Array, Array, Array]:
    """Return min |1 + G(jω)| = 1/Ms, its derivative by log λ, and the frequency, for points of shape (n,)."""
    wb = _phase_crossover(tau, u)
    a, b = (x * np.exp(log_gain) for x in point(tau, wb))
    w = wb[:, None] * np.geomspace(LOWEST, 1.0, FREQUENCIES)
    rows = np.arange(wb.size)
    least = at = np.empty(0)
    for _ in range(ZOOMS + 1):
        value = np.abs(1.0 + frequency_response(a[:, None], b[:, None], tau, w))
        column = np.argmin(value, axis=1)
        least, at = value[rows, column], w[rows, column]
        low, high = w[rows, np.maximum(column - 1, 0)], w[rows, np.minimum(column + 1, w.shape[1] - 1)]
        w = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, 41)
    response = frequency_response(a, b, tau, at)
    # The frequency of the minimum moves with λ, too, but that does not count to first order.
    return least, np.real(np.conj(1.0 + response) * response) / least, at


def _contours(tau: float, ms: float) -> list[Array]:
    """Return the level curves on the grid of rays and gains, as columns u and log λ."""
    from contourpy import contour_generator

    u = np.linspace(0.0, 1.0, RAYS)[1:]
    log_gain = np.linspace(np.log(LEAST_GAIN), 0.0, GAINS)
    wb = _phase_crossover(tau, u)
    a, b = (x[:, None] for x in point(tau, wb))
    response = frequency_response(a, b, tau, wb[:, None] * np.geomspace(LOWEST, 1.0, FREQUENCIES))
    square, double = np.abs(response) ** 2, 2.0 * response.real
    levels = [np.sqrt(np.min(1.0 + g * double + g * g * square, axis=1)) for g in np.exp(log_gain)]
    lines = contour_generator(u, log_gain, np.array(levels)).lines(1.0 / ms)
    found = [np.asarray(line, dtype=float) for line in lines]
    return [line if line[0, 0] <= line[-1, 0] else line[::-1] for line in found]


def _onto_level(tau: float, ms: float, line: Array) -> tuple[Array, Array]:
    """Move a contour onto the level; return its points (a, b) and the frequencies of their peaks."""
    u, log_gain = line.T.copy()
    h = 1e-6
    for _ in range(NEWTON_STEPS):
        value, by_gain, _ = _least_distance(tau, u, log_gain)
        # Across u = 1, the b axis, everything is symmetric, so the difference is right at the end, too.
        by_ray = (_least_distance(tau, u + h, log_gain)[0] - _least_distance(tau, u - h, log_gain)[0]) / (2.0 * h)
        slope = np.hypot(by_gain, by_ray)
        step = np.clip((value - 1.0 / ms) / slope, -LONGEST_STEP, LONGEST_STEP)
        u = np.clip(u - step * by_ray / slope, 2.0 * h, 1.0)
        log_gain = log_gain - step * by_gain / slope
    peaks = _least_distance(tau, u, log_gain)[2]
    points = np.exp(log_gain)[:, None] * np.column_stack(point(tau, _phase_crossover(tau, u)))
    return points, peaks


def sensitivity_points(tau: float, ms: float) -> list[Array]:
    """Return points with maximum sensitivity ``ms``, shape (n, 2): one array for each smooth piece of the locus.

    The first piece begins on the lower, the last one ends on the upper b axis.

    Raises
    ------
    ValueError
        If ``ms`` is not greater than 1.
    """
    if not ms > 1.0:
        msg = f"the maximum sensitivity must be greater than 1, not {ms:g}"
        raise ValueError(msg)
    pieces = []
    for line in _contours(tau, ms):
        points, peaks = _onto_level(tau, ms, line)
        corners = np.flatnonzero(np.abs(np.diff(np.log(peaks))) > JUMP) + 1
        pieces += [piece for piece in np.split(points, corners) if len(piece) > 3]
    # With a = 0, -1 < b < 0 the response is nearest to -1 at ω = 0, where it is b.
    pieces[0] = np.vstack([[[0.0, -(1.0 - 1.0 / ms)]], pieces[0]])
    return pieces


def constant_sensitivity(tau: float, ms: float) -> list[Locus]:
    """Return the smooth pieces of the locus of a maximum sensitivity, as cubic splines through exact points."""
    return [_spline(points) for points in sensitivity_points(tau, ms)]


def _spline(points: Array) -> Locus:
    from scipy.interpolate import CubicSpline

    length = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    spline = CubicSpline(length / length[-1], points)
    slope = spline.derivative()
    return Locus(lambda u: (np.asarray(spline(u)), np.asarray(slope(u))))
