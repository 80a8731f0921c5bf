"""Answers and figures of the handout's exercises."""

from __future__ import annotations

import math
from functools import cache
from random import Random
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from replicate.exhibits.exercises import Exercises, Values
from replicate.exhibits.variants import Answer, Answers, Inputs, rounded
from replicate.loops import PI, Loop
from replicate.papers.khan import paper
from replicate.papers.khan.processes import PRINTED, RESTORED, case_gains, loop, plant, settling_after_load
from replicate.teaching import bode_reading, sketch, step_test

if TYPE_CHECKING:
    from matplotlib.figure import Figure

exercises = Exercises()

PH_OF_BOTH = 0.2  # where both pairs of formulas are valid
DEAD_TIMES = tuple(n / 10 for n in range(1, 201) if 20000 % n == 0)  # 0.2/h has few digits
LOAD_AT = 100.0  # when the load of Table I enters


def _frame(rng: Random) -> Inputs:
    """Draw a dead time and a pole with ph = 0.2, both of few digits."""
    return {"p": round(PH_OF_BOTH / (h := rng.choice(DEAD_TIMES)), 4), "h": h}


def _terms(p: float, h: float) -> dict[str, tuple[float, ...]]:
    """Return the terms of both pairs as printed: (7b), (7a)."""
    return {
        "first KP": (0.404 / h, 0.256 * p, -0.1275 * math.sqrt(p / h)),
        "first KI": (0.0808 / h**2, 0.719 * p / h, -0.324 * math.sqrt(p / h**3)),
        "second KP": (-0.404 * p**2 * h, 0.723 * p, 0.3852 / h),
        "second KI": (-0.525 * p**2, 0.4104 * p / h, -0.00024 / h**2),
    }


def _restored(inputs: Inputs) -> Values:
    p, h = float(inputs["p"]), float(inputs["h"])
    kp, ki = case_gains("7a", p, h, RESTORED)
    return {"restored KP": float(kp), "restored KI": float(ki)}


@exercises.vary(
    "jump",
    original={"p": 0.2, "h": 1.0},
    variant=_frame,
    requires={"h is not one": lambda inputs: float(inputs["h"]) != 1.0},
    shown=_restored,
    stated="Carry on with at least three significant digits of each term, and state the gains with three.",
)
def jump(inputs: Inputs) -> Answers:
    """Return the gains of both pairs where they meet, and with terms of three digits."""
    found: dict[str, Answer] = {}
    p, h = float(inputs["p"]), float(inputs["h"])
    for name, terms in _terms(p, h).items():
        pair, gain = name.split()
        found[name] = Answer(
            sum(terms),
            digits=3,
            carried=(sum(rounded(term, 3) for term in terms),),
            mistakes={"all signs plus": sum(map(abs, terms)), "as if h were 1": sum(_terms(p, 1.0)[name])},
            asked=f"{pair} pair, $K_{gain[1]}$",
        )
    return found


@exercises.vary(
    "double-root",
    original={"a": 1.0, "b": 3.0},
    variant=lambda rng: {"a": rng.randint(4, 19) / 10, "b": rng.randint(21, 45) / 10},
    requires={"neither is one": lambda inputs: abs(float(inputs["a"]) - 1.0) > 0.05},
    shown=lambda _: {"0": math.exp(-1.0)},
    stated="State three significant digits.",
)
def double_root(inputs: Inputs) -> Answers:
    """Return K_b h, at which two real poles of proportional control meet, at two values of ph."""
    return {
        name: Answer(
            math.exp(-(1 + float(ph))),
            digits=3,
            mistakes={"one forgotten": math.exp(-float(ph)), "ph forgotten": math.exp(-1.0)},
            asked=rf"$K_b h$ for $ph = {float(ph):g}$",
        )
        for name, ph in inputs.items()
    }


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


step_test(exercises, "step-test", {"K": 0.8, "T": 5.0, "L": 3.0, "u": 2.0, "seed": 2026.0})
sketch(
    exercises,
    "sketch",
    {"p": -0.5, "g": 1.0, "L": 0.8, "k": 0.6, "ki": 0.4},
    pole=(-0.9, -0.2),
    gain=(0.3, 0.9),
)
bode_reading(exercises, "bode", {"K": 0.8, "T": 3.0, "L": 1.5, "k": 1.6, "ki": 0.5})
