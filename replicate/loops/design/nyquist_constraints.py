r"""Constraints on the Nyquist curve of a PID loop, as functions of the gains x = (k, ki, kd) at each frequency.

With :math:`L(i\omega) = \sum_j x_j \varphi_j(\omega)` linear in the gains, all three are quadratic in x:

* sensitivity: :math:`|C + L|^2 - R^2 \ge 0`, outside a circle;
* curvature: :math:`-\mathrm{Im}(\bar{\dot L} \ddot L) \ge 0`, the curve only ever bends clockwise;
* phase: :math:`-\mathrm{Im}(\bar L \dot L) \ge 0`, the phase only ever falls.

Dots are derivatives with respect to frequency. Each value is divided by what makes it dimensionless, so that one
tolerance serves all: the sensitivity by R^2, the phase slope becomes d(arg L)/d(log w), the bend the curvature of the
curve itself.

Reference: Panagopoulos, thesis (2000), supplement to paper II, (1) to (5).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import comb, factorial
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from replicate.loops import checks
from replicate.loops.design.circles import Circle
from replicate.loops.errors import LoopError
from replicate.loops.plant import Plant
from replicate.loops.plants.jets import plant_jet

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

Kind = Literal["sensitivity", "curvature", "phase"]


@dataclass(frozen=True)
class Constraint:
    """One constraint and the frequencies on which it is asked for.

    Attributes
    ----------
    kind
        ``sensitivity``, ``curvature`` or ``phase``.
    low, high
        The frequency range, rad per unit of time.
    margin
        For ``curvature``: the signed curvature must be at most ``-margin`` (in the Nyquist plane, dimensionless).
    """

    kind: Kind
    low: float = 0.0
    high: float = float("inf")
    margin: float = 0.0

    def __post_init__(self) -> None:
        kind: object = self.kind  # whatever was given
        if not isinstance(kind, str) or kind not in get_args(Kind):
            msg = f"constraint {checks.shown(self.kind)} is unknown; allowed: {', '.join(get_args(Kind))}"
            raise LoopError(msg)
        try:
            low, high = checks.real(self.low), checks.real(self.high)
        except ValueError:
            low = high = np.nan
        if not 0.0 <= low < high:
            given = f"{checks.shown(self.low)} to {checks.shown(self.high)}"
            msg = f"the range of the {self.kind} constraint must be numbers with 0 <= low < high, not {given}"
            raise LoopError(msg)
        margin = checks.finite(f"the margin of the {self.kind} constraint", self.margin)
        for name, value in (("low", low), ("high", high), ("margin", margin)):
            object.__setattr__(self, name, value)


@dataclass(frozen=True)
class LoopJet:
    """The basis of L and its derivatives at fixed frequencies; shape (derivative order + 1, 3, len(w))."""

    w: Array
    phi: ComplexArray

    @classmethod
    def of(cls, plant: Plant, w: Array, order: int = 2) -> LoopJet:
        """Return the basis (G, G/(i w), i w G) and its first ``order`` derivatives."""
        w = np.asarray(w, dtype=float)
        jet = plant_jet(plant, w, order)
        phi = np.empty((order + 1, 3, w.size), dtype=complex)
        phi[:, 0] = jet
        phi[:, 2] = 1j * w * jet
        phi[1:, 2] += 1j * jet[:-1]
        rest = -1j * jet
        phi[0, 1] = rest[0] / w
        for n in range(1, order + 1):  # i w times this series is G's
            phi[n, 1] = (rest[n] - phi[n - 1, 1]) / w
        for n in range(2, order + 1):
            phi[n] *= factorial(n)
        return cls(w, phi)

    def at(self, places: NDArray[Any]) -> LoopJet:
        """Return the basis at some of the frequencies, given by index or by flags."""
        return LoopJet(self.w[places], np.ascontiguousarray(self.phi[:, :, places]))

    def values(self, kind: Kind, circle: Circle, x: Array, margin: float = 0.0) -> tuple[Array, Array]:
        """Return the constraint's values (>= 0 where it holds), shape (n,), and gradients in x, shape (n, 3)."""
        if kind == "sensitivity":
            offset = circle.center + x @ self.phi[0]
            value = (offset.real**2 + offset.imag**2) / circle.radius**2 - 1.0
            gradient = 2.0 * (np.conj(offset) * self.phi[0]).real / circle.radius**2
            return value, gradient.T
        loop = x @ self.phi
        if kind == "phase":
            # -w d(arg L)/dw
            size = np.abs(loop[0]) ** 2 / self.w
            value = -(np.conj(loop[0]) * loop[1]).imag / size
            inner = -(np.conj(self.phi[0]) * loop[1] + np.conj(loop[0]) * self.phi[1]).imag
            shrink = 2.0 * (np.conj(loop[0]) * self.phi[0]).real / self.w
            return value, ((inner - value * shrink) / size).T
        speed = np.abs(loop[1])
        value = -(np.conj(loop[1]) * loop[2]).imag / speed**3
        inner = -(np.conj(self.phi[1]) * loop[2] + np.conj(loop[1]) * self.phi[2]).imag
        shrink = 3.0 * (np.conj(loop[1]) * self.phi[1]).real / speed**2
        return value - margin, (inner / speed**3 - value * shrink).T

    def forms(self, kind: Kind, circle: Circle, order: int = 0) -> Array:
        """Return the symmetric matrices of the constraint without margin, and their derivatives with respect to w.

        With them and X = (1, k, ki, kd), X M X is the constraint's value times the positive number that makes it
        dimensionless, `scales`. Shape (order + 1, 4, 4, n); the basis must be of an order higher by one for ``phase``,
        by two for ``curvature``.
        """
        if kind == "sensitivity":
            offset = self._rows(0, order)
            offset[0, 0] = circle.center
            matrices = _hermitian_products(offset, offset)
            matrices[0, 0, 0] -= circle.radius**2
            return matrices
        n = 0 if kind == "phase" else 1
        return _hermitian_products(self._rows(n, order), 1j * self._rows(n + 1, order))

    def squared_modulus(self, order: int = 0) -> Array:
        r"""Return the same matrices of \|L\|^2."""
        loop = self._rows(0, order)
        return _hermitian_products(loop, loop)

    def _rows(self, n: int, order: int) -> ComplexArray:
        """Return what (1, k, ki, kd) are multiplied by in the n-th derivative of L, and the derivatives of that."""
        rows = np.zeros((order + 1, 4, self.w.size), dtype=complex)
        rows[:, 1:] = self.phi[n : n + order + 1]
        return rows

    def scales(self, kind: Kind, circle: Circle, x: Array) -> Array:
        """Return what the constraint's value is divided by to be dimensionless, shape (n,)."""
        if kind == "sensitivity":
            return np.full(self.w.size, circle.radius**2)
        return np.asarray(np.abs(x @ self.phi[0]) ** 2 / self.w if kind == "phase" else np.abs(x @ self.phi[1]) ** 3)

    def slopes(self, kind: Kind, circle: Circle, x: Array) -> Array:
        """Return w times the derivative of the constraint's value in w, shape (n,); the basis must be of order 3."""
        loop = x @ self.phi
        if kind == "sensitivity":
            return np.asarray(self.w * 2.0 * (np.conj(circle.center + loop[0]) * loop[1]).real / circle.radius**2)
        if kind == "phase":
            # value = -w Im(L'/L)
            ratio = loop[1] / loop[0]
            return np.asarray(-self.w * (ratio + self.w * (loop[2] / loop[0] - ratio**2)).imag)
        speed = np.abs(loop[1])
        top = -(np.conj(loop[1]) * loop[2]).imag
        top_slope = -(np.conj(loop[1]) * loop[3]).imag
        speed_slope = (np.conj(loop[1]) * loop[2]).real / speed
        return np.asarray(self.w * (top_slope / speed**3 - 3.0 * top * speed_slope / speed**4))


def constraint_slope(plant: Plant, constraint: Constraint, circle: Circle, x: Array, w: float) -> float:
    """Return w times the derivative of a constraint's value with respect to frequency, from the exact third jets."""
    return float(LoopJet.of(plant, np.array([w]), order=3).slopes(constraint.kind, circle, x)[0])


def _hermitian_products(first: ComplexArray, second: ComplexArray) -> Array:
    """Return the symmetric matrices of Re(first conj(second)) and their derivatives with respect to w."""
    matrices = np.empty((first.shape[0], 4, 4, first.shape[2]))
    for n in range(first.shape[0]):
        products = [comb(n, j) * first[j][:, None] * np.conj(second[n - j]) for j in range(n + 1)]
        whole = sum(products).real
        matrices[n] = whole if first is second else 0.5 * (whole + np.swapaxes(whole, 0, 1))
    return matrices
