"""Loop transfer functions of plants that are not one rational function with one dead time."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from replicate.loops.errors import ImproperLoopError
from replicate.loops.frequency_domain.frequency_grids import loop_grid
from replicate.loops.frequency_domain.limit_curve import LimitCurve
from replicate.loops.frequency_domain.limit_torus import limit_of
from replicate.loops.frequency_domain.loop_transfer import (
    EPS,
    ILL_POSED,
    JUST_BEYOND,
    MOST_STEPS,
    STEP,
    LoopTransfer,
    never_falls,
    stationary_frequencies,
)
from replicate.loops.numerics.bracketed import bracketed_root
from replicate.loops.plants.function_plant import FunctionPlant
from replicate.loops.plants.sum_plant import SumPlant

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

AHEAD = 2.0 ** (np.arange(8 * 12 + 1) / 12)  # where the gain of a plant given by a function has to stay below a level
PER_DECADE = 200
AT_REST = 1e-9  # of the largest modulus: a root at s = 0
ABOVE = 1.001  # share of the limit at infinity below which a sum of gains cannot be asked to fall
REST = 1e-30  # of the lowest corner: a frequency that is zero for a function


class FunctionTransfer(LoopTransfer):
    """L of a plant given by a function: N/D is the controller."""

    @property
    def _function(self) -> FunctionPlant:
        assert isinstance(self.plant, FunctionPlant)  # noqa: S101  -- by construction
        return self.plant

    def __call__(self, s: Any) -> ComplexArray:
        """Evaluate L(s) at complex ``s``."""
        s = np.asarray(s, dtype=complex)
        return np.asarray(LoopTransfer.__call__(self, s) * self.plant.delay_free(s))

    def without_longest(self, s: ComplexArray) -> ComplexArray:
        """Evaluate L(s) times exp(s dead_time)."""
        return np.asarray(LoopTransfer.without_longest(self, s) * self.plant.delay_free(s))

    def characteristic(self, s: Any) -> ComplexArray:
        """Evaluate f(s) = D(s) + N(s) g(s) exp(-s dead_time)."""
        s = np.asarray(s, dtype=complex)
        fed_back = np.polyval(self.num, s) * np.exp(-s * self.dead_time) * self.plant.delay_free(s)
        return np.asarray(np.polyval(self.den, s) + fed_back)

    def characteristic_with_slope(self, s: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
        """Evaluate f(s) and f'(s), the function's part by a difference: N g has no pole where N cancels one of g."""

        def open_loop(s: ComplexArray) -> ComplexArray:
            return np.asarray(np.polyval(self.num, s) * self.plant.delay_free(s))

        fed_back = self._function.difference(open_loop, s) - self.dead_time * open_loop(s)
        slope = np.polyval(np.polyder(self.den), s) + fed_back * np.exp(-s * self.dead_time)
        return self.characteristic(s), np.asarray(slope)

    def size(self, s: ComplexArray) -> Array:
        """Return the sum of the moduli of f's terms."""
        fed_back = np.polyval(self.num, s) * np.exp(-s * self.dead_time) * self.plant.delay_free(s)
        return np.asarray(np.abs(np.polyval(self.den, s)) + np.abs(fed_back))

    def log_derivative(self, s: Any) -> ComplexArray:
        """Evaluate L'(s)/L(s)."""
        s = np.asarray(s, dtype=complex)
        return np.asarray(
            LoopTransfer.log_derivative(self, s) + self.dead_time + self.plant.log_derivative(s)
        )  # the plant's own dead time is in its derivative

    @cached_property
    def feedthrough(self) -> float:
        """0: a plant given by a function has to fall off at high frequency."""
        return 0.0

    @property
    def infinite_at_rest(self) -> bool:
        """Whether |L| is infinite at s = 0: by integral action, or as seen close to it."""
        with np.errstate(all="ignore"):
            close = abs(complex(self(1j * REST * self.plant.corners[0])))
        return bool(self.den[-1] == 0.0 or close > 1.0 / REST**0.25)

    @cached_property
    def gain_crossovers(self) -> Array:
        """All frequencies at which |L(i w)| = 1, ascending, found on a grid."""
        return crossings_of_one(self)

    @cached_property
    def corner_frequencies(self) -> ComplexArray:
        """Nonzero poles and zeros of the controller, and the function's resonances."""
        roots = np.concatenate([*self._roots, self.plant.resonances])
        return np.asarray(roots[np.abs(roots) > 0.0])

    def beyond(self, level: float) -> float:
        """Return a frequency beyond which |L(i w)| is taken to stay below ``level``: checked over eight octaves."""
        start = max([self.plant.corners[0], *np.abs(self.corner_frequencies).tolist()])
        with np.errstate(all="ignore"):
            gain_at_last = abs(complex(self(1j * start * STEP**MOST_STEPS)))
        if level <= gain_at_last < np.inf:
            raise never_falls(level)  # what it tends to is seen at once; the way there would be long
        return self._fall(start, level, AHEAD)

    def off_limit(self, w: float) -> float:
        """Return how large |L| is at most beyond a frequency: as seen over eight octaves."""
        return float(np.abs(self(1j * w * AHEAD)).max())


@dataclass(frozen=True)
class SumTransfer(LoopTransfer):
    """L of a plant with several dead times: a numerator for each, one denominator."""

    nums: tuple[Array, ...] = ()
    controller: tuple[Array, Array] = (np.ones(1), np.ones(1))

    @classmethod
    def of_parts(cls, plant: SumPlant, num: Array, den: Array) -> SumTransfer:
        """Return L for a controller num/den.

        Raises
        ------
        ImproperLoopError
            If |L| grows without bound at high frequency, or the loop's part without dead time is not well posed.
        """
        nums = tuple(np.asarray(np.polymul(num, part), dtype=float) if num.size else num for part in plant.nums)
        whole = np.asarray(np.polymul(den, plant.common_den), dtype=float)
        transfer = cls(nums[0], whole, plant.dead_time, plant, nums, (num, den))
        if any(part.size > whole.size for part in nums):
            msg = "the loop gain grows without bound at high frequency: filter the derivative or the measurement"
            raise ImproperLoopError(msg)
        if not plant.dead_time and abs(1.0 + transfer.limits[0]) < ILL_POSED:
            msg = "the loop is not well posed: without dead time L must not tend to -1 at infinite frequency"
            raise ImproperLoopError(msg)
        return transfer

    @property
    def dead_times(self) -> Array:
        """All dead times, ascending."""
        assert isinstance(self.plant, SumPlant)  # noqa: S101  -- by construction
        return self.plant.dead_times

    def __call__(self, s: Any) -> ComplexArray:
        """Evaluate L(s) at complex ``s``."""
        s = np.asarray(s, dtype=complex)
        if self.plant.removable:  # type: ignore[attr-defined]
            controller = np.polyval(self.controller[0], s) / np.polyval(self.controller[1], s)
            return np.asarray(controller * self.plant(s))
        return np.asarray(self._fed_back(s) / np.polyval(self.den, s))

    def without_longest(self, s: ComplexArray) -> ComplexArray:
        """Evaluate L(s) times exp(s longest_dead_time)."""
        return np.asarray(self._fed_back(s, self.longest_dead_time) / np.polyval(self.den, s))

    def _fed_back(self, s: ComplexArray, less: float = 0.0) -> ComplexArray:
        """Return D L, with dead times that are ``less`` shorter."""
        total = np.zeros(s.shape, dtype=complex)
        for num, delay in zip(self.nums, self.dead_times, strict=True):
            total = total + np.polyval(num, s) * np.exp(-s * (delay - less))
        return total

    def characteristic(self, s: Any) -> ComplexArray:
        """Evaluate f(s) = D(s) + sum N_i(s) exp(-s L_i), without the zeros that are not poles of the loop."""
        s = np.asarray(s, dtype=complex)
        whole = np.polyval(self.den, s) + self._fed_back(s)
        for pole in self._removable:
            whole = whole / (s - pole)
        return np.asarray(whole)

    def characteristic_with_slope(self, s: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
        """Evaluate f(s) and f'(s)."""
        slope = np.polyval(np.polyder(self.den), s)
        for num, delay in zip(self.nums, self.dead_times, strict=True):
            slope = slope + (np.polyval(np.polyder(num), s) - delay * np.polyval(num, s)) * np.exp(-s * delay)
        shrink = np.ones_like(s)
        for pole in self._removable:
            shrink = shrink * (s - pole)
        logs = sum((1.0 / (s - pole) for pole in self._removable), np.zeros_like(s))
        value = self.characteristic(s)
        return value, np.asarray(slope / shrink - value * logs)

    def size(self, s: ComplexArray) -> Array:
        """Return the sum of the moduli of f's terms: its rounding error is this times the relative precision."""
        modulus = np.abs(s)
        total: Array = np.asarray(np.polyval(np.abs(self.den), modulus), dtype=float)
        for num, delay in zip(self.nums, self.dead_times, strict=True):
            total = total + np.polyval(np.abs(num), modulus) * np.abs(np.exp(-s * delay))
        for pole in self._removable:
            total = total / np.abs(s - pole)
        return np.asarray(total)

    @property
    def _removable(self) -> tuple[complex, ...]:
        assert isinstance(self.plant, SumPlant)  # noqa: S101  -- by construction
        return self.plant.removable

    @property
    def infinite_at_rest(self) -> bool:
        """Whether |L| is infinite at s = 0."""
        return bool(self.controller[1][-1] == 0.0 or self.plant.integrators)

    @property
    def pole_at_rest(self) -> bool:
        """Whether s = 0 is a closed-loop pole, but not one of the common denominator alone."""
        constants = [float(self.den[-1]), *(float(num[-1]) for num in self.nums if num.size)]
        rounding = len(constants) * EPS * max(abs(c) for c in constants)
        return 0.0 not in self._removable and abs(sum(constants)) <= rounding

    @property
    def open_loop_poles(self) -> ComplexArray:
        """The poles of the open loop."""
        return np.concatenate([self.plant.poles(), np.roots(self.controller[1])])

    def log_derivative(self, s: Any) -> ComplexArray:
        """Evaluate L'(s)/L(s)."""
        s = np.asarray(s, dtype=complex)
        num, den = self.controller
        rational = np.polyval(np.polyder(num), s) / np.polyval(num, s) - np.polyval(np.polyder(den), s) / np.polyval(
            den, s
        )
        return np.asarray(rational + self.plant.log_derivative(s))

    @cached_property
    def limits(self) -> Array:
        """The limits of N_i/D at infinite frequency."""
        return np.array([num[0] / self.den[0] if 0 < num.size == self.den.size else 0.0 for num in self.nums])

    @cached_property
    def feedthrough(self) -> float:
        """The largest |L| in the limit of infinite frequency; 1 or more only if the loop then is unstable or static."""
        curve = self.limit_curve
        delayed = curve.delayed / (1.0 + curve.direct)
        bound = float(np.abs(delayed).sum())
        if bound < 1.0 or delayed.size == 1:
            return bound
        # 1 + sum d_j z^n_j = 0 must have no root |z| <= 1
        polynomial = np.zeros(int(curve.steps[-1]) + 1)
        polynomial[-1] = 1.0
        np.add.at(polynomial, polynomial.size - 1 - curve.steps, delayed)
        return float(1.0 / np.min(np.abs(np.roots(polynomial)))) ** int(curve.steps[0])

    @cached_property
    def limit_curve(self) -> LimitCurve:
        """What L(i w) approaches at infinite frequency."""
        return limit_of(self.limits, self.dead_times)

    @cached_property
    def _rests(self) -> list[Array]:
        """What each N_i has more than its limit's share of D."""
        padded = (np.append(np.zeros(self.den.size - num.size), num) for num in self.nums)
        return [(num - limit * self.den)[1:] for num, limit in zip(padded, self.limits, strict=True)]

    def off_limit(self, w: float) -> float:
        """Return how far L is at most from its limit curve beyond a frequency that `beyond` has returned."""
        s = np.array(1j * w)
        return float(sum(abs(np.polyval(rest, s)) for rest in self._rests) / abs(np.polyval(self.den, s)))

    @cached_property
    def corner_frequencies(self) -> ComplexArray:
        """Nonzero poles and zeros of all terms of L."""
        roots = np.concatenate([np.roots(self.den), *(np.roots(num) for num in self.nums if num.size)]).astype(complex)
        return np.asarray(roots[np.abs(roots) > AT_REST * np.abs(roots).max(initial=0.0)])

    @cached_property
    def gain_crossovers(self) -> Array:
        """All frequencies at which |L(i w)| = 1, ascending, found on a grid; with feedthrough, up to its asymptote."""
        return crossings_of_one(self, max(0.5, 0.5 * (1.0 + self.feedthrough)))

    def beyond(self, level: float) -> float:
        """Return a frequency beyond which sum |L_i(i w)| provably stays below ``level``."""
        numerators = [*self.nums, *self._rests] if self.feedthrough else self.nums
        stationary = [w for num in numerators if num.any() for w in stationary_frequencies(num, self.den).tolist()]
        start = max([*stationary, *np.abs(self.corner_frequencies).tolist()], default=1.0 / self.dead_times[-1])
        w = start * (1.0 + JUST_BEYOND)
        for _ in range(400):
            s = np.array(1j * w)
            sizes = [abs(np.polyval(num, s) / np.polyval(self.den, s)) for num in self.nums]
            if sum(sizes) < max(level, ABOVE * float(np.abs(self.limits).sum())):
                return float(w)
            w *= 1.5
        msg = f"the loop gain does not fall below {level:g} at high frequency"
        raise ImproperLoopError(msg)


def crossings_of_one(transfer: LoopTransfer, level: float = 0.5) -> Array:
    """Return the frequencies, ascending, at which |L(i w)| = 1, on a grid up to where it stays below a level."""
    w = loop_grid(transfer, transfer.beyond(level), per_decade=PER_DECADE)
    size = np.log(np.abs(transfer(1j * w)))
    changes = np.nonzero(size[:-1] * size[1:] < 0.0)[0]
    return np.array([bracketed_root(transfer.log_modulus, w[i], w[i + 1]) for i in changes])
