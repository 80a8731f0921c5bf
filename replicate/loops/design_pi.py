r"""PI design by non-convex optimisation: the largest integral gain with a bounded sensitivity.

Maximise :math:`k_i` subject to :math:`|C + (k + k_i/s) G(s)| \ge R` on the imaginary axis and closed-loop stability.

For a fixed frequency the constraint forbids the interior of an ellipse in the (k, ki) plane; for a fixed k it
forbids an interval of ki at every frequency. What is left between the intervals are gaps, and inside a connected gap
stability cannot
change, because the point -1 lies inside the circle. The design therefore looks at the upper ends of the gaps
over k, keeps
the local maxima that are stable, and polishes each: tangency at one frequency by the equation h(w) = 0 (18),
tangency at
two frequencies (a corner of the envelope) by the four equations (15). Every solution is verified on all frequencies.

Reference: Astrom, Panagopoulos and Hagglund, "Design of PI controllers based on non-convex optimization", Automatica 34
(1998) 585-601.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, root

from replicate.loops.circles import Circle
from replicate.loops.controller import PI
from replicate.loops.errors import LoopError
from replicate.loops.loop import Loop
from replicate.loops.plant import Plant
from replicate.loops.sensitivity import sensitivity_peak

Array = NDArray[np.float64]

Status = Literal["optimal", "no-controller", "unbounded"]

MESSAGES: dict[str, str] = {
    "optimal": "the largest integral gain that satisfies the constraint with a stable loop was found and verified",
    "no-controller": "no stabilising PI controller satisfies the constraint",
    "unbounded": "the integral gain can be raised without limit",
}

VERIFIED = 1e-9  # largest relative violation of the circle that is rounding and not a violation
GAIN_POINTS = 260
LARGEST_LAG = 4.0 * np.pi


@dataclass(frozen=True)
class PIDesign:
    """A PI controller and how it came about.

    Attributes
    ----------
    k, ki, b
        Gains and set-point weight (by `setpoint_weight`); ``nan`` if the status is not ``optimal``.
    frequency
        Where the Nyquist curve touches the circle (the lower one of two).
    frequencies
        All tangency frequencies: one in the smooth case, two at a corner.
    case
        ``smooth`` or ``corner``.
    status, message
        What happened, as a word and as a sentence.
    solutions
        All stable local solutions that satisfy the constraint everywhere, largest ki first.
    """

    k: float
    ki: float
    b: float
    frequency: float
    frequencies: tuple[float, ...]
    case: str
    status: Status
    solutions: tuple[PIDesign, ...] = ()

    @property
    def message(self) -> str:
        """The status as a sentence."""
        return MESSAGES[self.status]

    @property
    def integral_time(self) -> float:
        """Ti = k/ki."""
        return self.k / self.ki

    @property
    def controller(self) -> PI:
        """The controller itself."""
        return PI(self.k, self.ki, self.b)


def design_pi(plant: Plant, ms: float | None = None, mp: float | None = None) -> PIDesign:
    """Return the PI controller with the largest ki whose loop stays outside a circle and is stable.

    For a plant whose gain is negative, k and ki are those of the plant with its sign changed, times -1.

    Parameters
    ----------
    plant
        Rational with dead time, or given by a function.
    ms, mp
        Bounds > 1 on the sensitivity and the complementary sensitivity; with both, the combined circle is used.

    Raises
    ------
    LoopError
        If no bound is given or a bound is not greater than one. That no controller exists is not an error: see
        ``status``.

    Examples
    --------
    For a pure dead time the design is the same up to the time scale.

    >>> one, two = (design_pi(Plant([1.0], [1.0], dead_time=L), ms=1.4) for L in (1.0, 2.0))
    >>> bool(abs(one.k - two.k) < 1e-12 and abs(one.ki - 2 * two.ki) < 1e-12)
    True
    """
    circle = Circle.of(ms, mp)
    if gain_is_negative(plant):
        return _mirrored(design_pi(-plant, ms, mp))
    w = design_grid(plant)
    solutions: list[PIDesign] = []
    for maximum in _local_maxima(plant, circle, w):
        if not _stable(plant, maximum.k, maximum.inside):
            continue
        if maximum.open_end is not None and _stable(plant, *maximum.open_end):
            return _none("unbounded")
        polished = _polish(plant, circle, w, maximum)
        if polished is not None and not any(abs(polished.ki - s.ki) <= 1e-7 * s.ki for s in solutions):
            solutions.append(polished)
    if not solutions:
        return _none("no-controller")
    ordered = sorted(solutions, key=lambda s: -s.ki)
    ordered = [replace(s, b=setpoint_weight(plant, s.k, s.ki)) for s in ordered]
    return replace(ordered[0], solutions=tuple(ordered))


def gain_is_negative(plant: Plant) -> bool:
    """Whether only a negative ki can stabilise the plant: the characteristic function at s = 0 has the sign of ki G."""
    if plant.is_rational:
        return bool(plant.num[-1] < 0.0)  # the denominator is monic
    return bool(plant.delay_free(design_grid(plant)[0]).real < 0.0)


def _mirrored(design: PIDesign) -> PIDesign:
    solutions = tuple(_mirrored(solution) for solution in design.solutions if solution is not design)
    return replace(design, k=-design.k, ki=-design.ki, solutions=solutions)


def setpoint_weight(plant: Plant, k: float, ki: float, *, at: tuple[float, float] | None = None) -> float:
    """Return the set-point weight b in [0, 1] that makes |G_sp| = 1 at a frequency (25).

    Parameters
    ----------
    at
        (frequency, |T| there); by default the peak of the complementary sensitivity, as the paper's text says (24).
    """
    if k * ki <= 0.0:
        return 0.0
    if at is None:
        peak = Loop(plant, PI(k, ki)).complementary_peak()
        at = (peak.frequency, peak.value)
    w, m = at
    if m <= 1.0 or w == 0.0:
        return 1.0
    inside = (k * w) ** 2 - ki**2 * (m**2 - 1.0)
    return min(1.0, float(np.sqrt(inside) / (abs(k) * w * m))) if inside >= 0.0 else 0.0


def smooth_condition(plant: Plant, circle: Circle, w: Array) -> Array:
    """Evaluate h(w) / (2 R) of (18); a smooth optimum is a root of it."""
    value = plant(1j * w)
    slope = 1j * plant.log_derivative(1j * w)  # d log G / d w = r'/r + i phi'
    phase = np.angle(value)
    h = (circle.radius + circle.center * np.sin(phase)) * (slope.real - 1.0 / w) - circle.center * slope.imag * np.cos(
        phase
    )
    return np.asarray(h)


def smooth_gains(plant: Plant, circle: Circle, w: float) -> tuple[float, float]:
    """Return (k, ki) of the lowest vertex of the ellipse at a frequency (17)."""
    value = complex(plant(1j * w))
    r, phase = abs(value), np.angle(value)
    return (
        float(-circle.center * np.cos(phase) / r),
        float(-w / r * (circle.center * np.sin(phase) + circle.radius)),
    )


def design_grid(plant: Plant) -> Array:
    """Return the frequencies on which a design looks for its optimum, before polishing."""
    if plant.is_rational:
        corners = np.abs(np.concatenate([plant.poles(), plant.zeros()]))
        corners = corners[corners > 0.0]
    else:
        corners = np.array([1e-1, 1e2])
    if plant.dead_time:
        corners = np.append(corners, 1.0 / plant.dead_time)
    if corners.size == 0:
        corners = np.array([1.0])
    low, high = 2e-3 * corners.min(), 1e3 * corners.max()
    parts = [np.geomspace(low, high, int(70 * np.log10(high / low)))]
    if plant.dead_time:
        step = np.pi / (24.0 * plant.dead_time)
        parts.append(np.arange(1, 24 * 12) * step)
    resonant = [p for p in plant.poles() if p.imag > 0.0 and abs(p.real) < 0.3 * abs(p)] if plant.is_rational else []
    spread = np.concatenate([-np.geomspace(20.0, 0.1, 10), [0.0], np.geomspace(0.1, 20.0, 10)])
    parts += [p.imag + max(abs(p.real), 1e-9 * abs(p)) * spread for p in resonant]
    grid = np.unique(np.concatenate(parts))
    grid = grid[grid > 0.0]
    # two turns of the plant's own phase are more than a PI controller can make use of
    phase = np.unwrap(np.angle(plant(1j * grid)))
    beyond = np.nonzero(phase < phase[0] - LARGEST_LAG)[0]
    return grid[: beyond[0]] if beyond.size else grid


@dataclass(frozen=True)
class _Maximum:
    """The upper end ``ki`` of a gap at ``k`` that no connected gap exceeds; ``inside`` is a ki in the gap."""

    k: float
    ki: float
    inside: float
    frequency: float
    neighbours: tuple[float, ...]  # frequencies of the bounds at k and at the neighbouring gains
    open_end: tuple[float, float] | None  # (k, ki) in a connected gap without upper end: ki may grow on there


def _local_maxima(plant: Plant, circle: Circle, w: Array) -> list[_Maximum]:
    value = plant(1j * w)
    r, phase = np.abs(value), np.angle(value)
    c, s = circle.center * np.cos(phase), circle.center * np.sin(phase)
    gains = _gain_grid(np.concatenate([-c / r, (-c - circle.radius) / r, (-c + circle.radius) / r]), r)
    # the forbidden interval of ki at each (k, w): (r ki / w + C sin phi)^2 < R^2 - (r k + C cos phi)^2
    inside = circle.radius**2 - (gains[:, None] * r + c) ** 2
    half = np.sqrt(np.maximum(inside, 0.0))
    high = np.where(inside > 0.0, (half - s) * (w / r), -np.inf)
    low = np.where(high > 0.0, (-half - s) * (w / r), np.inf)
    order = np.argsort(low, axis=1)
    low = np.take_along_axis(low, order, axis=1)
    covered = np.maximum.accumulate(np.take_along_axis(high, order, axis=1), axis=1)
    floor = np.zeros_like(low)
    floor[:, 1:] = np.maximum(covered[:, :-1], 0.0)
    rows, columns = np.nonzero((low > floor * (1.0 + 1e-12)) & np.isfinite(low))
    gaps: list[list[tuple[float, float, float]]] = [[] for _ in gains]
    for i, j in zip(rows.tolist(), columns.tolist(), strict=True):
        gaps[i].append((float(floor[i, j]), float(low[i, j]), float(w[order[i, j]])))
    uppermost = np.maximum(covered[:, -1], 0.0)
    found = []
    for i, row in enumerate(gaps):
        around = [g for j in (i - 1, i + 1) if 0 <= j < len(gaps) for g in gaps[j]]
        for bottom, top, frequency in row:
            connected = [g for g in around if g[0] < top and g[1] > bottom]
            if all(top >= g[1] for g in connected):
                middle = 0.5 * (max([bottom, *(g[0] for g in connected)]) + top)
                neighbours = (frequency, *(g[2] for g in connected))
                opened = [j for j in (i - 1, i + 1) if 0 <= j < len(gaps) and top > uppermost[j]]
                open_end = (float(gains[opened[-1]]), 2.0 * top) if opened else None
                if i == len(gaps) - 1 and connected:  # the end of the gain grid is no maximum either
                    open_end = (float(gains[i]), middle)
                found.append(_Maximum(float(gains[i]), top, middle, frequency, neighbours, open_end))
    return found


def _gain_grid(loci: Array, r: Array) -> Array:
    """Return gains dense where the vertices of the ellipses are, on an asinh scale."""
    unit = 0.01 / float(np.exp(np.median(np.log(r[: max(1, r.size // 2)]))))
    finite = loci[np.isfinite(loci) & (np.abs(loci) < 1e8 * unit)]
    mapped = np.unique(np.arcsinh(finite / unit))
    even = np.linspace(mapped[0], mapped[-1], GAIN_POINTS // 2)
    quantiles = np.quantile(mapped, np.linspace(0.0, 1.0, GAIN_POINTS // 2))
    return np.asarray(np.unique(np.sinh(np.concatenate([even, quantiles, [0.0]])) * unit))


def _polish(plant: Plant, circle: Circle, w: Array, found: _Maximum) -> PIDesign | None:
    """Return the verified optimum near a maximum of the grid: smooth if one tangency explains it, else a corner."""
    smooth = _smooth(plant, circle, w, found.frequency)
    if smooth is not None and _plausible(smooth, found) and _verified(plant, circle, smooth):
        return smooth
    pairs = {_closest(plant, circle, w, found.k, found.ki), (min(found.neighbours), max(found.neighbours))}
    for pair in sorted(pairs):
        corner = _corner(plant, circle, found.k, found.ki, *pair)
        if corner is not None and _plausible(corner, found) and _verified(plant, circle, corner):
            return corner
    return None


def _plausible(design: PIDesign, found: _Maximum) -> bool:
    return 0.3 * found.ki < design.ki < 3.0 * found.ki


def _smooth(plant: Plant, circle: Circle, w: Array, near: float) -> PIDesign | None:
    h = smooth_condition(plant, circle, w)
    changes = np.nonzero((h[:-1] > 0.0) & (h[1:] < 0.0))[0]
    if changes.size == 0:
        return None
    index = changes[np.argmin(np.abs(np.log(w[changes] / near)))]

    def condition(x: float) -> float:
        return float(smooth_condition(plant, circle, np.array([x]))[0])

    frequency = float(brentq(condition, w[index], w[index + 1], xtol=1e-300, rtol=8.9e-16, maxiter=200))
    k, ki = smooth_gains(plant, circle, frequency)
    return PIDesign(k, ki, float("nan"), frequency, (frequency,), "smooth", "optimal")


def _closest(plant: Plant, circle: Circle, w: Array, k: float, ki: float) -> tuple[float, float]:
    """Return the two frequencies at which the Nyquist curve comes closest to the circle's center, ascending."""
    distance = np.abs(circle.center + (k - 1j * ki / w) * plant(1j * w))
    inner = np.nonzero((distance[1:-1] <= distance[:-2]) & (distance[1:-1] <= distance[2:]))[0] + 1
    closest = np.sort(inner[np.argsort(distance[inner])][:2])
    return (float(w[closest[0]]), float(w[closest[-1]])) if closest.size else (0.0, 0.0)


def _corner(plant: Plant, circle: Circle, k: float, ki: float, w1: float, w2: float) -> PIDesign | None:
    """Solve the four equations (15) for two tangencies by Newton's method, all unknowns scaled to one."""
    if not (w2 > w1 * (1.0 + 1e-6) and ki > 0.0):
        return None
    scale = np.array([max(abs(k), 1e-3 * ki / w2), ki, w1, w2])

    def equations(x: Array) -> Array:
        gain, integral, *frequencies = x * scale
        result = []
        for frequency in frequencies:
            s = 1j * frequency
            controller = gain + integral / s
            value = controller * complex(plant(s))
            slope = 1j * value * (complex(plant.log_derivative(s)) - integral / (s**2 * controller))
            offset = circle.center + value
            result += [abs(offset) ** 2 / circle.radius**2 - 1.0, frequency * (np.conj(offset) * slope).real]
        return np.array(result)

    with np.errstate(all="ignore"):  # a start that is no corner may wander off; the residual tells
        solution = root(equations, np.array([k, ki, w1, w2]) / scale, method="hybr", options={"xtol": 1e-15})
    if not np.max(np.abs(solution.fun)) <= 1e-9:
        return None
    gain, integral, first, second = (float(v) for v in solution.x * scale)
    if integral <= 0.0 or first <= 0.0 or second <= 0.0 or abs(first / second - 1.0) < 1e-6:
        return None
    first, second = sorted((first, second))
    return PIDesign(gain, integral, float("nan"), first, (first, second), "corner", "optimal")


def _verified(plant: Plant, circle: Circle, design: PIDesign) -> bool:
    """Whether the loop is stable and outside the circle at all frequencies, not only at the tangency."""
    if design.ki <= 0.0 or not _stable(plant, design.k, design.ki):
        return False
    loop = Loop(plant, PI(design.k, design.ki))
    inverse = sensitivity_peak(loop.transfer, loop.poles(), circle.center)
    return inverse.value * circle.radius <= 1.0 + VERIFIED


def _stable(plant: Plant, k: float, ki: float) -> bool:
    try:
        return Loop(plant, PI(k, ki)).is_stable()
    except LoopError:  # too close to the limit of stability to be resolved: not a design
        return False


def _none(status: Status) -> PIDesign:
    nan = float("nan")
    return PIDesign(nan, nan, nan, nan, (), "none", status)
