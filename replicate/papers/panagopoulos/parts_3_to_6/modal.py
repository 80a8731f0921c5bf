"""Exact impulse and pulse responses of rational systems with simple poles, as sums of exponentials."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from replicate.loops import Plant

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

DECAYED = 26.0  # time constants of the slowest mode after which its contribution is below 1e-11
BLOCK = 64  # times that share an exponential
PER_RADIAN = 2.0  # samples per radian of the fastest oscillation, to separate extrema


@dataclass(frozen=True)
class ModalSum:
    """The real part of the sum over i of residues[i] * exp(poles[i] * t), shapes (n,).

    Of each conjugate pair of poles only the one with Im > 0 is kept, with twice its residue.
    """

    poles: ComplexArray
    residues: ComplexArray

    @classmethod
    def impulse(cls, plant: Plant) -> ModalSum:
        """Return the impulse response of a strictly proper rational plant without dead time and with simple poles."""
        poles = plant.poles()
        poles = poles[poles.imag >= 0.0]
        residues = np.polyval(plant.num, poles) / np.polyval(np.polyder(plant.den), poles)
        return cls(poles, np.where(poles.imag > 0.0, 2.0, 1.0) * residues)

    def __call__(self, t: ArrayLike) -> Array:
        """Evaluate at times ``t``; zero before t = 0."""
        t = np.asarray(t, dtype=float)
        values = (np.exp(np.maximum(t, 0.0)[..., None] * self.poles) @ self.residues).real
        return np.where(t >= 0.0, values, 0.0)

    def integral(self) -> ModalSum:
        """Return an antiderivative; it tends to zero."""
        return ModalSum(self.poles, self.residues / self.poles)

    def pulse(self, width: float, t: ArrayLike) -> Array:
        """Return the response to a pulse of unit area and the given width that starts at t = 0."""
        t = np.asarray(t, dtype=float)
        step = self.integral()
        return np.asarray((step(np.maximum(t, 0.0)) - step(np.maximum(t - width, 0.0))) / width)

    def derivative(self) -> ModalSum:
        """Return the derivative."""
        return ModalSum(self.poles, self.residues * self.poles)

    def roots(self, t: Array, y: Array) -> Array:
        """Return the sign changes between ascending times with given values, polished by Newton's method."""
        change = np.nonzero(y[:-1] * y[1:] < 0.0)[0]
        left, right = t[change], t[change + 1]
        found = left - y[change] * (right - left) / (y[change + 1] - y[change])
        slopes = self.derivative().residues
        for _ in range(4):
            modes = np.exp(found[:, None] * self.poles)
            found = np.clip(found - (modes @ self.residues).real / (modes @ slopes).real, left, right)
        return found

    def _modes(self, step: float, count: int) -> ComplexArray:
        """Return exp(poles[i] * t) at ``count`` equal steps from t = 0, as products of few exponentials."""
        fine, coarse = np.arange(BLOCK), BLOCK * np.arange(-(-count // BLOCK))
        starts, parts = (np.exp(step * n[:, None] * self.poles) for n in (coarse, fine))
        return np.asarray((starts[:, None] * parts).reshape(-1, self.poles.size)[:count])

    def absolute_integral(self) -> float:
        """Return the integral of the absolute value over all time.

        Between sign changes the integral is a difference of the antiderivative. The extrema are put into the grid on
        which sign changes are sought, so that a response that just touches zero is not misjudged.
        """
        end = DECAYED / float(np.min(-self.poles.real))
        count = int(PER_RADIAN * end * max(float(np.max(np.abs(self.poles.imag))), 1.0 / end)) + 200
        t, slope, total = np.linspace(0.0, end, count), self.derivative(), self.integral()
        modes = self._modes(t[1], count)
        extrema = slope.roots(t, (modes @ slope.residues).real)
        t = np.concatenate([t, extrema])
        y = np.concatenate([(modes @ self.residues).real, self(extrema)])
        order = np.argsort(t)
        ends = np.append(total(np.concatenate([[0.0], self.roots(t[order], y[order])])), 0.0)
        return float(np.sum(np.abs(np.diff(ends))))
