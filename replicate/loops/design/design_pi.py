r"""PI design by non-convex optimisation: the largest integral gain with a bounded sensitivity.

Maximise :math:`k_i` subject to :math:`|C + (k + k_i/s) G(s)| \ge R` on the imaginary axis and closed-loop stability.

For a fixed frequency the constraint forbids the interior of an ellipse in the (k, ki) plane; for a fixed k it forbids
an interval of ki at every frequency. What is left between the intervals are gaps, and inside a connected gap stability
cannot change, because the point -1 lies inside the circle. The design therefore looks at the upper ends of the gaps
over k, keeps the local maxima that are stable, and polishes each: tangency at one frequency by the equation h(w) = 0
(18), tangency at two frequencies (a corner of the envelope) by the four equations (15). Every solution is verified on
all frequencies.

Reference: Astrom, Panagopoulos and Hagglund, "Design of PI controllers based on non-convex optimization", Automatica 34
(1998) 585-601.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from replicate.loops import checks
from replicate.loops.controller import PI
from replicate.loops.design.circles import Circle
from replicate.loops.design.pi_maxima import Maximum, local_maxima
from replicate.loops.design.pi_result import PIDesign, Status
from replicate.loops.design.pi_tangency import closest_frequencies, corner_optimum, smooth_condition, smooth_optimum
from replicate.loops.design.setpoint_weights import setpoint_weight
from replicate.loops.errors import LoopError
from replicate.loops.frequency_domain.frequency_grids import design_grid
from replicate.loops.loop import Loop
from replicate.loops.plant import Plant
from replicate.loops.units import Units

Array = NDArray[np.float64]

SAME = 1e-7  # relative difference of the integral gains of two solutions that are one
PLAUSIBLE = 3.0  # factor between a maximum on the grid and the tangency that polishing makes of it
VERIFIED = 1e-9  # largest relative violation of the circle that is rounding and not a violation


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
    checks.instance("the plant of a design", plant, Plant, "a Plant")
    units = Units.of(plant)
    scaled = units.plant(plant)
    design = _mirrored(_design(-scaled, circle)) if scaled.gain_is_negative else _design(scaled, circle)
    return _in_units(design, units)


def _design(plant: Plant, circle: Circle) -> PIDesign:
    """Design for a plant of positive gain whose numbers are of the order of one."""
    problem = _Problem(plant, circle, design_grid(plant))
    solutions: list[PIDesign] = []
    for maximum in local_maxima(problem.value, circle, problem.w):
        if not problem.is_stable(maximum.k, maximum.inside):
            continue
        if maximum.open_end is not None and problem.is_stable(*maximum.open_end):
            return _none("unbounded")
        polished = problem.polished(maximum)
        if polished is not None and not any(abs(polished.ki - s.ki) <= SAME * s.ki for s in solutions):
            solutions.append(polished)
    if not solutions:
        return _none("no-controller")
    ordered = sorted(solutions, key=lambda s: -s.ki)
    ordered = [replace(s, b=problem.setpoint_weight(s)) for s in ordered]
    return replace(ordered[0], solutions=tuple(ordered))


def _in_units(design: PIDesign, units: Units) -> PIDesign:
    """Return a design made in its own units in those of the plant."""
    return replace(
        design,
        k=design.k / units.gain,
        ki=design.ki / (units.gain * units.time),
        frequency=design.frequency / units.time,
        frequencies=tuple(w / units.time for w in design.frequencies),
        solutions=tuple(_in_units(solution, units) for solution in design.solutions if solution is not design),
    )


def _mirrored(design: PIDesign) -> PIDesign:
    solutions = tuple(_mirrored(solution) for solution in design.solutions if solution is not design)
    return replace(design, k=-design.k, ki=-design.ki, solutions=solutions)


class _Problem:
    """A plant, a circle, and a grid of frequencies; a loop that is asked several questions is made once."""

    def __init__(self, plant: Plant, circle: Circle, w: Array) -> None:
        self.plant, self.circle, self.w = plant, circle, w
        self.value = plant(1j * w)
        self._loops: dict[tuple[float, float], Loop] = {}

    @cached_property
    def _smooth_condition(self) -> Array:
        return smooth_condition(self.plant, self.circle, self.w)

    def loop(self, k: float, ki: float) -> Loop:
        """Return the loop of a PI controller."""
        if (k, ki) not in self._loops:
            self._loops[k, ki] = Loop(self.plant, PI(k, ki))
        return self._loops[k, ki]

    def is_stable(self, k: float, ki: float) -> bool:
        """Whether a PI controller gives a stable loop."""
        try:
            return self.loop(k, ki).is_stable()
        except LoopError:  # too close to the limit of stability to be resolved: not a design
            return False

    def polished(self, found: Maximum) -> PIDesign | None:
        """Return the verified optimum near a maximum of the grid: smooth if one tangency explains it, else a corner."""
        smooth = smooth_optimum(self.plant, self.circle, self.w, self._smooth_condition, found.frequency)
        if smooth is not None and _plausible(smooth, found) and self._verified(smooth):
            return smooth
        closest = closest_frequencies(self.value, self.circle, self.w, found.k, found.ki)
        for pair in sorted({closest, (min(found.neighbours), max(found.neighbours))}):
            corner = corner_optimum(self.plant, self.circle, found.k, found.ki, *pair)
            if corner is not None and _plausible(corner, found) and self._verified(corner):
                return corner
        return None

    def _verified(self, design: PIDesign) -> bool:
        """Whether the loop is stable and outside the circle at all frequencies, not only at the tangency."""
        if design.ki <= 0.0 or not self.is_stable(design.k, design.ki):
            return False
        closest = self.loop(design.k, design.ki).closest_approach(self.circle.center)
        return closest.value * self.circle.radius <= 1.0 + VERIFIED

    def setpoint_weight(self, design: PIDesign) -> float:
        """Return the set-point weight of a design."""
        peak = self.loop(design.k, design.ki).complementary_peak()
        return setpoint_weight(self.plant, design.k, design.ki, at=(peak.frequency, peak.value))


def _plausible(design: PIDesign, found: Maximum) -> bool:
    return found.ki / PLAUSIBLE < design.ki < PLAUSIBLE * found.ki


def _none(status: Status) -> PIDesign:
    nan = float("nan")
    return PIDesign(nan, nan, nan, nan, (), "none", status)
