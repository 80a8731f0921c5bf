"""A PI controller with given gain and phase margin, exactly."""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import brentq

from replicate.loops import checks
from replicate.loops.controller import PI
from replicate.loops.errors import LoopError
from replicate.loops.loop import Loop
from replicate.loops.plant import Plant
from replicate.loops.tune.models import direction

SOURCE = "W. K. Ho, C. C. Hang, L. S. Cao, Automatica 31 (1995) 497, whose arctangents are not approximated here"
VALIDITY = "stable and integrating plants; many pairs of margins cannot be had at once, and the error says so"

POINTS = 120
MET = 1e-7  # relative error of a margin that the search may leave


def gain_phase_margins(plant: Plant, gain_margin: float = 3.0, phase_margin: float = 60.0) -> PI:
    """Return the PI controller whose loop has exactly these margins, of several the one with the largest ki.

    At a chosen gain crossover the phase margin fixes both gains; the crossover is then moved until the gain margin is
    met, too.

    Parameters
    ----------
    plant
        Any plant.
    gain_margin
        Factor > 1.
    phase_margin
        Degrees, between 0 and 180.

    Raises
    ------
    LoopError
        If a margin is out of range, or no PI controller has both.

    Examples
    --------
    >>> plant = Plant.foptd(1.0, 1.0, 0.5)
    >>> margins = Loop(plant, gain_phase_margins(plant, 3.0, 60.0)).margins()
    >>> round(margins.gain, 9), round(margins.phase, 9)
    (3.0, 60.0)
    """
    checks.instance("the plant of a tuning rule", plant, Plant, "a Plant")
    gain_margin, phase_margin = (
        checks.finite(name, value) for name, value in (("gain_margin", gain_margin), ("phase_margin", phase_margin))
    )
    if not (1.0 < gain_margin < math.inf and 0.0 < phase_margin < 180.0):
        given = f"{gain_margin} and {phase_margin}"
        msg = f"the margins must be a factor > 1 and an angle between 0 and 180 degrees, not {given}"
        raise LoopError(msg)

    def controller(log_w: float) -> PI:
        w = math.exp(log_w)
        value = -np.exp(1j * math.radians(phase_margin)) / complex(plant(1j * w))
        return PI(float(value.real), float(-w * value.imag))

    def excess(log_w: float) -> float:
        loop = Loop(plant, controller(log_w))
        if loop.controller.ki * sign < 0.0 or not loop.is_stable():
            return float("nan")
        return math.log(loop.margins().gain / gain_margin)

    sign = direction(plant)
    scale = _time_scale(plant)
    grid = np.linspace(math.log(1e-3 / scale), math.log(1e2 / scale), POINTS)
    values = np.array([excess(x) for x in grid])
    found = []
    for i in np.nonzero(values[:-1] * values[1:] <= 0.0)[0]:
        best = controller(float(brentq(excess, grid[i], grid[i + 1], xtol=1e-15, rtol=1e-15)))
        margins = Loop(plant, best).margins()
        wrong = max(abs(margins.gain / gain_margin - 1.0), abs(margins.phase / phase_margin - 1.0))
        if wrong < MET:
            found.append(best)
    if not found:
        wanted = f"a gain margin of {gain_margin:g} and a phase margin of {phase_margin:g} degrees"
        msg = f"no PI controller gives {plant!r} {wanted}"
        raise LoopError(msg)
    return max(found, key=lambda c: abs(c.ki))


def _time_scale(plant: Plant) -> float:
    """Return dead time and lags added: the time in which the plant answers."""
    lags = [1.0 / abs(p) for p in plant.poles() if p] if plant.is_rational else []
    return float(plant.dead_time + sum(lags)) or 1.0
