"""Read the margins and the maximum sensitivity off a Bode plot."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from replicate.exhibits.exercises import Exercises
from replicate.exhibits.variants import Answer, Answers, Inputs, VariedFigure
from replicate.teaching.drawing_numbers import (
    gain_apart_from_one,
    no_common_value,
    no_mistake_accepted,
    number,
    two_digits,
)
from replicate.teaching.lag_loop import lag_loop
from replicate.teaching.phase_margin import phase_margin

if TYPE_CHECKING:
    from random import Random

    from matplotlib.figure import Figure

DECIBELS = 0.5  # a magnitude is read off the figure, whose grid has a line every 2 dB
ANGLE = 3.0  # degrees; a line every 10


def bode_reading(exercises: Exercises, name: str, original: Inputs) -> None:
    """Register the exercise.

    Parameters
    ----------
    original
        ``K``, ``T``, ``L`` of the process, ``k`` and ``ki`` of the controller.
    """
    exercises.vary(
        name,
        original=original,
        variant=_variant,
        requires={
            "no common value among the numbers": no_common_value,
            "the loop is stable": lambda x: lag_loop(x).is_stable(),
            "margins that can be read, and told from what they are taken for": _clear,
        },
        figures={name: VariedFigure("A Bode plot", _ALT, _draw, (6.2, 4.0))},
        stated=(
            "Magnitudes may be read off by half a decibel, angles by 3 degrees; state ratios with three digits, "
            "angles with two."
        ),
    )(_answers)


def _variant(rng: Random) -> Inputs:
    return {
        "K": gain_apart_from_one(rng, 1.1, 2.5),
        "T": two_digits(rng, 2.0, 6.0),
        "L": two_digits(rng, 1.0, 3.0),
        "k": two_digits(rng, 0.5, 3.0),
        "ki": two_digits(rng, 0.1, 0.6),
    }


def _answers(inputs: Inputs) -> Answers:
    gain, phase, peak, complementary = _read(tuple(number(inputs, name) for name in ("K", "T", "L", "k", "ki")))
    share = 10 ** (DECIBELS / 20) - 1
    return {
        "gain margin": Answer(
            gain,
            tolerance=share * gain,
            mistakes={"not inverted": 1 / gain, "decibels taken as a ratio": 20 * math.log10(gain)},
            asked="gain margin, as a ratio",
        ),
        "phase margin": phase_margin(phase, ANGLE),
        "Ms": Answer(
            peak,
            tolerance=share * peak,
            mistakes={
                "decibels taken as a ratio": 20 * math.log10(peak),
                "peak of the other closed loop": complementary,
            },
            asked="$M_s$, as a ratio",
        ),
    }


@lru_cache(maxsize=64)
def _read(numbers: tuple[float, ...]) -> tuple[float, float, float, float]:
    """Return gain margin, phase margin, and the peaks of S and T."""
    loop = lag_loop(dict(zip(("K", "T", "L", "k", "ki"), numbers, strict=True)))
    margins = loop.margins()
    return margins.gain, margins.phase, loop.sensitivity_peak().value, loop.complementary_peak().value


def _clear(inputs: Inputs) -> bool:
    answers = _answers(inputs)
    in_sight = 1.6 < answers["gain margin"].value < 6.0 and 25.0 < answers["phase margin"].value < 75.0
    return in_sight and answers["Ms"].value < 3.0 and no_mistake_accepted(answers)


_ALT = (
    "Bode plot of the loop: above, the magnitude of the loop transfer function and, dashed, of the sensitivity in "
    "decibels, with a line every 2; below, the phase in degrees, with a line every 10. The margins and the peak are to "
    "be read."
)


def _draw(fig: Figure, inputs: Inputs) -> None:
    loop = lag_loop(inputs)
    margins = loop.margins()
    omega = np.geomspace(0.2 * margins.gain_crossover, 2.5 * margins.phase_crossover, 801)
    curve = loop.nyquist(omega)
    upper, lower = fig.subplots(2, 1, sharex=True)
    upper.axhline(0.0, color="0.4", linewidth=1.0)
    upper.semilogx(omega, 20 * np.log10(np.abs(curve)), label="$|L|$")
    upper.semilogx(omega, -20 * np.log10(np.abs(1 + curve)), linestyle="--", label="$|S|$")
    upper.set(ylabel="magnitude (dB)", ylim=(-20.0, 20.0), yticks=np.arange(-20, 21, 10))
    upper.legend(loc="upper right")
    lower.axhline(-180.0, color="0.4", linewidth=1.0)
    lower.semilogx(omega, np.degrees(np.unwrap(np.angle(curve))))
    lower.set(xlabel="frequency (rad per unit of time)", ylabel="phase (degrees)", ylim=(-240.0, -90.0))
    lower.set(xlim=(omega[0], omega[-1]), yticks=np.arange(-240, -89, 30))
    lower.xaxis.set_major_formatter("{x:g}")
    lower.xaxis.set_minor_formatter(_at_two_and_five)
    for axes, step in ((upper, 2), (lower, 10)):
        low, high = axes.get_ylim()
        axes.set_yticks(np.arange(low, high + 1, step), minor=True)
        axes.grid(visible=True, which="minor", linewidth=0.4)
        axes.grid(visible=True, linewidth=0.9)


def _at_two_and_five(frequency: float, _: int | None) -> str:
    """Return the label of a line between powers of ten; a label at each of them would touch the next."""
    text = f"{frequency:g}"
    return text if text.strip("0.") in {"2", "5"} else ""
