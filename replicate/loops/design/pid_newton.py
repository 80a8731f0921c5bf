r"""Newton's method for the conditions of an optimal PID design: gains, touching frequencies and multipliers at once.

Where the constraints :math:`g_j \ge 0` touch zero at frequencies :math:`\omega_j`, the largest :math:`k_i` satisfies

.. math::

    e_{k_i} + \sum_j \lambda_j \nabla g_j = 0, \qquad g_j = 0, \qquad \partial g_j / \partial \omega_j = 0,

the last one only inside a constraint's range. Up to positive factors the constraints are quadratic forms in the gains
(`LoopJet.forms`), so that all second derivatives are at hand and few steps are needed.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from replicate.loops.design.circles import Circle
from replicate.loops.design.nyquist_constraints import Constraint, LoopJet
from replicate.loops.plant import Plant

Array = NDArray[np.float64]

MOST_STEPS, HALVINGS = 30, 8
SOLVED = 1e-9  # largest residual of a solution
COUNTS = 1e-9  # multiplier of a constraint that holds something back
FLAT = 1e-6  # curvature of ki, relative to what the constraints bend, that is none
CONVERGED = 1e-13  # size of the residual from which on a step is made of rounding


@dataclass(frozen=True)
class Touch:
    """A constraint that touches zero, at a frequency."""

    constraint: Constraint
    frequency: float
    multiplier: float

    @property
    def in_the_limit(self) -> bool:
        """Whether it is the circle's approach at infinite frequency."""
        return self.frequency == np.inf

    @property
    def is_fixed(self) -> bool:
        """Whether the frequency stays where it is: in the limit, or at an end of the constraint's range."""
        return self.in_the_limit or self.frequency in (self.constraint.low, self.constraint.high)


@dataclass(frozen=True)
class OptimalitySystem:
    """The conditions for a set of touches.

    Attributes
    ----------
    edge
        ``|L|`` at infinite frequency, per unit of kd.
    size
        Units of the gains, shape (3,).
    """

    plant: Plant
    circle: Circle
    edge: float
    touches: Sequence[Touch]
    size: Array

    def solved(self, gains: Array) -> tuple[Array, Array, Array] | None:
        """Return gains, frequencies and multipliers of the maximum near some gains; None if there is none.

        Multipliers are the growth of ki per unit by which a dimensionless constraint is relaxed.
        """
        count, first = len(self.touches), self._finite
        scales = self._scales(LoopJet.of(self.plant, first), gains)
        z = np.concatenate([gains / self.size, np.zeros(count), [touch.multiplier for touch in self.touches]])
        with np.errstate(all="ignore"):  # a start that leads nowhere may wander off; the residual tells
            z, residual, jacobian = _newton(lambda z: self._equations(z, scales), z)
        if not np.max(np.abs(residual)) <= SOLVED or not _is_maximum(z[3 + count :], jacobian):
            return None
        gains, frequencies = z[:3] * self.size, first * np.exp(z[3 : 3 + count])
        relative = self._scales(LoopJet.of(self.plant, frequencies), gains) / scales
        frequencies[[touch.in_the_limit for touch in self.touches]] = np.inf
        return gains, frequencies, z[3 + count :] * relative * self.size[1]

    @property
    def _finite(self) -> Array:
        """The frequencies of the touches, with some number in place of infinity."""
        return np.array([1.0 if touch.in_the_limit else touch.frequency for touch in self.touches])

    def _scales(self, jet: LoopJet, gains: Array) -> Array:
        """Return what makes each constraint dimensionless."""
        kinds = {touch.constraint.kind for touch in self.touches}
        scales = {kind: jet.scales(kind, self.circle, gains) for kind in kinds}
        return np.array(
            [1.0 if touch.in_the_limit else scales[touch.constraint.kind][n] for n, touch in enumerate(self.touches)]
        )

    def _equations(self, z: Array, scales: Array) -> tuple[Array, Array]:
        """Return residual and Jacobian; unknowns are gains in their units, logarithms of frequencies, multipliers."""
        count, gains = len(self.touches), z[:3] * self.size
        frequencies, multipliers = self._finite * np.exp(z[3 : 3 + count]), z[3 + count :]
        jet = LoopJet.of(self.plant, frequencies, order=4)
        residual, jacobian = np.zeros(z.size), np.zeros((z.size, z.size))
        residual[1] = 1.0  # the gradient of ki
        for n, touch in enumerate(self.touches):
            if touch.in_the_limit:
                value, slope, bend = self._in_the_limit(gains)
            else:
                value, slope, bend = self._expanded(touch.constraint, jet.at(np.array([n])), gains)
            units = np.append(self.size, frequencies[n])
            slope, bend = slope * units / scales[n], bend * np.outer(units, units) / scales[n]
            bend[3, 3] += slope[3]  # the second derivative in log w
            w, row = 3 + n, 3 + count + n
            residual[:3] += multipliers[n] * slope[:3]
            jacobian[:3, :3] += multipliers[n] * bend[:3, :3]
            jacobian[:3, w], jacobian[:3, row] = multipliers[n] * bend[:3, 3], slope[:3]
            residual[row], jacobian[row, :3], jacobian[row, w] = value / scales[n], slope[:3], slope[3]
            if touch.is_fixed:
                residual[w], jacobian[w, w] = z[w], 1.0
            else:
                residual[w], jacobian[w, :3], jacobian[w, w] = slope[3], bend[:3, 3], bend[3, 3]
        return residual, jacobian

    def _expanded(self, constraint: Constraint, jet: LoopJet, gains: Array) -> tuple[float, Array, Array]:
        """Return value, gradient and second derivatives of a constraint in (k, ki, kd, w)."""
        value, slope, bend = _of_form(jet.forms(constraint.kind, self.circle, order=2)[..., 0], gains)
        if constraint.margin:  # the value is that of the form, less margin |L'|^3
            speed = LoopJet(jet.w, jet.phi[1:]).squared_modulus(order=2)[..., 0]
            square, turn, twist = _of_form(speed, gains)
            root = np.sqrt(square)
            value -= constraint.margin * square * root
            slope = slope - 1.5 * constraint.margin * root * turn
            bend = bend - constraint.margin * (1.5 * root * twist + 0.75 * np.outer(turn, turn) / root)
        return value, slope, bend

    def _in_the_limit(self, gains: Array) -> tuple[float, Array, Array]:
        """Return the same of the circle in the limit of infinite frequency, where kd alone counts."""
        radius, distance = self.circle.radius, self.circle.center - abs(gains[2]) * self.edge
        slope, bend = np.zeros(4), np.zeros((4, 4))
        slope[2] = -2.0 * distance * self.edge * np.sign(gains[2]) / radius**2
        bend[2, 2] = 2.0 * self.edge**2 / radius**2
        return distance**2 / radius**2 - 1.0, slope, bend


def _of_form(matrices: Array, gains: Array) -> tuple[float, Array, Array]:
    """Return X M X with X = (1, gains), and its derivatives in (gains, w), from M and its derivatives in w."""
    x = np.append(1.0, gains)
    rows = matrices @ x
    whole = rows @ x
    bend = np.empty((4, 4))
    bend[:3, :3], bend[3, 3] = 2.0 * matrices[0, 1:, 1:], whole[2]
    bend[3, :3] = bend[:3, 3] = 2.0 * rows[1, 1:]
    return float(whole[0]), np.append(2.0 * rows[0, 1:], whole[1]), bend


def _newton(equations: Callable[[Array], tuple[Array, Array]], z: Array) -> tuple[Array, Array, Array]:
    """Return where Newton's method with halved steps ends, and residual and Jacobian there."""
    residual, jacobian = equations(z)
    for _ in range(MOST_STEPS):
        size = float(np.linalg.norm(residual))
        if size <= CONVERGED:
            break
        try:
            step = np.linalg.solve(jacobian, -residual)
        except np.linalg.LinAlgError:
            break
        for _ in range(HALVINGS if size > SOLVED else 1):
            following, slopes = equations(z + step)
            if np.linalg.norm(following) < size:
                break
            step = 0.5 * step
        else:  # at rounding level, or lost
            break
        z, residual, jacobian = z + step, following, slopes
    return z, residual, jacobian


def _is_maximum(multipliers: Array, jacobian: Array) -> bool:
    """Say whether ki falls in all directions along which the constraints that count touch on: no saddle."""
    count = multipliers.size
    bend, turn = jacobian[:3, :3].copy(), jacobian[3 : 3 + count]
    for n in range(count):  # the touching frequencies move along
        bend -= np.outer(jacobian[:3, 3 + n], turn[n, :3]) / turn[n, 3 + n]
    held = jacobian[3 + count :, :3][multipliers > COUNTS]
    free = np.linalg.svd(held)[2][held.shape[0] :]
    largest = np.max(np.linalg.eigvalsh(free @ bend @ free.T), initial=0.0)
    return bool(largest <= FLAT * np.abs(bend).max())
