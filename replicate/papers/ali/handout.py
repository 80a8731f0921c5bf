"""Answers and figures of the handout's exercises."""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy import optimize

from replicate.exhibits.exercises import Exercises, Values
from replicate.loops import Loop
from replicate.papers.ali.structures import Settings, plant, series
from replicate.papers.ali.tuning import gain_product, integral_time, smallest_sensitivity

if TYPE_CHECKING:
    from matplotlib.figure import Figure

exercises = Exercises()

HARD = Fraction(9, 10)  # theta/T of the last row of Table 1
FULL, REDUCED = Fraction(1, 2), Fraction(2, 5)  # exponents of the two tables


@exercises.answer("means")
def means() -> Values:
    """Return geometric and arithmetic mean of 1 and 2T/theta."""
    return {"geometric": gain_product(HARD), "arithmetic": float(1 + 2 / HARD) / 2}


@exercises.answer("smallest")
def smallest() -> Values:
    """Return the maximum sensitivity below which the design loop cannot go."""
    return {"0.2": smallest_sensitivity(Fraction(1, 5))}


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
