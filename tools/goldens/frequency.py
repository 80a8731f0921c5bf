"""Peaks and margins of a stable loop: located on a dense grid, then to all digits as roots."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mpmath as mp
import numpy as np
from case import Case, bracketed_root, evaluate

Number = mp.mpf | None  # None: infinite, or there is none

CLEAR = 0.02  # |L| at a phase crossover that may be the margin in any case
NEXT = 8  # of the phase crossovers with smaller |L|, how many are looked at


def quantities(case: Case) -> dict[str, dict[str, Number]]:
    """Return the peaks of |S| and |T| and the margins, with their frequencies."""
    A, B = case.polynomials["A"], case.polynomials["B"]
    delay = mp.mpf(case.dead_time)

    def L(w: Any) -> Any:
        if isinstance(w, np.ndarray):
            s = 1j * w
            return np.polyval(_floats(B), s) / np.polyval(_floats(A), s) * np.exp(-s * case.dead_time)
        s = mp.mpc(0, w)
        return evaluate(B, s) / evaluate(A, s) * mp.exp(-s * delay)

    grid = _grid(case)
    return {
        "sensitivity_peak": _peak(lambda w: 1 / (1 + L(w)), grid, _limit(case)),
        "complementary_peak": _peak(lambda w: L(w) / (1 + L(w)), grid, feedthrough(case) * _limit(case)),
        **_margins(case, L, grid),
    }


def _floats(poly: list[mp.mpf]) -> list[float]:
    return [float(c) for c in poly]


def feedthrough(case: Case) -> mp.mpf:
    """Return |L| at infinite frequency."""
    A, B = case.polynomials["A"], case.polynomials["B"]
    return abs(B[0] / A[0]) if len(A) == len(B) else mp.mpf(0)


def _limit(case: Case) -> mp.mpf:
    """Return sup |S| for w to infinity: the phase of a dead time takes all values."""
    direct = feedthrough(case)
    if not case.dead_time:
        return 1 / (1 + direct)
    return 1 / (1 - direct)


def _grid(case: Case) -> np.ndarray:
    A, B = (_floats(case.polynomials[name]) for name in "AB")
    # the roots of A + B, the poles without dead time, are about where the gain passes one
    corners = np.abs(np.concatenate([np.roots(A), np.roots(B), np.roots(np.polyadd(A, B))]))
    corners = np.concatenate([corners[corners > 0.0], [1.0 / case.dead_time] if case.dead_time else []])
    low, high = 1e-4 * corners.min(), 1e3 * corners.max()
    parts = [np.geomspace(low, high, 60001)]
    if case.dead_time:
        w = np.geomspace(low, high, 4001)
        large = w[np.abs(np.polyval(B, 1j * w) / np.polyval(A, 1j * w)) > 0.15]
        end = min(max(large.max(initial=0.0), 60.0 / case.dead_time), 1e4 / case.dead_time)
        parts.append(np.arange(1, int(end * case.dead_time / 0.01)) * 0.01 / case.dead_time)
    resonances = [r for r in (*np.roots(A), *np.roots(np.polyadd(A, B))) if r.imag > 0.0]
    parts += [r.imag + abs(r.real) * np.linspace(-20.0, 20.0, 2001) for r in resonances]
    w = np.unique(np.concatenate(parts))
    return w[w > 0.0]


def _peak(function: Callable[[Any], Any], grid: np.ndarray, limit: Number) -> dict[str, Number]:
    size = np.abs(function(grid))
    inner = np.nonzero((size[1:-1] >= size[:-2]) & (size[1:-1] >= size[2:]))[0] + 1
    best = max(inner, key=lambda i: size[i], default=None)
    ends = [(abs(function(mp.mpf(float(grid[0])) / 10**40)), mp.mpf(0))] + ([(limit, None)] if limit else [])
    candidates = list(ends)
    if best is not None and size[best] > (1 + 1e-12) * float(max(value for value, _ in ends)):  # not mere rounding
        w = _top(lambda x: mp.diff(lambda v: mp.log(abs(function(v))), x), grid, best)
        candidates.append((abs(function(w)), w))
    value, at = max(candidates, key=lambda pair: pair[0])
    return {"value": value, "frequency": at}


def _top(slope: Callable[[mp.mpf], mp.mpf], grid: np.ndarray, best: int) -> mp.mpf:
    """Return the zero of a slope near a grid point; a flat top, which doubles hardly see, may be some points away."""
    for reach in (1, 4, 16, 64, 256, 1024, 4096, 16384):
        low, high = grid[max(best - reach, 0)], grid[min(best + reach, grid.size - 1)]
        if slope(mp.mpf(low)) > 0 > slope(mp.mpf(high)):
            return bracketed_root(slope, low, high)
    msg = f"no maximum near w = {grid[best]}"
    raise ArithmeticError(msg)


def _margins(case: Case, L: Callable[[Any], Any], grid: np.ndarray) -> dict[str, dict[str, Number]]:
    value = L(grid)
    negative = [(low, high) for low, high in _brackets(value.imag, grid) if L(mp.mpf(low)).real < 0]
    # beyond those with |L| near or above one, only the largest of the others can be the margin
    size = {pair: float(abs(L(mp.mpf(pair[0])))) for pair in negative}
    largest = sorted((pair for pair in negative if size[pair] <= CLEAR), key=lambda pair: -size[pair])[:NEXT]
    real_negative = [
        bracketed_root(lambda w: mp.im(L(w)), low, high)
        for low, high in negative
        if size[low, high] > CLEAR or (low, high) in largest
    ]
    unit = [
        bracketed_root(lambda w: mp.log(abs(L(w))), low, high) for low, high in _brackets(np.abs(value) - 1.0, grid)
    ]
    factors = [(1 / abs(L(w)), w) for w in real_negative]
    A, B = case.polynomials["A"], case.polynomials["B"]
    if A[-1] and B[-1] / A[-1] < 0:  # a pole can pass through s = 0
        factors.append((-A[-1] / B[-1], mp.mpf(0)))
    direct = feedthrough(case)
    if direct and case.dead_time:
        factors.append((1 / direct, None))
    lags = [(mp.fmod(mp.arg(L(w)) + mp.pi, 2 * mp.pi), w) for w in unit]
    lags = [(lag + 2 * mp.pi if lag < 0 else lag, w) for lag, w in lags]
    none: tuple[Number, Number] = (None, None)
    below = [(-value, w) for value, w in factors if value < 1]
    reduction = min(below, default=(mp.mpf(0), None), key=_first)
    return {
        "gain_margin": _named(min((f for f in factors if f[0] > 1), default=none, key=_first)),
        "gain_reduction_margin": _named((-reduction[0], reduction[1])),
        "phase_margin": _named(min(((mp.degrees(lag), w) for lag, w in lags), default=none, key=_first)),
        "delay_margin": _named(min(((lag / w, w) for lag, w in lags), default=none, key=_first)),
    }


def _brackets(values: np.ndarray, grid: np.ndarray) -> list[tuple[float, float]]:
    """Return intervals with a change of sign; a zero on the grid itself lies inside one."""
    signs = np.sign(values)
    found = [(grid[i], grid[i + 1]) for i in np.nonzero(signs[:-1] * signs[1:] < 0)[0]]
    zeros = np.nonzero(signs[1:-1] == 0)[0] + 1
    return found + [(grid[j - 1], grid[j + 1]) for j in zeros if signs[j - 1] * signs[j + 1] < 0]


def _first(pair: tuple[mp.mpf, Number]) -> mp.mpf:
    return pair[0]


def _named(pair: tuple[Number, Number]) -> dict[str, Number]:
    return {"value": pair[0], "frequency": pair[1]}
