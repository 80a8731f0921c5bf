r"""The paper's tuning rules: gain product, specified sensitivity, integral time, and the cubic fitted to it.

Everything is for the plant :math:`K e^{-\theta s}/(Ts - 1)` (1) and depends on :math:`x = \theta/T` alone.
Times are in units of T. The search over the specified sensitivity is decided in rational arithmetic: at
x = 1/2 the condition is a tie, which floating point decides one way or the other.
"""

from __future__ import annotations

import math
from fractions import Fraction
from functools import cache
from typing import Literal

START = Fraction(12, 10)  # "(9) is solved with 1.2 ..."
INCREMENT = Fraction(1, 10)  # "... incremented by 0.1"
LIMIT = 200  # increments; x < 2 needs at most 2/(2 - x) of them, roughly

Branch = Literal["printed", "tangency"]


def gain_product(x: Fraction, exponent: Fraction = Fraction(1, 2)) -> float:
    r"""Return :math:`KK_p = (2T/\theta)^n`; n = 1/2 in Table 1, 2/5 in Table 2."""
    return math.pow(2 / x, exponent)


def real_roots_exist(x: Fraction, specified: Fraction) -> bool:
    r"""Return whether (9) has real roots, that is :math:`q^2 \ge 0`, exactly.

    With :math:`KK_p = \sqrt{2T/\theta}`, :math:`b/T = \sqrt{x/2} - 1`, so that (7) is
    :math:`q^2/T^2 = (1 - \sqrt{x/2})^2 - 1/M^2` with :math:`M = 1/y`. It is not negative if and only if
    :math:`(M - 1)^2 \ge M^2 x/2`, a comparison of rational numbers.
    """
    return (specified - 1) ** 2 >= specified**2 * x / 2


@cache
def specified_sensitivity(x: Fraction) -> Fraction:
    r"""Return :math:`M_s^*`, the first of 1.2, 1.3, ... for which (9) has real roots.

    Raises
    ------
    ValueError
        If x is not between 0 and 2, where no specification can be met.
    """
    for step in range(LIMIT):
        specified = START + step * INCREMENT
        if real_roots_exist(x, specified):
            return specified
    msg = f"theta/T must lie between 0 and 2, not {float(x):g}"
    raise ValueError(msg)


def smallest_sensitivity(x: Fraction) -> float:
    r"""Return :math:`1/(1 - \sqrt{\theta/2T})`, below which no specification can be met."""
    return 1.0 / (1.0 - math.sqrt(x / 2))


def q(x: Fraction, specified: Fraction) -> float:
    """Return |q|/T of (7), exactly zero where the condition is a tie.

    Raises
    ------
    ValueError
        If q is imaginary.
    """
    if not real_roots_exist(x, specified):
        msg = f"q is imaginary for theta/T = {float(x):g} and Ms* = {float(specified):g}"
        raise ValueError(msg)
    if (specified - 1) ** 2 == specified**2 * x / 2:
        return 0.0
    distance = 1.0 - math.sqrt(x / 2)  # -b/T
    y = float(1 / specified)
    return math.sqrt((distance - y) * (distance + y))  # (7)


def equation_9(x: Fraction, specified: Fraction, gain: float, q_signed: complex) -> tuple[complex, complex, float]:
    """Return the coefficients of (9), a quadratic in Ti/T, descending powers."""
    theta = float(x)
    b = gain * theta / 2.0 - 1.0  # (6)
    c_squared = 1.0 - float(1 / specified) ** 2  # (8)
    first = gain**2 + c_squared - 2.0 * gain
    second = -gain * (2.0 * q_signed - 2.0 * b - theta + theta * gain)
    return first, second, gain**2 * theta**2 / 4.0  # (9)


@cache
def integral_time(x: Fraction, branch: Branch = "printed") -> float:
    """Return Ti/T: the larger root of (9) at the first specification that has real roots.

    Parameters
    ----------
    x
        theta/T as a fraction.
    branch
        Sign of q: ``printed`` takes q > 0, as Table 1 does; ``tangency`` takes q < 0, for which the
        repeated root of (5), w^2 = -KKp/(Ti q), is a frequency.
    """
    specified = specified_sensitivity(x)
    sign = 1.0 if branch == "printed" else -1.0
    a, b, c = (z.real for z in equation_9(x, specified, gain_product(x), sign * q(x, specified)))
    return (-b + math.sqrt(b * b - 4.0 * a * c)) / (2.0 * a)


def tangency_frequency(x: Fraction) -> float:
    """Return T times the frequency at which |S| of the design loop touches Ms*; infinite where q = 0."""
    magnitude = q(x, specified_sensitivity(x))
    if magnitude == 0.0:
        return math.inf
    return math.sqrt(gain_product(x) / (integral_time(x, "tangency") * magnitude))


def cubic(x: Fraction | float, coefficients: tuple[float, float, float, float]) -> float:
    """Return Ti/T by (11), for the given coefficients in descending powers."""
    value = 0.0
    for coefficient in coefficients:
        value = value * float(x) + coefficient
    return value
