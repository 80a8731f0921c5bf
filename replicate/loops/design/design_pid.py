r"""PID design by constrained optimisation: the largest integral gain of a robust and well-shaped loop.

Maximise :math:`k_i` over (k, ki, kd) subject to the sensitivity circle, negative curvature and negative phase slope of
the Nyquist curve, each on its frequency range, and closed-loop stability. The search is that of
`replicate.loops.design.pid_search`, the optimum that of the system in `replicate.loops.design.pid_optimality`.

Reference: Panagopoulos, thesis (2000), paper II and its supplement, (5) and section 4.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from replicate.loops import checks
from replicate.loops.controller import PI
from replicate.loops.design.circles import Circle
from replicate.loops.design.design_pi import design_pi
from replicate.loops.design.nyquist_constraints import Constraint
from replicate.loops.design.pid_optimality import GridProblem
from replicate.loops.design.pid_result import PIDDesign, Status
from replicate.loops.design.pid_search import Search
from replicate.loops.errors import LoopError
from replicate.loops.frequency_domain.frequency_grids import design_grid
from replicate.loops.loop import Loop
from replicate.loops.plant import Plant
from replicate.loops.units import Units

DERIVATIVE_STARTS = (0.0, 0.3, 0.8, 1.8)  # kd of the starts, in units of k / (frequency of the PI design)
MODEST = 1.0 / 3.0  # of the gain that makes a loop oscillate
CAUTIOUS = 0.1  # ki of the second round of starts, in units of that of the first


def design_pid(
    plant: Plant,
    ms: float | None = None,
    mp: float | None = None,
    constraints: Sequence[Constraint | str] | str | None = None,
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
        Besides the circle: ``"curvature"``, ``"phase"``, or `Constraint` records with their own range and margin. A
        bare name is asked for on `search_range`. Default: both, without curvature for integrating plants, for which it
        is too severe. An empty sequence leaves the circle alone.
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
    checks.instance("the plant of a design", plant, Plant, "a Plant")
    if plant.is_rational and plant.num.size == plant.den.size:
        msg = "the plant's output jumps with its input: multiply a measurement filter into the plant to design a PID"
        raise LoopError(msg)
    units = Units.of(plant)
    scaled = units.plant(plant)
    sign = -1.0 if scaled.gain_is_negative else 1.0
    if start is not None:
        k, ki, kd = (sign * units.gain * checks.finite("start", gain) for gain in start)
        start = (k, ki * units.time, kd / units.time)
    if constraints is not None:
        names = "a list of 'curvature', 'phase' and Constraint"
        given = [constraints] if isinstance(constraints, str) else checks.several("constraints", constraints, names)
        constraints = [_scaled(item, units.time) for item in given]
    found = _design(scaled if sign > 0.0 else -scaled, ms, mp, circle, constraints, start)
    gain = sign / units.gain
    active = tuple(replace(part, frequency=part.frequency / units.time) for part in found.active)
    return replace(
        found,
        k=found.k * gain, ki=found.ki * gain / units.time, kd=found.kd * gain * units.time,
        frequency=found.frequency / units.time, active=active,
    )  # fmt: skip


def _scaled(item: Constraint | str, time: float) -> Constraint | str:
    return replace(item, low=item.low * time, high=item.high * time) if isinstance(item, Constraint) else item


def _design(
    plant: Plant,
    ms: float | None,
    mp: float | None,
    circle: Circle,
    constraints: Sequence[Constraint | str] | None,
    start: tuple[float, float, float] | None,
) -> PIDDesign:
    """Design for a plant of positive gain whose numbers are of the order of one."""
    pi = design_pi(plant, ms, mp)
    shape: Sequence[Constraint | str] = ("phase",) if plant.integrators else ("curvature", "phase")
    asked = [Constraint("sensitivity")]
    shape = shape if constraints is None else constraints
    named = any(not isinstance(item, Constraint) for item in shape) and np.isfinite(pi.ki)
    limits = search_range(plant, pi.k, pi.ki) if named else (0.0, float("inf"))
    asked += [_constraint(item, *limits) for item in shape]
    if _bandwidth_is_free(plant, shaped=len(asked) > 1):
        return _none("unbounded", shaped=len(asked) > 1)
    search = Search(GridProblem(plant, circle, tuple(asked)))
    starts, gain, frequency = _starts(plant, pi.k, pi.ki, pi.frequency, start)
    # severe constraints may leave room only far below the ki of the PI design, out of reach from its side
    cautious = [(k, CAUTIOUS * ki, kd) for k, ki, kd in starts]
    best = search.best(starts, search.summits(gain, frequency)) or search.best(cautious, [])
    return best or _none("no-controller", shaped=len(asked) > 1)


def search_range(plant: Plant, k: float, ki: float) -> tuple[float, float]:
    """Return the frequencies between which the thesis asks for the shape of the Nyquist curve.

    Half the frequency of the PI design's sensitivity peak, to the middle between the frequencies at which that loop has
    phases of -180 and -270 degrees; ``inf`` where it never gets there.

    Parameters
    ----------
    plant
        The plant.
    k, ki
        Gains of the PI design for it.
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


def _bandwidth_is_free(plant: Plant, *, shaped: bool) -> bool:
    """Whether high gain is known to be stable and robust: no dead time, no zeros to the right, at most two more poles.

    Two zeros of the controller on the plant's poles then leave L = const/s, whose gain is free; that holds for the
    shape constraints, too, if the plant is no more than two poles.
    """
    if not plant.is_rational or plant.dead_time or plant.den.size - plant.num.size > 2 or plant.num[0] < 0.0:
        return False
    return plant.den.size <= 3 and plant.num.size == 1 if shaped else bool(np.all(plant.zeros().real < 0.0))


def _none(status: Status, *, shaped: bool) -> PIDDesign:
    nan = float("nan")
    return PIDDesign(nan, nan, nan, nan, nan, (), status, shaped)


def _constraint(item: Constraint | str, low: float, high: float) -> Constraint:
    if isinstance(item, Constraint):
        return item
    if item not in ("curvature", "phase"):
        msg = f"constraint '{item}' is unknown; allowed: 'curvature', 'phase', or a Constraint"
        raise LoopError(msg)
    return Constraint("curvature" if item == "curvature" else "phase", low, high)


def _cancelling(plant: Plant) -> list[tuple[float, float, float]]:
    """Return gains whose zeros lie on a pair of the plant's poles, a third of what makes the loop oscillate.

    Around a lightly damped pair the feasible gains are a needle that begins there, too thin for a map to show.
    """
    w = design_grid(plant)
    starts = []
    for pole in plant.poles():
        if pole.imag > 0.0 > pole.real:
            k, ki = -2.0 * pole.real, abs(pole) ** 2
            value = (k + ki / (1j * w) + 1j * w) * plant(1j * w)
            turned = np.nonzero((value.imag[:-1] < 0.0) & (value.imag[1:] >= 0.0) & (value.real[1:] < 0.0))[0]
            kd = MODEST / abs(value[turned[0] if turned.size else np.argmax(w > abs(pole))])
            starts.append((float(k * kd), float(ki * kd), float(kd)))
    return starts


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
    starts = [*([] if start is None else [start]), *_cancelling(plant)]
    first, *rest = [(k, ki, share * size / frequency) for share in DERIVATIVE_STARTS]
    # a loop that lives on its derivative action is far from the PI design; severe constraints can push the optimum
    # there
    far = (0.1 * k, 0.3 * ki, 1.8 * size / frequency)
    return [*starts, first, far, *rest], size, frequency
