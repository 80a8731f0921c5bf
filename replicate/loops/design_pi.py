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

import numpy as np
from numpy.typing import NDArray

from replicate.loops import checks
from replicate.loops.circles import Circle
from replicate.loops.controller import PI
from replicate.loops.errors import LoopError
from replicate.loops.frequency_grids import design_grid
from replicate.loops.loop import Loop
from replicate.loops.pi_maxima import Maximum, local_maxima
from replicate.loops.pi_result import PIDesign, Status
from replicate.loops.pi_tangency import closest_frequencies, corner_optimum, smooth_optimum
from replicate.loops.plant import Plant
from replicate.loops.sensitivity import sensitivity_peak
from replicate.loops.setpoint_weights import setpoint_weight
from replicate.loops.units import Units

Array = NDArray[np.float64]

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
    w = design_grid(plant)
    solutions: list[PIDesign] = []
    for maximum in local_maxima(plant, circle, w):
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


def _polish(plant: Plant, circle: Circle, w: Array, found: Maximum) -> PIDesign | None:
    """Return the verified optimum near a maximum of the grid: smooth if one tangency explains it, else a corner."""
    smooth = smooth_optimum(plant, circle, w, found.frequency)
    if smooth is not None and _plausible(smooth, found) and _verified(plant, circle, smooth):
        return smooth
    pairs = {closest_frequencies(plant, circle, w, found.k, found.ki), (min(found.neighbours), max(found.neighbours))}
    for pair in sorted(pairs):
        corner = corner_optimum(plant, circle, found.k, found.ki, *pair)
        if corner is not None and _plausible(corner, found) and _verified(plant, circle, corner):
            return corner
    return None


def _plausible(design: PIDesign, found: Maximum) -> bool:
    return 0.3 * found.ki < design.ki < 3.0 * found.ki


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
