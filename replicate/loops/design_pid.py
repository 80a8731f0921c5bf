r"""PID design by constrained optimisation: the largest integral gain of a robust and well-shaped loop.

Maximise :math:`k_i` over (k, ki, kd) subject to the sensitivity circle, negative curvature and negative phase
slope of the Nyquist curve, each on its frequency range, and closed-loop stability.

The search is local (sequential quadratic programming on a frequency grid) from several starts, the PI design
among them,
because the feasible set has ridges and look-alikes behind the circle where the loop is unstable. What it finds
is finished
by Newton's method on the optimality system of the semi-infinite problem: every active constraint touches zero
at its own
frequency, where it is stationary, and the gradient of ki is a combination of the active gradients with positive
multipliers. Each result is verified on all frequencies and for stability.

Reference: Panagopoulos, thesis (2000), paper II and its supplement, (5) and section 4.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize, minimize_scalar, nnls, root

from replicate.loops.circles import Circle
from replicate.loops.controller import PI, PID
from replicate.loops.design_pi import design_grid, design_pi, gain_is_negative
from replicate.loops.errors import LoopError
from replicate.loops.gain_map import Summit, ascend, summits
from replicate.loops.loop import Loop
from replicate.loops.nyquist_constraints import Constraint, Kind, LoopJet
from replicate.loops.plant import Plant
from replicate.loops.sensitivity import sensitivity_peak

Array = NDArray[np.float64]

Status = Literal["optimal", "not-polished", "no-controller", "unbounded"]

MESSAGES: dict[str, str] = {
    "optimal": "the optimality conditions hold to rounding and all constraints were verified on all frequencies",
    "not-polished": "a feasible and stable point was found, but the optimality system did not converge to it",
    "no-controller": "no stabilising controller that satisfies the constraints was found",
    "unbounded": "the integral gain can be raised without limit: nothing in the plant bounds its bandwidth",
}

DERIVATIVE_STARTS = (0.0, 0.3, 0.8, 1.8)  # kd of the starts, in units of k / (frequency of the PI design)
CAUTIOUS = 0.1  # ki of the second round of starts, in units of that of the first
NEARLY = 1e-5  # violation that a point found on the grid may have between its grid frequencies
TOUCHING_FIRST = 100.0  # weight of a constraint's value against its gradient when the active ones are chosen
LOST = 0.02  # of ki, between a point on the grid and the optimum near it
MOST_EVALUATIONS = 500  # of the optimality system: from a good start it converges in a few dozen
HIGH, LOW = 0.8, 0.3  # of the best ki so far: lower summits are not worth a climb by the map, or none at all
SLACKS = (1e-4, 1e-3)  # distance that a climb keeps from the constraints, which dip a little between frequencies
FINE = 6  # grid frequencies for each, where the shape is followed closely
MOST_MAPS, LARGER = 3, 10.0  # how often, and by how much, a map is made larger
DENSITIES = (1, 3)  # of the map, and of the one that is made if the first shows nothing
SUMMITS = 4  # starts taken from the map of feasible gains
FEASIBLE = 2e-9
SAME_TOUCH = 0.06  # touches closer than this relative distance in frequency are one
RUNAWAY = 1e5  # gains this many times the start's: the search has left the problem


@dataclass(frozen=True)
class ActiveConstraint:
    """A constraint that limits the design: its kind, the frequency at which it touches, and its multiplier.

    The multiplier is the relative growth of ki per unit by which the constraint is relaxed.
    """

    kind: Kind
    frequency: float
    multiplier: float


@dataclass(frozen=True)
class PIDDesign:
    """A PID controller and how it came about.

    Attributes
    ----------
    k, ki, kd, b
        Gains and set-point weight (by `pid_setpoint_weight`); ``nan`` if there is no controller.
    frequency
        Where the Nyquist curve touches the circle (the lowest frequency, if several).
    active
        The active constraints with frequencies and multipliers.
    status, message
        What happened, as a word and as a sentence.
    """

    k: float
    ki: float
    kd: float
    b: float
    frequency: float
    active: tuple[ActiveConstraint, ...]
    status: Status

    @property
    def message(self) -> str:
        """The status as a sentence."""
        return MESSAGES[self.status]

    @property
    def integral_time(self) -> float:
        """Ti = k/ki."""
        return self.k / self.ki

    @property
    def derivative_time(self) -> float:
        """Td = kd/k."""
        return self.kd / self.k

    @property
    def controller(self) -> PID:
        """The controller itself, with ideal derivative of the measurement."""
        return PID(self.k, self.ki, self.kd, b=self.b)


def design_pid(
    plant: Plant,
    ms: float | None = None,
    mp: float | None = None,
    constraints: Sequence[Constraint | Literal["curvature", "phase"]] | None = None,
    *,
    start: tuple[float, float, float] | None = None,
) -> PIDDesign:
    """Return the PID controller with the largest ki that satisfies the constraints with a stable loop.

    For a plant whose gain is negative, the gains are those of the plant with its sign changed, times -1.

    Parameters
    ----------
    plant
        Rational with dead time, or given by a function. Multiply a measurement filter into it.
    ms, mp
        Bounds > 1 on the sensitivity and the complementary sensitivity; with both, the combined circle is used.
    constraints
        Besides the circle: ``"curvature"``, ``"phase"``, or `Constraint` records with their own range and
        margin. A bare
        name is asked for on `search_range`. Default: both, without curvature for integrating plants, for which
        it is too severe. An empty sequence leaves the circle alone.
    start
        Gains (k, ki, kd) to start from besides the usual starts.

    Raises
    ------
    LoopError
        If no bound is given, a constraint is unknown, or the plant's output jumps with its input, which no ideal
        derivative can act on. That no controller is found is not an error: see ``status``.

    Examples
    --------
    >>> pid = design_pid(Plant([1.0], [1.0, 4.0, 6.0, 4.0, 1.0]), ms=1.4)
    >>> pid.status, [part.kind for part in pid.active]
    ('optimal', ['sensitivity', 'curvature'])
    >>> round(Loop(Plant([1.0], [1.0, 4.0, 6.0, 4.0, 1.0]), pid.controller).sensitivity_peak(), 9)
    1.4
    """
    circle = Circle.of(ms, mp)
    if gain_is_negative(plant):
        mirrored = None if start is None else (-start[0], -start[1], -start[2])
        found = design_pid(-plant, ms, mp, constraints, start=mirrored)
        return replace(found, k=-found.k, ki=-found.ki, kd=-found.kd)
    if plant.is_rational and plant.num.size == plant.den.size:
        msg = "the plant's output jumps with its input: multiply a measurement filter into the plant to design a PID"
        raise LoopError(msg)
    pi = design_pi(plant, ms, mp)
    shape: Sequence[Constraint | str] = ("phase",) if plant.integrators else ("curvature", "phase")
    asked = [Constraint("sensitivity")]
    asked += [_constraint(plant, pi.k, pi.ki, item) for item in (shape if constraints is None else constraints)]
    if _bandwidth_is_free(plant, shaped=len(asked) > 1):
        return _none("unbounded")
    problem = _Problem(plant, circle, tuple(asked))
    starts, gain, frequency = _starts(plant, pi.k, pi.ki, pi.frequency, start)
    # severe constraints may leave room only far below the ki of the PI design, out of reach from its side
    cautious = [(k, CAUTIOUS * ki, kd) for k, ki, kd in starts]
    best = problem.best(starts, problem.summits(gain, frequency)) or problem.best(cautious, [])
    return best or _none("no-controller")


def search_range(plant: Plant, k: float, ki: float) -> tuple[float, float]:
    """Return the frequencies between which the thesis asks for the shape of the Nyquist curve.

    Half the frequency of the PI design's sensitivity peak, to the middle between the frequencies at which that loop has
    phases of -180 and -270 degrees; ``inf`` where it never gets there.
    """
    loop = Loop(plant, PI(k, ki))
    low = 0.5 * loop.sensitivity_peak().frequency
    w = design_grid(plant)
    phase = np.unwrap(np.angle(loop(1j * w)))
    phase -= 2.0 * np.pi * np.round((phase[0] + 0.5 * np.pi * (1 + plant.integrators)) / (2.0 * np.pi))
    reached = []
    for angle in (-np.pi, -1.5 * np.pi):
        below = np.nonzero(phase < angle)[0]
        if below.size == 0 or below[0] == 0:
            return low, float("inf")
        i = below[0]
        share = (angle - phase[i - 1]) / (phase[i] - phase[i - 1])
        reached.append(w[i - 1] * (w[i] / w[i - 1]) ** share)
    return low, float(0.5 * (reached[0] + reached[1]))


def pid_setpoint_weight(controller: PID, frequency: float, peak: float) -> float:
    """Return the set-point weight b in [0, 1] for which |G_sp| is one where |T| has its peak (13).

    Parameters
    ----------
    frequency, peak
        Frequency and value of the complementary sensitivity peak; a peak at rest puts no bound and gives 1.
    """
    if controller.k * controller.ki <= 0.0:
        return 0.0
    if peak <= 1.0 or frequency == 0.0:
        return 1.0
    size = (controller.k * frequency) ** 2 + (controller.ki - frequency**2 * controller.kd) ** 2
    inside = size - (controller.ki * peak) ** 2
    return min(1.0, float(np.sqrt(inside) / (abs(controller.k) * frequency * peak))) if inside > 0.0 else 0.0


def _bandwidth_is_free(plant: Plant, *, shaped: bool) -> bool:
    """Whether high gain is known to be stable and robust: no dead time, no zeros to the right, at most two more poles.

    Two zeros of the controller on the plant's poles then leave L = const/s, whose gain is free; that holds for the
    shape constraints, too, if the plant is no more than two poles.
    """
    if not plant.is_rational or plant.dead_time or plant.den.size - plant.num.size > 2 or plant.num[0] < 0.0:
        return False
    return plant.den.size <= 3 and plant.num.size == 1 if shaped else bool(np.all(plant.zeros().real < 0.0))


def _none(status: Status) -> PIDDesign:
    nan = float("nan")
    return PIDDesign(nan, nan, nan, nan, nan, (), status)


def _constraint(plant: Plant, k: float, ki: float, item: Constraint | str) -> Constraint:
    if isinstance(item, Constraint):
        return item
    if item not in ("curvature", "phase"):
        msg = f"constraint '{item}' is unknown; allowed: 'curvature', 'phase', or a Constraint"
        raise LoopError(msg)
    low, high = search_range(plant, k, ki) if np.isfinite(ki) else (0.0, float("inf"))
    return Constraint("curvature" if item == "curvature" else "phase", low, high)


def _starts(
    plant: Plant, k: float, ki: float, frequency: float, start: tuple[float, float, float] | None
) -> tuple[list[tuple[float, float, float]], float, float]:
    """Return gains to start from, and the scale of k and of frequency."""
    if not np.isfinite(ki):  # no PI controller: start from gains of the plant's own scale
        w = design_grid(plant)
        frequency = float(np.sqrt(w[0] * w[-1]))
        k = 1.0 / float(abs(complex(plant(1j * frequency))))
        ki = 0.1 * k * frequency
    size = max(abs(k), 0.2 * ki / frequency)
    starts = [] if start is None else [start]
    first, *rest = [(k, ki, share * size / frequency) for share in DERIVATIVE_STARTS]
    # a loop that lives on its derivative action is far from the PI design; severe constraints can push the optimum
    # there
    far = (0.1 * k, 0.3 * ki, 1.8 * size / frequency)
    return [*starts, first, far, *rest], size, frequency


class _Problem:
    """The semi-infinite problem on a frequency grid, in gains scaled to one."""

    def __init__(self, plant: Plant, circle: Circle, constraints: tuple[Constraint, ...]) -> None:
        self.plant = plant
        self.circle = circle
        self.constraints = constraints
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

    @cached_property
    def _jets(self) -> list[tuple[Kind, LoopJet]]:
        return [(constraint.kind, grid) for constraint, grid in zip(self.constraints, self.grids, strict=True)]

    @cached_property
    def _fine_jets(self) -> list[tuple[Kind, LoopJet]]:
        """The constraints on a grid fine enough not to look through a cusp of the Nyquist curve."""
        fine = []
        for kind, grid in self._jets:
            steps = np.linspace(0.0, grid.w.size - 1.0, FINE * (grid.w.size - 1) + 1)
            w = np.exp(np.interp(steps, np.arange(grid.w.size), np.log(grid.w)))
            fine.append((kind, LoopJet.of(self.plant, w)))
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
            on_edge = [s for s in found[:1] if s.on_edge(self.largest_kd)]
            if not on_edge:
                break
            gain *= LARGER
        return found

    def _stable_summits(self, gain: float, frequency: float, density: int) -> list[Summit]:
        found: list[Summit] = []
        for summit in summits(self._jets, self.circle, gain, frequency, self.largest_kd, density):
            if len(found) == SUMMITS:
                break
            if self._stable(np.array([summit.k, summit.inside, summit.kd])):
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
            fine = ascend(self._fine_jets, self.circle, summit, slack, self.largest_kd)
            higher = self.finish(fine.gains)
            found = max((d for d in (found, higher) if d is not None), key=lambda d: d.ki, default=None)
        return found

    def climbed(self, x: Array) -> PIDDesign | None:
        """Return the design to which a search from gains ``x`` leads."""
        point = self.climb(x)
        return None if point is None else self.finish(point)

    def climb(self, x: Array) -> Array | None:
        """Search again from what was found until ki no longer grows: a single run may stop short on a ridge."""
        best: Array | None = None
        first = x[1]
        for shrink in (1.0, 0.6, 1.0, 1.0, 1.0):
            found = self._search(x * np.array([1.0, shrink, 1.0]))
            if found is None:
                continue
            if best is not None and found[1] <= best[1] * (1.0 + 1e-6):
                break
            if found[1] > RUNAWAY * first:
                return None
            best = x = found
        return best

    def _search(self, x: Array) -> Array | None:
        """Return a local maximum on the grid by sequential quadratic programming, or None if it ends infeasible."""
        frequency = abs(x[1] / x[0]) if x[0] else 1.0
        scale = np.array([max(abs(x[0]), 1e-3 * x[1]), x[1], max(x[2], 0.3 * abs(x[0]) / max(frequency, 1e-12))])

        limit = self.largest_kd / scale[2]

        def values(z: Array) -> Array:
            return np.concatenate([self._values(i, z * scale)[0] for i in range(len(self.grids))])

        def gradients(z: Array) -> Array:
            return np.concatenate([self._values(i, z * scale)[1] * scale for i in range(len(self.grids))])

        with np.errstate(all="ignore"):
            result = minimize(  # type: ignore[call-overload]  # the stubs want exact dict types, not literals
                lambda z: -z[1],
                x / scale,
                jac=lambda _: np.array([0.0, -1.0, 0.0]),
                constraints={"type": "ineq", "fun": values, "jac": gradients},
                method="SLSQP",
                bounds=None if np.isinf(limit) else [(None, None), (None, None), (-limit, limit)],
                options={"maxiter": 100, "ftol": 1e-11},
            )
            if not np.all(np.abs(result.x) < RUNAWAY) or np.min(values(result.x)) < -NEARLY:
                return None
        return np.asarray(result.x * scale)

    def _values(self, index: int, x: Array) -> tuple[Array, Array]:
        constraint = self.constraints[index]
        value, gradient = self.grids[index].values(constraint.kind, self.circle, x, constraint.margin)
        # far from zero the exact size does not matter, and large numbers would only harm the quadratic subproblem
        squash = 1.0 / (1.0 + np.abs(value))
        return value * squash, gradient * (squash**2)[:, None]

    def _at_infinity(self, x: Array) -> tuple[float, Array]:
        """Return value and gradient of the sensitivity constraint at infinite frequency."""
        distance = self.circle.center - abs(x[2]) * self.edge
        slope = -2.0 * distance * self.edge * np.sign(x[2]) / self.circle.radius**2
        return distance**2 / self.circle.radius**2 - 1.0, np.array([0.0, 0.0, slope])

    def finish(self, x: Array) -> PIDDesign | None:
        """Return the verified design near a grid optimum, polished if the optimality system converges."""
        active: list[ActiveConstraint] = []
        for preference in (TOUCHING_FIRST, 0.0):
            active = self._active(x, preference)
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

    def _active(self, x: Array, preference: float) -> list[ActiveConstraint]:
        """Return the touching points with positive multipliers, from a non-negative fit of the gradient.

        ``preference`` weighs against points that come close to zero but do not touch it.
        """
        candidates: list[tuple[int, float, Array, float]] = []
        for index, grid in enumerate(self.grids):
            value, gradient = self._values(index, x)
            edge = np.concatenate([[np.inf], value, [np.inf]])
            low = np.nonzero((value <= edge[:-2]) & (value <= edge[2:]) & (value < 5e-3))[0]
            candidates += [(index, float(grid.w[i]), gradient[i], abs(float(value[i]))) for i in low]
        if abs(x[2]) > self.largest_kd * (1.0 - 2e-3):
            value_at_edge, gradient_at_edge = self._at_infinity(x)
            candidates.append((0, float("inf"), gradient_at_edge, abs(value_at_edge)))
        if not candidates:
            return []
        scale = np.array([max(abs(x[0]), 1e-6 * x[1]), x[1], max(abs(x[2]), 1e-6 * x[1])])
        matrix = np.array([[*(gradient * scale), preference * value] for _, _, gradient, value in candidates]).T
        # at a maximum the gradient of ki is minus a positive combination of the active gradients
        multipliers, residual = nnls(matrix, np.array([0.0, -1.0, 0.0, 0.0]))
        if residual > 0.3:
            return []
        active: list[ActiveConstraint] = []
        for (index, touch, *_), multiplier in zip(candidates, multipliers, strict=True):
            kind, frequency, weight = self.constraints[index].kind, touch, float(multiplier)
            if weight <= 1e-6:
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
        size = np.array([max(abs(x[0]), 1e-6 * x[1]), x[1], max(abs(x[2]), 1e-6 * x[1])])
        kinds = [next(c for c in self.constraints if c.kind == part.kind) for part in active]
        fixed = [part.frequency in (kind.low, kind.high) for part, kind in zip(active, kinds, strict=True)]
        touches = np.array([part.frequency for part in active])
        finite = np.where(np.isinf(touches), 1.0, touches)
        start = np.concatenate([x / size, np.zeros(len(active)), [part.multiplier for part in active]])

        def equations(z: Array) -> Array:
            gains = z[:3] * size
            logs, multipliers = z[3 : 3 + len(active)], z[3 + len(active) :]
            jet = LoopJet.of(self.plant, finite * np.exp(logs), order=3)
            balance = np.array([0.0, 1.0, 0.0])  # gradient of ki, in scaled gains
            rows = []
            for n, (kind, at_end) in enumerate(zip(kinds, fixed, strict=True)):
                if np.isinf(touches[n]):
                    value_at_edge, gradient_at_edge = self._at_infinity(gains)
                    balance = balance + multipliers[n] * gradient_at_edge * size
                    rows += [value_at_edge, logs[n]]
                    continue
                one = LoopJet(jet.w[n : n + 1], jet.phi[:, :, n : n + 1])
                value, gradient = one.values(kind.kind, self.circle, gains, kind.margin)
                balance = balance + multipliers[n] * gradient[0] * size
                rows += [value[0], logs[n] if at_end else one.slopes(kind.kind, self.circle, gains)[0]]
            return np.concatenate([balance, rows])

        with np.errstate(all="ignore"):
            solution = root(  # type: ignore[call-overload]  # as above
                equations, start, method="hybr", options={"xtol": 1e-14, "maxfev": MOST_EVALUATIONS}
            )
        if not np.max(np.abs(solution.fun)) < 1e-9:
            return None
        gains = solution.x[:3] * size
        frequencies = [part.frequency * float(np.exp(s)) for part, s in zip(active, solution.x[3:], strict=False)]
        multipliers = solution.x[3 + len(active) :] * size[1] / gains[1]  # relative to the ki that was found
        if np.any(multipliers <= 0.0) or not 0.5 < gains[1] / x[1] < 2.0:
            return None
        parts = [
            ActiveConstraint(part.kind, w, float(m))
            for part, w, m in zip(active, frequencies, multipliers, strict=True)
        ]
        order = {"sensitivity": 0, "curvature": 1, "phase": 2}
        return gains, tuple(sorted(parts, key=lambda p: (order[p.kind], p.frequency)))

    def _verified(self, x: Array, tolerance: float = FEASIBLE) -> bool:
        """Whether the loop is stable and no constraint is violated between the grid frequencies either."""
        if x[1] <= 0.0:
            return False
        try:
            loop = Loop(self.plant, PID(*x))
            if not loop.is_stable():
                return False
            inverse = sensitivity_peak(loop.transfer, loop.poles(), self.circle.center)
        except LoopError:
            return False
        if inverse.value * self.circle.radius > 1.0 + tolerance:
            return False
        return all(
            self._lowest(index, x) >= -tolerance for index, c in enumerate(self.constraints) if c.kind != "sensitivity"
        )

    def _stable(self, x: Array) -> bool:
        try:
            return Loop(self.plant, PID(*x)).is_stable()
        except LoopError:
            return False

    def _lowest(self, index: int, x: Array) -> float:
        """Return the smallest value of a constraint on its range, polished between grid points."""
        constraint, w = self.constraints[index], self.grids[index].w

        def value(log_w: float) -> float:
            jet = LoopJet.of(self.plant, np.array([np.exp(log_w)]))
            return float(jet.values(constraint.kind, self.circle, x, constraint.margin)[0][0])

        values = self.grids[index].values(constraint.kind, self.circle, x, constraint.margin)[0]
        lowest = float(values.min())
        inner = np.nonzero((values[1:-1] <= values[:-2]) & (values[1:-1] <= values[2:]) & (values[1:-1] < 0.05))[0] + 1
        for i in inner:
            found = minimize_scalar(
                value, bounds=(np.log(w[i - 1]), np.log(w[i + 1])), method="bounded", options={"xatol": 1e-10}
            )
            lowest = min(lowest, float(found.fun))
        return lowest

    def _design(self, x: Array, active: tuple[ActiveConstraint, ...], status: Status) -> PIDDesign:
        k, ki, kd = (float(v) for v in x)
        peak = Loop(self.plant, PID(k, ki, kd)).complementary_peak()
        b = pid_setpoint_weight(PID(k, ki, kd), peak.frequency, peak.value)
        touching = [part.frequency for part in active if part.kind == "sensitivity"]
        return PIDDesign(k, ki, kd, b, min(touching, default=float("nan")), active, status)
