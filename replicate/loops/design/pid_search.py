"""The search behind PID design: from the summits of a map of feasible gains and from the PI design, uphill in ki.

The feasible set has ridges, and look-alikes behind the circle where the loop is unstable, so a single start is not to
be trusted. Each start is climbed by sequential quadratic programming on a frequency grid, or on the map itself where
gradients lead away from the summit, and finished by the optimality system.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from replicate.loops.design.gain_map import Summit, ascend, summits
from replicate.loops.design.nyquist_constraints import Kind, LoopJet
from replicate.loops.design.pid_optimality import NEARLY, GridProblem
from replicate.loops.design.pid_result import PIDDesign

Array = NDArray[np.float64]

HIGH, LOW = 0.8, 0.3  # of the best ki so far: lower summits are not worth a climb by the map, or none at all
SLACKS = (1e-4, 1e-3)  # distance that a climb keeps from the constraints, which dip a little between frequencies
FINE = 6  # grid frequencies for each, where the shape is followed closely
MOST_MAPS, LARGER = 3, 10.0  # how often, and by how much, a map is made larger
DENSITIES = (1, 3)  # of the map, and of the one that is made if the first shows nothing
THIN, VALLEY = 3, 2  # every third frequency is seen by a search, and these on each side of a valley
ROUNDS = 3  # how often a search sees more
ROUGH = 1e-2  # violation that a point may have from which the optimality conditions are met
NEAR, SAME = 3e-2, 1e-4  # relative difference of gains from an optimum, or another point, to which a search led again
SUMMITS = 4  # starts taken from the map of feasible gains
RUNAWAY = 1e5  # gains this many times the start's: the search has left the problem


class Search:
    """The search for the largest ki of one problem."""

    def __init__(self, problem: GridProblem) -> None:
        self.problem = problem
        self._found: list[tuple[Array, float, PIDDesign | None]] = []
        self._seen = [np.arange(grid.w.size) % THIN == 0 for grid in problem.grids]

    @cached_property
    def _jets(self) -> list[tuple[Kind, LoopJet]]:
        return [
            (constraint.kind, grid)
            for constraint, grid in zip(self.problem.constraints, self.problem.grids, strict=True)
        ]

    @cached_property
    def _fine_jets(self) -> list[tuple[Kind, LoopJet]]:
        """The constraints on a grid fine enough not to look through a cusp of the Nyquist curve."""
        fine = []
        for kind, grid in self._jets:
            steps = np.linspace(0.0, grid.w.size - 1.0, FINE * (grid.w.size - 1) + 1)
            w = np.exp(np.interp(steps, np.arange(grid.w.size), np.log(grid.w)))
            fine.append((kind, LoopJet.of(self.problem.plant, w)))
        return fine

    def summits(self, gain: float, frequency: float) -> list[Summit]:
        """Return the highest summits of the map of feasible gains that lie in stable country.

        The map is made larger while its highest summit lies on its edge, and denser while it shows none.
        """
        found: list[Summit] = []
        for _ in range(MOST_MAPS):
            for density in DENSITIES:
                found = self._stable_summits(gain, frequency, density)
                if found:
                    break
            on_edge = [s for s in found[:1] if s.on_edge(self.problem.largest_kd)]
            if not on_edge:
                break
            gain *= LARGER
        return found

    def _stable_summits(self, gain: float, frequency: float, density: int) -> list[Summit]:
        found: list[Summit] = []
        for summit in summits(self._jets, self.problem.circle, gain, frequency, self.problem.largest_kd, density):
            if len(found) == SUMMITS:
                break
            if self.problem.is_stable(np.array([summit.k, summit.inside, summit.kd])):
                found.append(summit)
        return found

    def best(self, starts: Sequence[tuple[float, float, float]], heights: Sequence[Summit]) -> PIDDesign | None:
        """Return the best design that summits and starts lead to.

        Two that agree settle it, if no summit is left that is higher.
        """
        best: PIDDesign | None = None
        left = list(heights)
        for where in [*heights[:1], *starts[:1], *heights[1:], *starts[1:]]:
            if isinstance(where, Summit):
                left.remove(where)
                if best is None or where.ki > HIGH * best.ki:
                    found = self.ascended(where)
                else:
                    found = self.climbed(where.gains) if where.ki > LOW * best.ki else None
            else:
                found = self.climbed(np.array(where))
            if found is None:
                continue
            agree = (
                best is not None and found.status == best.status == "optimal" and abs(found.ki / best.ki - 1.0) < 1e-8
            )
            if best is None or found.ki > best.ki:
                best = found
            if agree and all(summit.ki < best.ki for summit in left):
                break
        return best

    def ascended(self, summit: Summit) -> PIDDesign | None:
        """Return the design to which a summit leads; where gradients lead away from it, the map is climbed."""
        found = self.climbed(summit.gains)
        for slack in SLACKS:
            if found is not None and found.ki >= summit.ki:
                break
            fine = ascend(self._fine_jets, self.problem.circle, summit, slack, self.problem.largest_kd)
            higher = self.problem.finish(fine.gains, [jet for _, jet in self._fine_jets])
            found = max((d for d in (found, higher) if d is not None), key=lambda d: d.ki, default=None)
        return found

    def climbed(self, x: Array) -> PIDDesign | None:
        """Return the design to which a search from gains ``x`` leads.

        Where a rough search meets the optimality conditions, that is it. Else searches follow until ki no longer grows:
        a single one may stop short on a ridge.
        """
        rough = self._search(x, ROUGH)
        design = None if rough is None else self._finished(rough)
        if design is not None and design.status == "optimal":
            return design
        best: Array | None = None
        for shrink in (1.0, 0.6, 1.0, 1.0, 1.0):
            found = self._search((x if best is None else best) * np.array([1.0, shrink, 1.0]), NEARLY)
            if found is None:
                if best is None and shrink < 1.0:
                    return None
                continue
            if best is not None and found[1] <= best[1] * (1.0 + 1e-6):
                break
            if found[1] > RUNAWAY * x[1]:
                return None
            best = found
        return None if best is None else self._finished(best)

    def _finished(self, point: Array) -> PIDDesign | None:
        """Return the design near a point of the grid; of one that another search has found, what is known."""
        for at, reach, known in self._found:
            if np.all(np.abs(point - at) <= reach * np.abs(at)):
                return known
        design = self.problem.finish(point)
        if design is not None and design.status == "optimal":
            self._found.append((design.gains, NEAR, design))
        else:
            self._found.append((point, SAME, design))
        return design

    def _search(self, x: Array, tolerance: float) -> Array | None:
        """Return a local maximum on the grid to a tolerance, or None if the search ends infeasible.

        Few frequencies limit a design: the search sees every third one and the valleys of the constraints, and those
        that turn out to be violated.
        """
        point = x
        for _ in range(ROUNDS):
            self._seen = [part | self._valleys(i, point) for i, part in enumerate(self._seen)]
            grids = [grid.at(part) for grid, part in zip(self.problem.grids, self._seen, strict=True)]
            found = self._climbed(point, grids)
            if found is None:
                return None
            if self._lowest(found) >= -tolerance:
                return found
            point = found
        if tolerance > NEARLY:
            return None
        found = self._climbed(x, self.problem.grids)
        return None if found is None or self._lowest(found) < -tolerance else found

    def _lowest(self, x: Array) -> float:
        return min(float(self.problem.values(i, x)[0].min()) for i in range(len(self.problem.grids)))

    def _valleys(self, index: int, x: Array) -> NDArray[np.bool_]:
        """Return which frequencies lie in a valley of a constraint's value."""
        with np.errstate(all="ignore"):
            value = self.problem.values(index, x)[0]
        padded = np.concatenate([[np.inf], value, [np.inf]])
        low = np.nonzero((value <= padded[:-2]) & (value <= padded[2:]))[0]
        near = np.zeros(value.size, dtype=bool)
        near[np.clip(low[:, None] + np.arange(-VALLEY, VALLEY + 1), 0, value.size - 1)] = True
        return near

    def _climbed(self, x: Array, grids: Sequence[LoopJet]) -> Array | None:
        """Return where sequential quadratic programming leads to, seeing some frequencies only."""
        problem = self.problem
        scale = np.array([max(abs(x[0]), 1e-3 * x[1]), x[1], max(x[2], 0.3 * x[0] ** 2 / abs(x[1]))])
        limit = problem.largest_kd / scale[2]
        known: dict[bytes, tuple[Array, Array]] = {}

        def constraints(z: Array) -> tuple[Array, Array]:
            # asked for values and for gradients at the same point
            if z.tobytes() not in known:
                known.clear()
                parts = [problem.values(i, z * scale, grid) for i, grid in enumerate(grids)]
                known[z.tobytes()] = np.concatenate([p[0] for p in parts]), np.concatenate([p[1] for p in parts])
            return known[z.tobytes()]

        with np.errstate(all="ignore"):
            result = minimize(  # type: ignore[call-overload]  # the stubs want exact dict types, not literals
                lambda z: -z[1],
                x / scale,
                jac=lambda _: np.array([0.0, -1.0, 0.0]),
                constraints={
                    "type": "ineq", "fun": lambda z: constraints(z)[0], "jac": lambda z: constraints(z)[1] * scale
                },
                method="SLSQP",
                bounds=None if np.isinf(limit) else [(None, None), (None, None), (-limit, limit)],
                options={"maxiter": 100, "ftol": 1e-9},
            )  # fmt: skip
            if not np.all(np.abs(result.x) < RUNAWAY) or np.min(constraints(result.x)[0]) < -NEARLY:
                return None
        return np.asarray(result.x * scale)
