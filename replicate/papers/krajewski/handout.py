"""Answers and figures of the handout's exercises."""

from __future__ import annotations

import math
from fractions import Fraction
from functools import cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy import optimize

from replicate.exhibits.exercises import Exercises, Values
from replicate.exhibits.variants import Answer, Answers, Inputs, rounded
from replicate.loops import PI, Loop, Plant, Signal, SweepResult, sweep
from replicate.papers.krajewski.chart_values import TAUS
from replicate.papers.krajewski.loci import upper_end
from replicate.papers.krajewski.normalised_loop import lag, loop, point
from replicate.papers.krajewski.table_1 import MARGINS, hyperbola, hyperbola_fit, printed_coefficients, upper_ends
from replicate.papers.krajewski.table_1_errors import residuals, single_digit_slips
from replicate.teaching import control_effort, nyquist_reading, windup

if TYPE_CHECKING:
    from matplotlib.figure import Figure

exercises = Exercises()

TAU, CROSSOVER = 0.5, 1.5  # the last exercise

_COUNTS = {0: "none", 1: "one", 2: "two", 3: "three"}  # small numbers in running text


@exercises.answer("slips")
def slips() -> Values:
    """Return how many single wrong digits explain the column of 75 degrees, and the first of them."""
    found = single_digit_slips("75")
    tau, right, wrong = found[0]
    return {"count": _COUNTS.get(len(found), str(len(found))), "tau": tau, "right": right, "wrong": wrong}


@exercises.answer("at-0.3")
def at_a_third() -> Values:
    """Return the printed hyperbola of 45 degrees at tau = 0.3, and how far below the exact end it and the fit are."""
    ends = upper_ends("45")
    exact = float(ends[list(TAUS).index(0.3)])
    printed = float(hyperbola(printed_coefficients("45"), 0.3))
    fitted = float(hyperbola(hyperbola_fit(ends), 0.3))
    return {"printed": printed, "below": exact - printed, "fit_below": exact - fitted}


@exercises.figure(
    "hyperbolas",
    "The ends of the curves and the printed hyperbolas",
    alt="The ends of the curves of constant phase margin over the dead time, for 45 and 120 degrees, with the printed "
    "hyperbolas dashed. All fall steeply at first; for 45 degrees the printed hyperbola lies a little below the curve.",
    size=(6.4, 2.7),
)
def draw_hyperbolas(fig: Figure) -> None:
    """Draw b_u and the printed hyperbolas for two phase margins: the odd column, and the one that fits worst."""
    axes = fig.subplots()
    taus = np.linspace(TAUS[0], TAUS[-1], 91)
    for colour, margin in (("C1", "45"), ("C0", "120")):
        ends = [upper_end(float(tau), float(margin)) for tau in taus]
        axes.plot(taus, ends, color=colour, label=f"$b_u$, {margin}°")
        printed = hyperbola(printed_coefficients(margin), taus)
        axes.plot(taus, printed, color=colour, linestyle="--", label=f"printed hyperbola, {margin}°")
    axes.set(xlabel="$\\tau$", ylabel="$b_u$", xlim=(0.0, 1.0), ylim=(0.0, None))
    axes.legend()


@exercises.figure(
    "residuals",
    "Residuals of the printed hyperbolas",
    alt="Residuals over the dead time for six phase margins. Five grey curves start positive, dip below zero and "
    "rise above it again. The curve of 45 degrees, in colour, falls below zero and stays there.",
    size=(6.4, 2.5),
)
def draw_residuals(fig: Figure) -> None:
    """Draw the residuals of all columns of Table 1, the impossible one in colour."""
    axes = fig.subplots()
    for margin in MARGINS:
        odd = margin == "45"
        style = {"color": "C1", "linewidth": 2.0, "zorder": 3} if odd else {"color": "0.55", "linewidth": 1.0}
        values = residuals(margin)
        axes.plot(TAUS, values, linestyle="-", marker="o", markersize=4 if odd else 2.5, **style)  # type: ignore[arg-type]
    for names, height in (("90°", "90"), ("75°", "75"), ("60°, 120°", "60"), ("30°", "30"), ("45°", "45")):
        axes.annotate(
            names, (TAUS[-1], residuals(height)[-1]), (6, {"90": 2, "75": -2}.get(height, 0)),
            textcoords="offset points", va="center", fontsize=8, color="C1" if height == "45" else "0.35",
            annotation_clip=False,
        )  # fmt: skip
    axes.axhline(0.0, color="0.2", linewidth=0.8)
    axes.set(xlabel="$\\tau$", ylabel="residual", xlim=(0.08, 1.0))


@cache
def _step(margin: float) -> Signal:
    """Return the step response on the arc of the exercise at a phase margin in degrees."""
    a, b = point(TAU, CROSSOVER, margin)
    return loop(float(a), float(b), TAU).step()


@cache
def _margins() -> NDArray[np.float64]:
    """Return phase margins from 45 degrees to close to the b axis."""
    most = 180.0 - float(np.degrees(lag(TAU, CROSSOVER)))
    return np.linspace(45.0, most - 1.0, 160)


@cache
def _along() -> SweepResult:
    """Return overshoot and settling time at all of these margins."""
    a, b = point(TAU, CROSSOVER, _margins())
    plant = Plant([1.0], [1.0, 1.0], dead_time=TAU)
    return sweep(plant, np.column_stack([b, a]), ("overshoot", "settling_time"), pairing="pairwise")


@exercises.answer("arc")
def arc() -> Values:
    """Return where on the arc the response settles first, and where its second dip leaves the 2 % band."""
    quickest = float(_margins()[int(np.argmin(_along()["settling_time"]))])
    best = _step(quickest)

    def second_dip(margin: float) -> float:
        return float(_step(margin).extrema()[3]) - 0.98

    jump = float(optimize.brentq(second_dip, 50.0, 62.0, xtol=1e-9))
    return {
        "margin": quickest,
        "time": best.settling_time(),
        "overshoot": best.overshoot(),
        "jump": jump,
        "dip_time": _step(jump).extrema()[3].time,
    }


@exercises.figure(
    "along-the-arc",
    "Overshoot and settling time along the arc",
    alt="Two panels over the phase margin. The overshoot falls to zero. The settling time is nearly "
    "constant at first, jumps once, and grows without bound towards the end of the arc on the b axis.",
    size=(6.4, 2.2),
)
def along_the_arc(fig: Figure) -> None:
    """Draw overshoot and settling time over the phase margin."""
    margins = _margins()
    left, right = fig.subplots(1, 2)
    left.plot(margins, 100.0 * _along()["overshoot"])
    left.axhline(2.0, color="0.5", linestyle=":", linewidth=1.0)
    right.plot(margins, _along()["settling_time"])
    left.set(xlabel="phase margin (degrees)", ylabel="overshoot (%)")
    right.set(xlabel="phase margin (degrees)", ylabel="settling time", ylim=(0.0, 40.0))


@exercises.vary(
    "diagonal",
    original={"m": 60.0},
    variant=lambda rng: {"m": float(rng.randint(25, 80))},
    requires={"far from 45 degrees": lambda inputs: abs(float(inputs["m"]) - 45.0) > 3.0},
    shown=lambda inputs: {"as pi": _as_pi(90 - round(float(inputs["m"])))},
    stated=r"State $a\tau$ and the gain margin with three significant digits.",
)
def diagonal(inputs: Inputs) -> Answers:
    """Return what is left of the phase on the diagonal, and the gain margin that goes with a phase margin."""
    margin = math.radians(float(inputs["m"]))
    left = math.pi / 2 - margin
    return {
        "a tau": Answer(
            left,
            digits=3,
            mistakes={"in degrees": math.degrees(left), "the margin itself": margin},
            asked=r"$a\tau$",
        ),
        "gain margin": Answer(
            math.pi / (2 * left),
            digits=3,
            carried=(math.pi / (2 * rounded(left, 3)),),
            mistakes={"not inverted": 2 * left / math.pi, "half a turn": math.pi / left},
            asked="gain margin",
        ),
    }


def _as_pi(degrees: int) -> str:
    """Return an angle as a fraction of pi, in LaTeX."""
    found = Fraction(degrees, 180)
    numerator = r"\pi" if found.numerator == 1 else rf"{found.numerator}\pi"
    return f"{numerator}/{found.denominator}"


def _nyquist_loop(inputs: Inputs) -> Loop:
    plant = Plant.foptd(gain=1.0, time_constant=1.0, dead_time=float(inputs["tau"]))
    return Loop(plant, PI(k=float(inputs["b"]), ki=float(inputs["a"])))


nyquist_reading(
    exercises,
    "nyquist",
    {"a": 1.2, "b": 1.1, "tau": 0.5},
    loop=_nyquist_loop,
    variant=lambda rng: {
        "a": rng.randint(5, 25) / 10,
        "b": rng.randint(5, 25) / 10,
        "tau": rng.randint(2, 9) / 10,
    },
)
control_effort(exercises, "effort", {"K": 0.8, "T": 3.0, "L": 1.0, "k": 1.9, "ki": 0.5, "U": 5.0})
windup(exercises, "windup", {"K": 0.8, "T": 3.0, "L": 0.7, "k": 4.0, "ki": 1.5, "U": 2.0})
