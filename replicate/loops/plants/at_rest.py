r"""Value and slope at s = 0 of a function with a branch point there, from where it is not small differences.

Of a function analytic in a disc of radius R cut along the negative real axis, with
:math:`f = c_0 + c_1 s + \dots` and powers of s that are not whole, Cauchy's integral over the rim and both sides of the
cut gives

.. math:: c_m = \frac{1}{\pi} \Big( \int_0^\pi \operatorname{Re} \frac{f(R e^{i\theta})}{R^m e^{im\theta}} \, d\theta
    - (-1)^m \int_0^R \operatorname{Im} f(-x + i0) \, \frac{dx}{x^{m+1}} \Big) .

On the cut the whole powers are real: what is left there is that of the others alone, to full relative precision, down
to the smallest numbers. No difference quotient is that exact, and no extrapolation needs to know the powers.
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial import chebyshev as cheb

from replicate.loops.numerics import chebyshev
from replicate.loops.plants.cut import Function, jump

RADII = (0.3, 0.2, 0.1, 0.03, 0.01, 3e-3)  # of the lowest corner: two in a row must agree
AGREE = 1e-11  # relative difference of two that do,
ROUNDING = 1e-14  # and size, of the largest term of the integrals, that is rounding
LASTS = 1e-12  # rate of decay towards rest that is rounding: the integral over the cut does not converge
NODES = 40  # of the rim, and of each panel of the cut
PANELS = np.append(0.0, 2.0 ** np.arange(10))  # of log(R/x): down to x = R e^-512, 1e-222 R
NEAR = np.array([0.1, 3e-4])  # of a corner: over this range a function comes closer to its value at rest,
FITTED, REACHES, FROM = 10, (0.03, 0.01), 0.1  # points of a fit, its ends in units of a corner, and where it begins
FITS = 1e-9  # relative difference of two that agree
POLE = 100.0  # or grows by more than this factor,
FAR = np.array([1e-100, 1e-200])  # and over this one by any, if it grows like a root or a logarithm


def value_at_rest(function: Function, corner: float) -> float:
    """Return f(0), ``inf`` if f grows without bound towards it, ``nan`` if it cannot be seen.

    Parameters
    ----------
    function
        Analytic within its lowest corner, but for a cut along the negative real axis.
    corner
        The frequency of that corner.
    """
    value = _coefficient(function, 0, corner)
    if np.isnan(value):
        value = _of_roots(function, corner)
    with np.errstate(all="ignore"):
        near, far = function(corner * NEAR.astype(complex)), np.abs(function(corner * FAR.astype(complex)))
    if np.isinf(value):
        return float("inf") if far[1] > far[0] else float("nan")
    if np.isfinite(value) and np.diff(np.abs(near - value))[0] <= ROUNDING * abs(value):
        return value
    return float("inf") if abs(near[1]) > POLE * abs(near[0]) else float("nan")


def slope_at_rest(function: Function, corner: float) -> float:
    """Return f'(0) on the positive real axis, infinite where f falls or grows at once, ``nan`` if it cannot be seen.

    Parameters
    ----------
    function, corner
        As for `value_at_rest`, with a finite value at rest.
    """
    return _coefficient(function, 1, corner)


def _coefficient(function: Function, order: int, corner: float) -> float:
    before = float("nan")
    for radius in RADII:
        found = _from_rim_and_cut(function, order, radius * corner)
        if found == before or np.isinf(found) or abs(found - before) <= AGREE * abs(found):
            return found
        before = found
    return float("nan")


def _of_roots(function: Function, corner: float) -> float:
    """Return f(0) of a polynomial in the square root of s fitted away from rest, where f may lose its digits."""
    roots = FROM + (1.0 - FROM) * 0.5 * (1.0 + cheb.chebpts1(FITTED))
    first, second = (
        float(cheb.Chebyshev.fit(roots, function(reach * corner * roots**2).real, FITTED - 1, domain=(FROM, 1.0))(0.0))
        for reach in REACHES
    )
    return second if abs(first - second) <= FITS * abs(second) else float("nan")


def _from_rim_and_cut(function: Function, order: int, radius: float) -> float:
    points, weights = chebyshev.gauss_legendre(NODES)
    turn = np.exp(0.5j * np.pi * (points + 1.0))
    half = 0.5 * np.diff(PANELS)[:, None]
    depth = PANELS[:-1, None] + half * (points + 1.0)
    with np.errstate(all="ignore"):
        around = (function(radius * turn) / turn**order).real
        inside = (-1.0) ** order * jump(function, radius * np.exp(-depth)) * np.exp(order * depth)
        rim, cut, rest = 0.5 * np.pi * float(weights @ around), float(np.sum(inside @ weights * half[:, 0])), 0.0
        first, last = inside[-1, [0, -1]]
        if last:  # what lies behind the last panel falls like one exponential, if it does
            rate = np.log(first / last) / (depth[-1, -1] - depth[-1, 0])
            if rate <= LASTS:
                return float(np.copysign(np.inf, -last))
            rest = float(last / rate * np.exp(rate * (depth[-1, -1] - PANELS[-1])))
    total = rim - cut - rest
    return total / (np.pi * radius**order) if abs(total) > ROUNDING * np.max(np.abs(around)) else 0.0
