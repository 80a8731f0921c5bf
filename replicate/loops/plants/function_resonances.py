r"""Resonances of a function: its poles and zeros close to the imaginary axis, however narrow.

Nothing is known of the function but its values. Along the axis it is compared, half way between neighbouring
frequencies, with the cubic through four of them in log w; where the two differ, the interval is halved. A resonance is
a place where the intervals shrink; from there Newton's method leads to the pole, a zero of 1/f, or to the zero.
A resonance that moves f by less than `DEVIATES` of its value between the first frequencies is not seen.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Function = Callable[[ComplexArray], ComplexArray]

PER_DECADE = 160
DEVIATES = 1e-6  # of a value from the cubic through its neighbours, relative to the largest of them
DEEPEST = 36  # halvings of an interval: a relative width of 1e-13
MOST = 3000  # intervals that are halved at once: more are no resonances but waves, or noise
MOST_RESONANCES = 60
SHRUNK = 3  # halvings from which on an interval is one of a resonance
FITTED = 5  # neighbours on each side that the fit around such an interval uses
ENOUGH = 6  # values that the fit needs
STEPS = 30
EPS = 4.0 * float(np.finfo(float).eps)
ARRIVED = 1e-9  # last relative step of Newton's method
NEARLY = 1e-3  # and of one that the rounding errors of the function have stopped
NARROWER, LEAST = 0.3, 1e-3  # spacing of a difference: of the step, and of the spacing before at least
NARROW = 0.3  # largest |Re s|/|s| of a resonance
SAME = 1e-6  # relative distance of points that are one


def resonances(f: Function, low: float, high: float) -> ComplexArray:
    """Return the poles, Im > 0, that are close to the imaginary axis between two frequencies.

    Parameters
    ----------
    f
        The function, for complex arrays.
    low, high
        The ends of the band.
    """
    starts, spacing = _starts(f, low, high)
    with np.errstate(all="ignore"):
        poles = _newton(lambda s: 1.0 / f(s), starts, spacing)
    found: list[complex] = []
    for point in poles.tolist():
        inside = 0.5 * low < point.imag < 2.0 * high and abs(point.real) < NARROW * abs(point)
        if inside and all(abs(point - other) > SAME * abs(point) for other in found):
            found.append(point)
    return np.array(sorted(found, key=lambda s: s.imag), dtype=complex)


def _starts(f: Function, low: float, high: float) -> tuple[ComplexArray, Array]:
    """Return where poles may be, and the lengths, in w, of the shortest intervals there."""
    x = np.linspace(np.log(low), np.log(high), max(8, int(PER_DECADE * np.log10(high / low))))
    values = f(1j * np.exp(x))
    first = x[1] - x[0]
    active = np.ones(x.size - 1, dtype=bool)
    for _ in range(DEEPEST):
        left = np.nonzero(active)[0]
        around = np.clip(left - 1, 0, x.size - 4)[:, None] + np.arange(4)
        middle = 0.5 * (x[left] + x[left + 1])
        there = f(1j * np.exp(middle))
        with np.errstate(all="ignore"):
            guess = np.sum(_lagrange(x[around], middle) * values[around], axis=1)
            wrong = ~(np.abs(there - guess) <= DEVIATES * np.max(np.abs(values[around]), axis=1))
        wrong &= np.isfinite(there)
        if not wrong.any():
            break
        if np.count_nonzero(wrong) > MOST:
            return np.empty(0, dtype=complex), np.empty(0)
        left, middle, there = left[wrong], middle[wrong], there[wrong]
        x, values = np.insert(x, left + 1, middle), np.insert(values, left + 1, there)
        active = np.zeros(x.size - 1, dtype=bool)
        halves = left + np.arange(left.size)
        active[halves] = active[halves + 1] = True
    spacing = np.diff(x)
    depth = np.round(np.log2(first / spacing)).astype(int)
    begin = np.concatenate([[0], np.nonzero(np.diff(depth))[0] + 1])  # of intervals of one length
    level = depth[begin]
    padded = np.pad(level, 1, constant_values=0)
    narrowest = (level > padded[:-2]) & (level > padded[2:]) & (level >= SHRUNK)
    core = ((begin + np.append(begin[1:], depth.size)) // 2)[narrowest]
    core = core[np.argsort(spacing[core])][:MOST_RESONANCES]
    starts, lengths = [np.empty(0, dtype=complex)], [np.empty(0)]
    for left in core.tolist():
        near = np.arange(max(0, left - FITTED), min(x.size, left + 2 + FITTED))
        length = np.exp(x[left]) * spacing[left]
        found = 1j * np.exp(x[left]) + length * _poles_of_fit(
            (np.exp(x[near]) - np.exp(x[left])) * 1j / length, values[near]
        )
        starts.append(found)
        lengths.append(np.full(found.size, length))
    return np.concatenate(starts), np.concatenate(lengths)


def _poles_of_fit(z: ComplexArray, values: ComplexArray) -> ComplexArray:
    """Return the poles of the rational function of second degree that fits some values."""
    usual = np.isfinite(values) & (values != 0.0)
    z, values = z[usual], values[usual]
    if z.size < ENOUGH:
        return np.empty(0, dtype=complex)
    z = z / (size := float(np.max(np.abs(z))))
    powers = z[:, None] ** np.arange(2, -1, -1)
    _, _, basis = np.linalg.svd(np.hstack([powers, -values[:, None] / np.max(np.abs(values)) * powers]))
    return np.asarray(np.roots(basis[-1, 3:].conj()) * size, dtype=complex)


def _lagrange(nodes: Array, x: Array) -> Array:
    """Return the weights of the cubic through four nodes at one point each, shape (n, 4)."""
    weights = np.ones(nodes.shape)
    for i in range(4):
        for j in range(4):
            if j != i:
                weights[:, i] *= (x - nodes[:, j]) / (nodes[:, i] - nodes[:, j])
    return weights


def _newton(f: Function, starts: ComplexArray, spacing: Array) -> ComplexArray:
    """Return the zeros to which Newton's method leads; slopes are differences."""
    s = starts.copy()
    h = 0.5 * spacing
    step = np.full(s.shape, np.inf, dtype=complex)
    for _ in range(STEPS):
        moving = np.isfinite(s) & ~(np.abs(step) <= ARRIVED * np.abs(s.real) + EPS * np.abs(s))
        if not moving.any():
            break
        point, reach = s[moving], h[moving]
        ahead, behind, here = f(point + reach), f(point - reach), f(point)
        change = 2.0 * reach * here / (ahead - behind)
        step[moving] = change
        s[moving] = point - change
        h[moving] = np.minimum(reach, np.maximum(NARROWER * np.abs(change), LEAST * reach))
    return np.asarray(s[np.isfinite(s) & (np.abs(step) <= NEARLY * np.abs(s))])
