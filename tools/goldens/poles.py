"""Closed-loop poles of f = A + B e^{-sL} to all digits, with multiplicities, and a proof that none is missing.

Every zero satisfies sL = log(-B(s)/A(s)) + 2 pi i k for some integer k, which is a contraction far from the origin;
near it Newton's method starts from a grid. The list is complete to the right of a line because the argument principle
counts as many zeros there.
"""

from __future__ import annotations

from dataclasses import dataclass

import mpmath as mp
import numpy as np
from case import Case, derivative, evaluate
from loops.references import zeros_right_of

BRANCHES = 34


@dataclass(frozen=True)
class Pole:
    """A pole with Im >= 0 and its multiplicity."""

    value: mp.mpc
    multiplicity: int

    @property
    def count(self) -> int:
        """How many zeros of f it stands for, conjugates included."""
        return self.multiplicity * (2 if self.value.imag else 1)


def poles(case: Case) -> list[Pole]:
    """Return the rightmost poles, descending real part, complete to the right of the last one."""
    f, slope = functions(case)
    found: list[mp.mpc] = []
    for start in _starts(case):
        root = _polished(f, slope, mp.mpc(start))
        if root is not None and all(abs(root - other) > 1e-12 * (abs(root) + abs(other)) for other in found):
            found.append(root)
    found.sort(key=lambda p: (-p.real, p.imag))
    listed = [Pole(p, _multiplicity(f, p, found)) for p in found]
    if not case.dead_time:
        return listed
    return _complete(case, listed)


def functions(case: Case):
    """Return f and its derivative, for mpmath numbers."""
    A, B = case.polynomials["A"], case.polynomials["B"]
    dA, dB, delay = derivative(A), derivative(B), mp.mpf(case.dead_time)

    def f(s: mp.mpc) -> mp.mpc:
        return evaluate(A, s) + evaluate(B, s) * mp.exp(-s * delay)

    def slope(s: mp.mpc) -> mp.mpc:
        return evaluate(dA, s) + (evaluate(dB, s) - delay * evaluate(B, s)) * mp.exp(-s * delay)

    return f, slope


def _starts(case: Case) -> list[complex]:
    A, B = ([float(c) for c in case.polynomials[name]] for name in "AB")
    starts = [complex(r) for r in (*np.roots(A), *np.roots(np.polyadd(A, B))) if r.imag >= 0.0]
    starts = [s * (1 + 1e-3j) + 1e-12 for s in starts]
    if not case.dead_time:
        return starts
    delay = case.dead_time
    for turn in range(BRANCHES):
        s = (-1.0 + 2j * np.pi * (turn + 0.5)) / delay
        for _ in range(60):
            with np.errstate(all="ignore"):
                s = (np.log(-np.polyval(B, s) / np.polyval(A, s)) + 2j * np.pi * turn) / delay
        starts.append(complex(s))
    size = np.geomspace(0.03, 12.0, 14) / delay
    angle = np.linspace(0.02, 3.1, 12)
    starts += [complex(r * np.exp(1j * a)) for r in size for a in angle]
    return [s for s in starts if np.isfinite(s)]


def _polished(f, slope, s: mp.mpc) -> mp.mpc | None:
    """Newton's method on f/f', which converges quadratically at multiple zeros, too."""
    for step in range(60):
        value, d = f(s), slope(s)
        if value == 0:
            break
        if d == 0:
            return None
        h = abs(s) * mp.mpf(10) ** -18 + mp.mpf(10) ** -40
        curvature = (slope(s + h) - slope(s - h)) / (2 * h)
        simple = value / d
        change = simple / (1 - value * curvature / d**2) if value * curvature != d**2 else simple
        limit = abs(s) / 2 + mp.mpf(10) ** -30
        change = change if abs(change) < limit else change / abs(change) * limit
        s -= change
        if abs(change) < mp.mpf(10) ** -22 * abs(s) and step > 3:
            break
    else:
        return None
    s = mp.mpc(s.real, abs(s.imag))
    real = abs(s.imag) < mp.mpf(10) ** -15 * abs(s)
    return mp.mpc(s.real, 0) if real else s


def _multiplicity(f, pole: mp.mpc, others: list[mp.mpc]) -> int:
    """Count the turns of f on a small circle."""
    nearest = min([abs(pole - other) for other in others if other != pole] + [abs(pole)])
    if pole.imag:
        nearest = min(nearest, 2 * pole.imag)
    points = [f(pole + nearest / 100 * mp.expjpi(2 * mp.mpf(j) / 48)) for j in range(48)]
    turns = mp.fsum(mp.arg(b / a) for a, b in zip(points, [*points[1:], points[0]], strict=True))
    return round(float(turns / (2 * mp.pi)))


def _complete(case: Case, listed: list[Pole]) -> list[Pole]:
    delay = case.dead_time
    A, B = ([float(c) for c in case.polynomials[name]] for name in "AB")
    degree = len(A) - 1

    def scaled(z: np.ndarray) -> np.ndarray:  # f with the dead time as unit of time, and free of large factors
        s = z / delay
        return (np.polyval(A, s) + np.polyval(B, s) * np.exp(-z)) / (1.0 + np.abs(s)) ** degree

    for count in range(len(listed) - 1, 0, -1):
        right, left = listed[count - 1].value.real * delay, listed[count].value.real * delay
        if right - left < 1e-9 * abs(left):
            continue
        line = float(right + left) / 2
        radius = 2.0 * np.pi * BRANCHES + abs(line)
        try:
            expected = zeros_right_of(scaled, line, radius)
        except ArithmeticError:
            continue
        if expected == sum(pole.count for pole in listed[:count]):
            return listed[:count]
    msg = f"{case.id}: the list of poles cannot be proven complete"
    raise ArithmeticError(msg)
