"""The optimality system of PID design: a point found on a frequency grid becomes an optimum, exact and verified.

At a maximum of ki every active constraint touches zero at its own frequency, where it is stationary, and the gradient
of ki is a combination of the active gradients with positive multipliers. Newton's method solves this for the gains, the
frequencies and the multipliers at once; the result is verified on all frequencies and for stability.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

from replicate.loops.controller import PID
from replicate.loops.design.circles import Circle
from replicate.loops.design.nyquist_constraints import Constraint, LoopJet
from replicate.loops.design.pid_newton import OptimalitySystem, Touch
from replicate.loops.design.pid_result import ActiveConstraint, PIDDesign, Status
from replicate.loops.design.setpoint_weights import pid_setpoint_weight
from replicate.loops.errors import LoopError
from replicate.loops.frequency_domain.frequency_grids import design_grid
from replicate.loops.loop import Loop
from replicate.loops.plant import Plant

Array = NDArray[np.float64]

NEARLY = 1e-5  # violation that a point found on the grid may have between its grid frequencies
TOUCHING_FIRST = 100.0  # weight of a constraint's value against its gradient when the active ones are chosen
LOST = 0.02  # of ki, between a point on the grid and the optimum near it
FEASIBLE = 2e-9
ZOOMS, FINER = 5, np.linspace(0.0, 1.0, 17)  # steps and points between two frequencies in which a minimum is found
TOUCHES = 5e-3  # value of a constraint that may be active at an optimum between the grid frequencies,
VALLEY = 0.05  # and one that may be violated there
AT_EDGE = 2e-3  # of the largest kd: distance from it at which infinite frequency may be a touching point
UNEXPLAINED = 0.3  # of the gradient of ki: what the active constraints must not leave over
NO_WEIGHT = 1e-6  # multiplier of a constraint that is not active
SMALLEST_GAIN = 1e-6  # of ki: size that a vanishing gain has, so that it can be scaled
SAME_TOUCH = 0.06  # touches closer than this relative distance in frequency are one


class GridProblem:
    """The semi-infinite problem: its constraints on a frequency grid, and the optimality system of those that touch."""

    def __init__(self, plant: Plant, circle: Circle, constraints: tuple[Constraint, ...]) -> None:
        self.plant = plant
        self.circle = circle
        self.constraints = constraints
        self._last: tuple[tuple[float, ...], Loop | None] = ((), None)
        w = design_grid(plant)
        self.grids = []
        for constraint in constraints:
            inside = w[(w > constraint.low) & (w < constraint.high)]
            ends = [e for e in (constraint.low, constraint.high) if 0.0 < e < np.inf]
            self.grids.append(LoopJet.of(plant, np.unique(np.concatenate([inside, ends]))))
        # |L| tends to kd times this at infinite frequency, where a dead time turns it through all phases: there, too,
        # the Nyquist curve has to stay outside the circle
        first_order = plant.is_rational and plant.dead_time > 0.0 and plant.den.size - plant.num.size == 1
        self.edge = abs(float(plant.num[0])) if first_order else 0.0
        self.largest_kd = (circle.center - circle.radius) / self.edge if first_order else float("inf")

    def values(self, index: int, x: Array, grid: LoopJet | None = None) -> tuple[Array, Array]:
        """Return values and gradients of a constraint on its grid or a part of it, squashed to within -1 and 1."""
        constraint = self.constraints[index]
        grid = self.grids[index] if grid is None else grid
        value, gradient = grid.values(constraint.kind, self.circle, x, constraint.margin)
        # far from zero the exact size does not matter, and large numbers would only harm the quadratic subproblem
        squash = 1.0 / (1.0 + np.abs(value))
        return value * squash, gradient * (squash**2)[:, None]

    def at_infinity(self, x: Array) -> tuple[float, Array]:
        """Return value and gradient of the sensitivity constraint at infinite frequency."""
        distance = self.circle.center - abs(x[2]) * self.edge
        slope = -2.0 * distance * self.edge * np.sign(x[2]) / self.circle.radius**2
        return distance**2 / self.circle.radius**2 - 1.0, np.array([0.0, 0.0, slope])

    def loop(self, x: Array) -> Loop:
        """Return the loop of gains (k, ki, kd); that of the last gains is kept."""
        key = tuple(x.tolist())
        if key != self._last[0]:
            self._last = key, Loop(self.plant, PID(*key))
        assert self._last[1] is not None  # noqa: S101  -- just made
        return self._last[1]

    def is_stable(self, x: Array) -> bool:
        """Whether gains (k, ki, kd) give a stable loop."""
        try:
            return self.loop(x).is_stable()
        except LoopError:
            return False

    def finish(self, x: Array, grids: Sequence[LoopJet] | None = None) -> PIDDesign | None:
        """Return the verified design near a grid optimum, polished if the optimality system converges.

        Parameters
        ----------
        x
            Gains (k, ki, kd).
        grids
            One for each constraint, on which the point is an optimum: on a coarser one it may touch nothing. By default
            those of the problem.
        """
        active: list[ActiveConstraint] = []
        for preference in (TOUCHING_FIRST, 0.0):
            active = self._active(x, preference, self.grids if grids is None else grids)
            polished = self._newton(x, active) if active else None
            if polished is not None:
                gains, parts = polished
                # an optimum below the point itself is another one
                if gains[1] > x[1] * (1.0 - LOST) and self._verified(gains):
                    return self._design(gains, parts, "optimal")
        shrunk = x * np.array([1.0, 1.0 - NEARLY, 1.0])
        if self._verified(shrunk, NEARLY):
            return self._design(shrunk, tuple(active), "not-polished")
        return None

    def _active(self, x: Array, preference: float, grids: Sequence[LoopJet]) -> list[ActiveConstraint]:
        """Return the touching points with positive multipliers, from a non-negative fit of the gradient.

        ``preference`` weighs against points that come close to zero but do not touch it.
        """
        candidates: list[tuple[int, float, Array, float]] = []
        for index, grid in enumerate(grids):
            value, gradient = self.values(index, x, grid)
            edge = np.concatenate([[np.inf], value, [np.inf]])
            low = np.nonzero((value <= edge[:-2]) & (value <= edge[2:]) & (value < TOUCHES))[0]
            candidates += [(index, float(grid.w[i]), gradient[i], abs(float(value[i]))) for i in low]
        if abs(x[2]) > self.largest_kd * (1.0 - AT_EDGE):
            value_at_edge, gradient_at_edge = self.at_infinity(x)
            candidates.append((0, float("inf"), gradient_at_edge, abs(value_at_edge)))
        if not candidates:
            return []
        matrix = np.array([[*(gradient * _size(x)), preference * value] for _, _, gradient, value in candidates]).T
        # at a maximum the gradient of ki is minus a positive combination of the active gradients
        multipliers, residual = nnls(matrix, np.array([0.0, -1.0, 0.0, 0.0]))
        if residual > UNEXPLAINED:
            return []
        active: list[ActiveConstraint] = []
        for (index, touch, *_), multiplier in zip(candidates, multipliers, strict=True):
            kind, frequency, weight = self.constraints[index].kind, touch, float(multiplier)
            if weight <= NO_WEIGHT:
                continue
            if (
                active
                and active[-1].kind == kind
                and frequency < np.inf
                and frequency < active[-1].frequency * (1.0 + SAME_TOUCH)
            ):
                last = active.pop()  # one touch seen at two neighbouring grid frequencies
                total = last.multiplier + weight
                frequency = (last.frequency * last.multiplier + frequency * weight) / total
                weight = total
            active.append(ActiveConstraint(kind, frequency, weight))
        return active

    def _newton(self, x: Array, active: list[ActiveConstraint]) -> tuple[Array, tuple[ActiveConstraint, ...]] | None:
        """Solve the optimality system from a grid optimum; unknowns are gains, touching frequencies and multipliers."""
        by_kind = {constraint.kind: constraint for constraint in self.constraints}
        touches = [Touch(by_kind[part.kind], part.frequency, part.multiplier) for part in active]
        found = OptimalitySystem(self.plant, self.circle, self.edge, touches, _size(x)).solved(x)
        if found is None:
            return None
        gains, frequencies, multipliers = found
        if np.any(multipliers <= 0.0) or not 0.5 < gains[1] / x[1] < 2.0:
            return None
        parts = [
            ActiveConstraint(part.kind, w, m / float(gains[1]))  # relative to the ki that was found
            for part, w, m in zip(active, frequencies.tolist(), multipliers.tolist(), strict=True)
        ]
        order = {"sensitivity": 0, "curvature": 1, "phase": 2}
        return gains, tuple(sorted(parts, key=lambda p: (order[p.kind], p.frequency)))

    def _verified(self, x: Array, tolerance: float = FEASIBLE) -> bool:
        """Whether the loop is stable and no constraint is violated between the grid frequencies either."""
        if x[1] <= 0.0:
            return False
        try:
            loop = self.loop(x)
            if not loop.is_stable():
                return False
            inverse = loop.closest_approach(self.circle.center)
        except LoopError:
            return False
        if inverse.value * self.circle.radius > 1.0 + tolerance:
            return False
        return all(
            self._lowest(index, x) >= -tolerance for index, c in enumerate(self.constraints) if c.kind != "sensitivity"
        )

    def _lowest(self, index: int, x: Array) -> float:
        """Return the smallest value of a constraint on its range, polished between grid points."""
        constraint, w = self.constraints[index], self.grids[index].w
        values = self.grids[index].values(constraint.kind, self.circle, x, constraint.margin)[0]
        lowest = float(values.min())
        inner = (
            np.nonzero((values[1:-1] <= values[:-2]) & (values[1:-1] <= values[2:]) & (values[1:-1] < VALLEY))[0] + 1
        )
        left, right = np.log(w[inner - 1]), np.log(w[inner + 1])
        for _ in range(ZOOMS if inner.size else 0):
            # all valleys at once: the lowest of some points, and from there between its neighbours
            points = left[:, None] + (right - left)[:, None] * FINER
            jet = LoopJet.of(self.plant, np.exp(points).ravel())
            fine = jet.values(constraint.kind, self.circle, x, constraint.margin)[0].reshape(points.shape)
            at = np.clip(np.argmin(fine, axis=1), 1, FINER.size - 2)
            row = np.arange(inner.size)
            lowest = min(lowest, float(fine.min()))
            left, right = points[row, at - 1], points[row, at + 1]
        return lowest

    def _design(self, x: Array, active: tuple[ActiveConstraint, ...], status: Status) -> PIDDesign:
        k, ki, kd = (float(v) for v in x)
        peak = self.loop(x).complementary_peak()
        b = pid_setpoint_weight(PID(k, ki, kd), peak.frequency, peak.value)
        touching = [part.frequency for part in active if part.kind == "sensitivity"]
        return PIDDesign(k, ki, kd, b, min(touching, default=float("nan")), active, status)


def _size(x: Array) -> Array:
    """Return the scales of k, ki and kd."""
    k, ki, kd = x
    return np.array([max(abs(k), SMALLEST_GAIN * ki), ki, max(abs(kd), SMALLEST_GAIN * ki)])
