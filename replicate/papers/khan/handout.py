"""Answers and figures of the handout's exercises."""

from __future__ import annotations

import math
from functools import cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from replicate.exhibits.exercises import Exercises, Values
from replicate.loops import PI, Loop
from replicate.papers.khan import paper
from replicate.papers.khan.processes import PRINTED, RESTORED, case_gains, loop, plant, settling_after_load

if TYPE_CHECKING:
    from matplotlib.figure import Figure

exercises = Exercises()

LOAD_AT = 100.0  # when the load of Table I enters


@exercises.answer("double-root")
def double_root() -> Values:
    """Return K_b h, at which two real poles of proportional control meet, by ph."""
    return {str(ph): math.exp(-(1 + ph)) for ph in (0, 1, 3)}


@exercises.answer("wrong-digit")
def wrong_digit() -> Values:
    """Return the digit that is wrong in Haalman's load settling time, which Bryant's row prints, and the right one."""
    text = paper.printed_cells("table-1")["Bryant", "td"]
    settled = settling_after_load(loop("Haalman", 1.0, 10.0), LOAD_AT)
    right = f"{settled:.{len(text.partition('.')[2])}f}"
    ((wrong, good),) = [(old, new) for old, new in zip(text, right, strict=True) if old != new]  # one, or it is no slip
    return {"wrong": wrong, "right": good}


@exercises.answer("sharpened")
def sharpened() -> Values:
    """Return M_s of the rule at ph = 1, and the factor on both gains that brings it to 2."""
    kp, ki = case_gains("7b", 1.0, 1.0)

    def peak(factor: float) -> float:
        return float(Loop(plant(1.0, 1.0), PI(factor * kp, factor * ki)).sensitivity_peak())

    return {"rule": peak(1.0), "factor": brentq(lambda factor: peak(factor) - 2.0, 1.0, 2.5)}


@cache
def _margins(variant: str) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return ph, gain margin and M_s of rule (7a) over its range."""
    ph = np.geomspace(0.01, 0.2, 41)
    loops = [Loop(plant(float(x), 1.0), PI(*case_gains("7a", float(x), 1.0, variant))) for x in ph]
    gains = np.array([closed.margins().gain for closed in loops])
    return ph, gains, np.array([float(closed.sensitivity_peak()) for closed in loops])


@exercises.answer("margins")
def margins() -> Values:
    """Return the smallest gain margin and the extremes of M_s of (7a) as printed."""
    _, gain, ms = _margins(PRINTED)
    return {"gain": float(gain.min()), "low": float(ms.min()), "high": float(ms.max())}


@exercises.figure(
    "printed-and-restored",
    "Margins of (7a), printed and restored",
    alt="Two panels over ph from 0.01 to 0.2: gain margin and sensitivity peak. The dashed curves of the printed "
    "formula diverge from the solid ones of the restored formula as ph grows, but stay inside the claimed limits, "
    "which are dotted.",
    size=(6.4, 1.7),
)
def printed_and_restored(fig: Figure) -> None:
    """Draw gain margin and M_s of rule (7a) over its range, in both versions."""
    panels = fig.subplots(1, 2)
    for variant, style, label in ((RESTORED, "-", "zeros restored"), (PRINTED, "--", "as printed")):
        ph, *curves = _margins(variant)
        for axes, curve in zip(panels, curves, strict=True):
            axes.plot(ph, curve, style, label=label)
    for axes, label, limits in zip(panels, ("gain margin", "$M_s$"), ((2.5,), (1.3, 2.0)), strict=True):
        for limit in limits:
            axes.axhline(limit, color="0.5", linestyle=":", linewidth=1.0)
        axes.set(xscale="log", xlabel="$ph$", ylabel=label)
    panels[0].set_ylim(2.0, 4.6)
    panels[1].set_ylim(1.2, 2.1)
    panels[0].legend(loc="lower left")
