"""Exact impulse and pulse responses of rational systems with simple poles, as sums of exponentials."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from replicate.loops import Plant

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

DECAYED = 26.0  # time constants of the slowest mode after which its contribution is below 1e-11
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

    def roots(self, t: Array) -> Array:
        """Return the sign changes between ascending times, found there and polished by Newton's method."""
        y = self(t)
        change = np.nonzero(y[:-1] * y[1:] < 0.0)[0]
        left, right = t[change], t[change + 1]
        found = left - y[change] * (right - left) / (y[change + 1] - y[change])
        slope = self.derivative()
        for _ in range(4):
            found = np.clip(found - self(found) / slope(found), left, right)
        return found

    def absolute_integral(self) -> float:
        """Return the integral of the absolute value over all time.

        Between sign changes the integral is a difference of the antiderivative. The extrema are put into the grid on
        which sign changes are sought, so that a response that just touches zero is not misjudged.
        """
        end = DECAYED / float(np.min(-self.poles.real))
        count = int(PER_RADIAN * end * max(float(np.max(np.abs(self.poles.imag))), 1.0 / end)) + 200
        t = np.linspace(0.0, end, count)
        t = np.union1d(t, self.derivative().roots(t))
        total = self.integral()
        ends = np.append(total(np.concatenate([[0.0], self.roots(t)])), 0.0)
        return float(np.sum(np.abs(np.diff(ends))))
