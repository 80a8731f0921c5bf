"""How well few modes describe a step response: the comparisons that section 8 makes in words."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from replicate.exhibits.extrema import largest
from replicate.papers.krajewski.normalised_loop import loop
from replicate.papers.krajewski.points import TAU, response

Array = NDArray[np.float64]

UNTIL = 12.0  # the time axis of the figures


def modes(a: float, b: float, count: int) -> list[tuple[complex, complex]]:
    """Return (pole, residue) of the modes of the step response, the poles closest to the imaginary axis first.

    The response's transform is N/(sD) with N = (a + bs)exp(-τs) and D = s(1 + s) + N, so its residue at a
    zero p of D is N/(pD'): zero for a pole that a zero of the controller cancels. Of a complex pair the pole
    with the positive imaginary part stands for both, with twice its residue.

    Parameters
    ----------
    count
        How many poles, a complex pair counting as two; one more is taken where that would split a pair.
    """
    found: list[tuple[complex, complex]] = []
    for p in loop(a, b, TAU).poles(count + 2):
        if sum(2 if pole.imag else 1 for pole, _ in found) >= count:
            break
        exponential = np.exp(-TAU * p)
        slope = 1.0 + 2.0 * p + (b - TAU * (a + b * p)) * exponential
        residue = (a + b * p) * exponential / (p * slope)
        found.append((complex(p), complex(2.0 * residue if p.imag else residue)))
    return found


def three_mode_error(a: float, b: float, start: float) -> float:
    """Return the largest error of the three slowest modes from ``start`` to the end of the figures' time axis."""
    found, exact = modes(a, b, 3), response(a, b)

    def error(t: Array) -> Array:
        modal = 1.0 + sum((residue * np.exp(pole * t)).real for pole, residue in found)
        return np.asarray(np.abs(modal - exact(t)))

    t = np.linspace(start, UNTIL, 2001)
    return largest(lambda x: float(error(np.array([x]))[0]), t, error(t))[1]


@cache
def second_order_error(a: float, b: float) -> float:
    """Return the largest error of the best second-order response with a zero, after the dead time.

    With t' = t - τ the model is 1 - exp(-σt')(cos ωt' + c sin ωt'/ω), ω² of either sign, fitted by least squares to the
    figures' time axis; c enters linearly and is solved for. The characteristic polynomial is s² + 2σs + σ² + ω², whose
    modes decay where both coefficients are positive: their logarithms are free.
    """
    t = np.linspace(0.0, UNTIL - TAU, 1201)
    exact = response(a, b)
    error = 1.0 - exact(t + TAU)

    def parts(logarithms: Array, t: Array) -> tuple[Array, Array]:
        double, constant = np.exp(logarithms)
        sigma, square = 0.5 * double, constant - 0.25 * double**2
        if square < 0.0:
            rate = np.sqrt(-square)
            slow, fast = np.exp((rate - sigma) * t), np.exp(-(rate + sigma) * t)
            return 0.5 * (slow + fast), 0.5 * (slow - fast) / rate
        omega, decay = np.sqrt(square), np.exp(-sigma * t)
        return decay * np.cos(omega * t), decay * t * np.sinc(omega * t / np.pi)

    def solved(logarithms: Array) -> tuple[float, Array]:
        cosine, sine = parts(logarithms, t)
        c = float(sine @ (error - cosine) / (sine @ sine))
        return c, np.asarray(error - cosine - c * sine)

    def residual(logarithms: Array) -> Array:
        return solved(logarithms)[1]

    starts = [(0.3, -0.05), (0.7, 0.2), (0.7, 2.0), (1.0, 6.0)]  # σ and ω²
    fits = [
        least_squares(
            residual, np.log([2.0 * sigma, sigma**2 + square]), "3-point", method="lm",
            ftol=1e-15, xtol=1e-12, gtol=1e-15,
        )
        for sigma, square in starts
    ]  # fmt: skip
    best = min(fits, key=lambda fit: float(fit.cost))
    c, fitted = solved(best.x)

    def remaining(x: float) -> float:
        cosine, sine = parts(best.x, np.array([x]))
        return abs(1.0 - float(exact(x + TAU)) - float(cosine[0]) - c * float(sine[0]))

    return largest(remaining, t, np.abs(fitted))[1]
