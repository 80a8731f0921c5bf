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
from replicate.loops import PI, Loop, Plant
from replicate.papers.ali.structures import Settings, d_filter, plant, series
from replicate.papers.ali.tuning import gain_product, integral_time, smallest_sensitivity
from replicate.teaching import nyquist_reading, sketch

if TYPE_CHECKING:
    from matplotlib.figure import Figure

exercises = Exercises()

FIRST = 1.2  # of the values that the search tries
HARD = Fraction(9, 10)  # theta/T of the last row of Table 1
FULL, REDUCED = Fraction(1, 2), Fraction(2, 5)  # exponents of the two tables


@exercises.vary(
    "means",
    original={"x": float(HARD)},
    variant=lambda rng: {"x": rng.randint(30, 150) / 100},
    requires={"the ends are not near each other": lambda inputs: float(inputs["x"]) < 1.5},
    stated="State three significant digits.",
)
def means(inputs: Inputs) -> Answers:
    """Return geometric and arithmetic mean of 1 and 2T/theta."""
    x = float(inputs["x"])
    geometric, arithmetic = gain_product(Fraction(str(inputs["x"]))), (1 + 2 / x) / 2
    return {
        "geometric": Answer(
            geometric,
            digits=3,
            mistakes={"not the root": 2 / x, "arithmetic": arithmetic},
            asked="geometric mean",
        ),
        "arithmetic": Answer(
            arithmetic,
            digits=3,
            mistakes={"not halved": 1 + 2 / x, "geometric": geometric},
            asked="arithmetic mean",
        ),
    }


@exercises.vary(
    "smallest",
    original={"x": 0.2},
    variant=lambda rng: {"x": rng.randint(5, 45) / 100},
    requires={"no tie": lambda inputs: 0.01 < (smallest_sensitivity(_ratio(inputs)) * 10) % 1 < 0.99},
    stated="State the bound with three significant digits.",
)
def smallest(inputs: Inputs) -> Answers:
    """Return the maximum sensitivity below which the design loop cannot go, and where the search stops."""
    x = float(inputs["x"])
    least = smallest_sensitivity(_ratio(inputs))
    stops = max(FIRST, math.ceil(10 * least) / 10)
    return {
        "least": Answer(
            least,
            digits=3,
            carried=(1 / (1 - rounded(math.sqrt(x / 2), 3)),),
            mistakes={"half forgotten": 1 / (1 - math.sqrt(x)), "not inverted": 1 - math.sqrt(x / 2)},
            asked="bound",
        ),
        "stops at": Answer(
            stops,
            tolerance=0.001,
            mistakes={"one step too early": stops - 0.1, "one step too late": stops + 0.1},
            asked="the search stops at",
        ),
    }


def _ratio(inputs: Inputs) -> Fraction:
    return Fraction(str(inputs["x"]))


def _loop(gain: float) -> Loop:
    return Loop(plant(float(HARD)), series(Settings(gain, integral_time(HARD), float(HARD / 2))))


def _peak(gain: float) -> float:
    return float(_loop(gain).sensitivity_peak())


@cache
def _window() -> tuple[float, float]:
    """Return the ends of the interval of stable gains."""
    gain = gain_product(HARD, REDUCED)
    margins = _loop(gain).margins()
    return gain * margins.gain_reduction, gain * margins.gain


@exercises.answer("best-gain")
def best_gain() -> Values:
    """Return where in the window the maximum sensitivity is smallest, and the gains of both tables."""
    low, high = _window()
    inset = 0.01 * (high - low)
    ends = (low + inset, high - inset)
    found = optimize.minimize_scalar(_peak, bounds=ends, method="bounded", options={"xatol": 1e-8})
    reduced = gain_product(HARD, REDUCED)
    return {
        "gain": float(found.x),
        "Ms": float(found.fun),
        "reduced": reduced,
        "reduced_Ms": _peak(reduced),
        "full": gain_product(HARD, FULL),
        "high": high,
        "pade_high": float(2 / HARD),
    }


@exercises.figure(
    "window",
    "Maximum sensitivity over the window of stable gains",
    alt="Maximum sensitivity over the gain for theta/T = 0.9, a curve that rises steeply towards both ends of the "
    "window of stable gains. The gain of Table 2 lies right of its bottom, that of Table 1 on the steep right flank.",
    size=(5.8, 1.6),
)
def window(fig: Figure) -> None:
    """Draw the maximum sensitivity over the gain, with the gains of the two tables."""
    low, high = _window()
    inset = 0.02 * (high - low)
    gains: NDArray[np.float64] = np.linspace(low + inset, high - inset, 81)
    axes = fig.subplots()
    axes.plot(gains, [_peak(float(gain)) for gain in gains])
    for exponent, name, colour, offset in ((REDUCED, "Table 2", "C2", -4), (FULL, "Table 1", "C1", -8)):
        gain = gain_product(HARD, exponent)
        peak = _peak(gain)
        axes.plot([gain], [peak], "o", color=colour)
        axes.annotate(name, (gain, peak), (offset, 3), textcoords="offset points", ha="right", va="bottom")
    axes.set(xlabel="$KK_p$", ylabel="$M_s$", ylim=(0.0, 40.0))


@exercises.figure(
    "twins",
    "Two derivative filters",
    alt="Magnitude of the lead factor over frequency, with the filter on the whole factor and on the derivative alone. "
    "Both rise from 1; at high frequencies the first ends at 10, the second at 11.",
    size=(6.4, 2.6),
)
def twins(fig: Figure) -> None:
    """Draw the magnitude of the lead factor with each of the two filters, over frequency times Td."""
    omega = np.geomspace(0.1, 1000.0, 301)
    axes = fig.subplots()
    for structure, name in ((series, "filter on the whole factor"), (d_filter, "filter on D only")):
        controller = structure(Settings(1.0, 1e9, 1.0))  # without integral action only the lead factor is left
        axes.loglog(omega, abs(controller.feedback(1j * omega)), label=name)
    ticks = [1, 2, 5, 10]
    axes.set(xlabel="$\\omega T_d$", ylabel="magnitude", yticks=ticks, ylim=(0.9, 14.0))
    axes.set_yticklabels([str(tick) for tick in ticks])
    axes.minorticks_off()
    axes.legend()


def _nyquist_loop(inputs: Inputs) -> Loop:
    plant = Plant([1.0], [1.0, -1.0], dead_time=float(inputs["theta"]))
    return Loop(plant, PI(k=float(inputs["k"]), ki=float(inputs["ki"])))


nyquist_reading(
    exercises,
    "nyquist",
    {"theta": 0.2, "k": 2.2, "ki": 0.2},
    loop=_nyquist_loop,
    variant=lambda rng: {
        "theta": rng.randint(5, 30) / 100,
        "k": rng.randint(14, 45) / 10,
        "ki": rng.randint(5, 60) / 100,
    },
)
sketch(
    exercises,
    "sketch",
    {"p": 0.2, "g": 1.0, "L": 0.6, "k": 0.8, "ki": 0.09},
    pole=(0.1, 0.3),
    gain=(0.3, 0.9),
    integral=(0.02, 0.09),
    top=2.4,
)
