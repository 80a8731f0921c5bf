r"""A plant with several dead times, :math:`G(s) = \sum_i N_i(s) e^{-sL_i} / D(s)`, and the algebra of plants.

All terms share one denominator, the least common multiple of theirs, so that the plant has the fewest states. A pole
that all terms cancel together, as s = 0 of :math:`(1-e^{-s})/s`, is not a pole; near it the plant is evaluated by
Cauchy's integral, which does not cancel.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from replicate.loops import checks
from replicate.loops.errors import LoopError
from replicate.loops.plant import Plant
from replicate.loops.plants.function_algebra import Product, Sum

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

SAME = 1e-9  # relative distance at which two roots, or two dead times, are one
CANCELLED = 1e-11  # size of a Taylor coefficient, relative to its parts, that is a zero
CIRCLE_POINTS = 48
NEAR = 0.4  # of the radius of that circle: points that are evaluated by it
AT_REST = 1e-6  # of the lowest corner: a frequency at which only what happens at rest shows


class SumPlant(Plant):
    """A sum of rational plants with different dead times; made by `Plant.from_terms`, `Plant.__add__` and the like."""

    def __init__(self, parts: Sequence[Plant]) -> None:
        ordered = sorted(parts, key=lambda part: part.dead_time)
        self._parts = tuple(ordered)
        self.dead_time = ordered[0].dead_time
        roots: list[complex] = []
        for part in ordered:
            roots = _union(roots, _roots(part.den))
        shared = all(part.den.size == len(roots) + 1 for part in ordered)
        self.common_den: Array = ordered[0].den if shared else _polynomial(roots)
        self.nums: list[Array] = [
            np.asarray(np.polymul(part.num, _polynomial(_difference(roots, _roots(part.den)))), dtype=float)
            if part.den.size < self.common_den.size
            else part.num
            for part in ordered
        ]
        self.dead_times: Array = np.array([part.dead_time for part in ordered])

    # the coefficients of a single rational part do not exist
    @property
    def num(self) -> Array:  # type: ignore[override]
        """Refuse: a plant with several dead times has no single numerator; LoopError always."""
        raise LoopError(_SEVERAL)

    @property
    def den(self) -> Array:  # type: ignore[override]
        """Refuse: a plant with several dead times is described by its terms; LoopError always."""
        raise LoopError(_SEVERAL)

    @property
    def is_rational(self) -> bool:
        """False: there are several dead times."""
        return False

    @property
    def parts(self) -> tuple[Plant, ...]:
        """The rational plants with one dead time each whose sum the plant is, shortest dead time first."""
        return self._parts

    def delay_free(self, s: ArrayLike) -> ComplexArray:
        """Evaluate the plant without its shortest dead time at complex ``s``."""
        s = np.asarray(s, dtype=complex)
        near = np.zeros(s.shape, dtype=bool)
        for pole in self.removable:
            near |= np.abs(s - pole) < NEAR * self._radius
        with np.errstate(divide="ignore", invalid="ignore"):
            values = np.array(self._direct(s), dtype=complex)
        if near.any():
            values[near] = self._by_cauchy(s[near])
        return values

    def _direct(self, s: ComplexArray) -> ComplexArray:
        total = np.zeros(s.shape, dtype=complex)
        for num, delay in zip(self.nums, self.dead_times, strict=True):
            total = total + np.polyval(num, s) * np.exp(-s * (delay - self.dead_time))
        return np.asarray(total / np.polyval(self.common_den, s))

    def _by_cauchy(self, s: ComplexArray) -> ComplexArray:
        pole = np.array(self.removable)[np.argmin(np.abs(s[:, None] - np.array(self.removable)), axis=1)]
        turn = np.exp(2j * np.pi * (np.arange(CIRCLE_POINTS) + 0.5) / CIRCLE_POINTS)
        around = pole[:, None] + self._radius * turn
        return np.asarray(np.mean(self._direct(around) * self._radius * turn / (around - s[:, None]), axis=1))

    @cached_property
    def _radius(self) -> float:
        """Radius of the circles around removable poles: clear of other poles, within what the dead times allow."""
        spread = float(self.dead_times[-1] - self.dead_time)
        others = [abs(p - q) for p in self.removable for q in _roots(self.common_den) if abs(p - q) > SAME * abs(q)]
        return float(min([2.0 / spread, *(0.5 * d for d in others if d)]))

    @cached_property
    def removable(self) -> tuple[complex, ...]:
        """The poles with Re s >= 0 of the common denominator at which the terms cancel, once for each order."""
        found: list[complex] = []
        for pole in _union([], _roots(self.common_den)):
            if pole.real < 0.0 or any(abs(pole - q) <= SAME * abs(pole) for q in found):
                continue
            order = sum(abs(pole - q) <= SAME * abs(pole) for q in _roots(self.common_den))
            for n in range(order):
                parts = [
                    _derivative(num, float(delay - self.dead_time), complex(pole), n)
                    for num, delay in zip(self.nums, self.dead_times, strict=True)
                ]
                if abs(sum(p for p, _ in parts)) > CANCELLED * sum(size for _, size in parts):
                    break
                found.append(complex(pole))
        return tuple(found)

    def log_derivative(self, s: ArrayLike) -> ComplexArray:
        """Evaluate G'(s)/G(s), dead times included."""
        s = np.asarray(s, dtype=complex)
        series = self.taylor(s.ravel(), 1)
        return np.asarray((series[1] / series[0]).reshape(s.shape) - self.dead_time)

    def taylor(self, s: ComplexArray, order: int) -> ComplexArray:
        """Return Taylor coefficients of the plant without its shortest dead time, shape (order + 1, len(s))."""
        from replicate.loops.plants.jets import delay_series, series_product

        total = np.zeros((order + 1, s.size), dtype=complex)
        for part in self.parts:
            delay = delay_series(s, part.dead_time - self.dead_time, order)
            total = total + series_product(part.taylor(s, order), delay)
        return total

    @property
    def integrators(self) -> int:
        """The number of poles at s = 0 that the terms do not cancel."""
        zeros = self.common_den.size - np.trim_zeros(self.common_den, "b").size
        return int(zeros - sum(pole == 0.0 for pole in self.removable))

    @property
    def gain(self) -> float:
        """The steady-state gain G(0); ``inf`` for an integrating plant."""
        return float("inf") if self.integrators else float(complex(self.delay_free(np.zeros(1))[0]).real)

    @property
    def gain_is_negative(self) -> bool:
        """Whether only a negative integral gain can stabilise the plant."""
        low, _ = self.corners
        at = AT_REST * low
        unstable = sum(p.real > 0.0 for p in _roots(self.common_den)) - sum(p.real > 0.0 for p in self.removable)
        value = complex(self.delay_free(np.array([at + 0j]))[0]).real
        return bool(value * (-1.0) ** unstable < 0.0)

    def poles(self) -> ComplexArray:
        """Return the poles of the common denominator that the terms do not cancel in the right half-plane."""
        return np.array(_difference(list(_roots(self.common_den)), list(self.removable)), dtype=complex)

    def zeros(self) -> ComplexArray:
        """Return nothing: a sum of dead times has infinitely many zeros."""
        return np.empty(0, dtype=complex)

    @property
    def corners(self) -> tuple[float, float]:
        """Lowest and highest of the terms' corner frequencies and of one over each dead time."""
        ends = [end for part in self.parts for end in part.corners if part.den.size + part.num.size > 2]
        spread = [1.0 / delay for delay in np.diff(self.dead_times)] + [1.0 / d for d in self.dead_times if d]
        return float(min(ends + spread)), float(max(ends + spread))

    def rescaled(self, time: float, gain: float) -> Plant:
        """Return the plant in another unit of time, its gain divided by ``gain``."""
        return SumPlant([part.rescaled(time, gain) for part in self.parts])

    def _times(self, factor: float) -> Plant:
        return SumPlant([part * factor for part in self.parts])

    def state_space(self) -> tuple[Array, Array, Array, float]:
        """Refuse: the plant has an input for each dead time; LoopError always."""
        raise LoopError(_SEVERAL)

    def state_space_by_dead_time(self) -> tuple[Array, Array, Array, Array]:
        """Return (A, B, C, D) in observer form, an input for each dead time: shapes (n, n), (n, m), (n,), (m,)."""
        order = self.common_den.size - 1
        padded = np.array([np.concatenate([np.zeros(order + 1 - num.size), num]) for num in self.nums])
        d = padded[:, 0] / self.common_den[0]
        a = np.zeros((order, order))
        if order:
            a[:, 0] = -self.common_den[1:]
            a[:-1, 1:] += np.eye(order - 1)
        b = (padded[:, 1:] - d[:, None] * self.common_den[1:]).T
        return a, b, np.eye(1, order)[0] if order else np.zeros(0), d

    def __repr__(self) -> str:
        terms = ", ".join(f"({p.num.tolist()}, {p.den.tolist()}, {checks.exact(p.dead_time)})" for p in self.parts)
        return f"Plant.from_terms([{terms}])"


_SEVERAL = "a plant with several dead times has no single numerator and denominator: use its parts"


def sum_of(plants: Sequence[Plant]) -> Plant:
    """Return the sum of plants; terms of equal dead time become one rational term.

    Raises
    ------
    LoopError
        If there is no plant, or nothing is left.
    """
    if not plants:
        msg = "a plant must have at least one term (num, den, dead_time)"
        raise LoopError(msg)
    if any(not plant.parts for plant in plants):
        total = Sum(tuple(plants))
        return Plant.from_function(total, total.dead_time)
    merged: list[Plant] = []
    for plant in sorted((part for whole in plants for part in whole.parts), key=lambda p: p.dead_time):
        last = merged[-1] if merged else None
        if last is not None and plant.dead_time - last.dead_time <= SAME * plant.dead_time:
            merged.pop()
            together = _rational_sum(last, plant)
            merged += [] if together is None else [together]
        else:
            merged.append(plant)
    if not merged:
        msg = "the plant's terms must not cancel altogether"
        raise LoopError(msg)
    return merged[0] if len(merged) == 1 else SumPlant(merged)


def product_of(first: Plant, second: Plant) -> Plant:
    """Return the plants in series."""
    if not (first.parts and second.parts):
        return Plant.from_function(Product(first, second), first.dead_time + second.dead_time)
    return sum_of(
        [
            Plant(np.polymul(p.num, q.num), np.polymul(p.den, q.den), p.dead_time + q.dead_time)
            for p in first.parts
            for q in second.parts
        ]
    )


def _rational_sum(first: Plant, second: Plant) -> Plant | None:
    roots = _union(_roots(first.den), _roots(second.den))
    if first.den.size == second.den.size and np.array_equal(first.den, second.den):
        num, den = np.polyadd(first.num, second.num), first.den
    else:
        den = _polynomial(roots)
        left = np.polymul(first.num, _polynomial(_difference(roots, _roots(first.den))))
        num = np.polyadd(left, np.polymul(second.num, _polynomial(_difference(roots, _roots(second.den)))))
    return Plant(num, den, first.dead_time) if np.any(num) else None


def _roots(polynomial: Array) -> list[complex]:
    return [complex(root) for root in np.roots(polynomial)]


def _polynomial(roots: Sequence[complex]) -> Array:
    return np.atleast_1d(np.real(np.poly(np.array(roots, dtype=complex)))) if len(roots) else np.ones(1)


def _difference(roots: Sequence[complex], taken: Sequence[complex]) -> list[complex]:
    """Return the roots that are left when others, each equal to one of them up to rounding, are taken away."""
    left = list(roots)
    for root in taken:
        index = int(np.argmin([abs(root - other) for other in left]))
        left.pop(index)
    return left


def roots_without(roots: ComplexArray, taken: ComplexArray) -> ComplexArray:
    """Return the roots that are left when others, each one of them up to rounding, are taken away."""
    return np.array(_difference(roots.tolist(), taken.tolist()), dtype=complex)


def _union(roots: Sequence[complex], more: Sequence[complex]) -> list[complex]:
    """Return the least common multiple of two sets of roots."""
    free, union = list(roots), list(roots)
    for root in more:
        match = [i for i, other in enumerate(free) if abs(root - other) <= SAME * max(abs(root), abs(other))]
        if match:
            free.pop(match[0])
        else:
            union.append(root)
    return union


def _derivative(num: Array, delay: float, s: complex, order: int) -> tuple[complex, float]:
    """Return the derivative of num(s) e^(-s delay) of some order, and the size of its parts."""
    value, size = 0.0 + 0.0j, 0.0
    for k in range(order + 1):
        weight = _binomial(order, k)
        part = weight * np.polyval(np.polyder(num, k), s) * (-delay) ** (order - k) * np.exp(-s * delay)
        value, size = value + part, size + abs(part)
    return complex(value), float(size)


def _binomial(n: int, k: int) -> float:
    return float(np.prod([(n - i) / (i + 1) for i in range(k)]))
