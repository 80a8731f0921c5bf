"""Sketch a set-point response on blank axes: until the second dead time it can be computed by hand.

During one dead time after the output's first move the plant sees the controller's signal of a loop that does not know
of it yet, u = k + ki t. For dy/dt = p y + g u(t - L), with A = (e^{pL} - 1)/p:

    y(2 L) = g (k A + ki (A - L)/p).
"""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from replicate.exhibits.exercises import Exercises
from replicate.exhibits.variants import Answer, Answers, Inputs, VariedFigure, rounded
from replicate.loops import PI, Loop, Plant, Signal
from replicate.teaching.drawing_numbers import number, two_digits

if TYPE_CHECKING:
    from random import Random

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SHOWN = 8.0  # dead times
_SIZE = (6.2, 2.3)
_ROOM = (0.55, 0.12, 0.45, 0.1)  # inches for ticks and labels: left, right, below, above


def _loop(inputs: Inputs) -> Loop:
    p, g = number(inputs, "p"), number(inputs, "g")
    plant = Plant([g], [1.0, -p], dead_time=number(inputs, "L"))
    return Loop(plant, PI(number(inputs, "k"), number(inputs, "ki")))


def _shown(inputs: Inputs) -> Signal:
    """Return the part of the response that the axes have room for."""
    return _loop(inputs).step(until=1.01 * SHOWN * number(inputs, "L"))


def sketch(
    exercises: Exercises,
    name: str,
    original: Inputs,
    *,
    pole: tuple[float, float],
    gain: tuple[float, float],
    integral: tuple[float, float] = (0.1, 0.9),
    top: float = 1.8,
) -> None:
    """Register the exercise.

    Parameters
    ----------
    original
        ``p``, ``g``, ``L``, ``k``, ``ki``: dy/dt = p y + g u(t - L) under u = k e + ki times the integral of e.
    pole, gain, integral
        Ranges of p, k and ki.
    top
        Of the axes.
    """
    exercises.figure(f"{name}-axes", "Axes for a sketch", alt=_AXES, size=_SIZE)(lambda fig: _blank(fig, top))
    figures = {f"{name}-curve": VariedFigure("The response", _CURVE, partial(_curve, top=top), _SIZE, in_key=True)}

    def variant(rng: Random) -> Inputs:
        sign, (low, high) = math.copysign(1.0, pole[1]), sorted(abs(end) for end in pole)
        return {
            "p": sign * two_digits(rng, low, high),
            "g": two_digits(rng, 1.0, 2.0),
            "L": two_digits(rng, 0.5, 2.0),
            "k": two_digits(rng, *gain),
            "ki": two_digits(rng, *integral),
        }

    exercises.vary(
        name,
        original=original,
        variant=variant,
        requires={
            "no common value among the numbers": lambda x: len({abs(number(x, key)) for key in x}) == len(x),
            "the integral part counts, and the pole": _parts_count,
            "neither too fast for the dead time nor too slow for the pole": _moderate,
            "the loop is stable": lambda x: _loop(x).is_stable(),
            "its peak lies on the axes": lambda x: _shown(x).peak().value < top - 0.2,
        },
        figures=figures,
        stated="Carry on with at least three significant digits, and state $y(2L)$ with three.",
    )(_answers)


def _parts(inputs: Inputs) -> tuple[float, float]:
    """Return the shares of the proportional and of the integral part in y(2L)."""
    p, g, L, k, ki = (number(inputs, name) for name in ("p", "g", "L", "k", "ki"))
    area = math.expm1(p * L) / p
    return g * k * area, g * ki * (area - L) / p


def _parts_count(inputs: Inputs) -> bool:
    proportional, integral = _parts(inputs)
    y = proportional + integral
    return 0.2 < y < 1.6 and abs(proportional / y - 1.0) > 0.02 and abs(_no_lag(inputs) / y - 1.0) > 0.05


def _moderate(inputs: Inputs) -> bool:
    """Whether stability is likely: what follows costs more to find out."""
    p, g, L, k, ki = (number(inputs, name) for name in ("p", "g", "L", "k", "ki"))
    return g * k * L < 0.9 and ki * L < 0.7 * k and g * k > 2.0 * p


def _no_lag(inputs: Inputs) -> float:
    """Return what an integrator in place of the lag would give."""
    g, L, k, ki = (number(inputs, name) for name in ("g", "L", "k", "ki"))
    return g * (k * L + ki * L**2 / 2)


def _answers(inputs: Inputs) -> Answers:
    p, g, L, k, ki = (number(inputs, name) for name in ("p", "g", "L", "k", "ki"))
    proportional, integral = _parts(inputs)
    area = rounded(math.expm1(rounded(p * L, 3)) / p, 3)
    early = g * (k * area + ki * (area - L) / p)
    return {
        "y(2L)": Answer(
            proportional + integral,
            digits=3,
            carried=(early,),
            mistakes={"integral part forgotten": proportional, "pole forgotten": _no_lag(inputs)},
            asked="$y(2L)$",
        )
    }


_AXES = (
    "Axes with a grid, blank but for the dashed set point: output over time in dead times, from 0 to 8, for a sketch."
)
_CURVE = "The response: zero for one dead time, a rise, and a swing about the set point, which is dashed."


def _blank(fig: Figure, top: float) -> None:
    _axes(fig, top)


def _axes(fig: Figure, top: float) -> Axes:
    width, height = (float(side) / fig.dpi for side in fig.bbox.size)
    left, right, below, above = _ROOM
    fig.figure.set_layout_engine("none")  # the axes have their place: nothing is weighed anew for each of a class
    axes = fig.add_axes((left / width, below / height, 1 - (left + right) / width, 1 - (below + above) / height))
    axes.axhline(1.0, color="0.4", linestyle="--", linewidth=1.0)
    axes.set(xlabel="$t/L$", ylabel="output $y$", xlim=(0.0, SHOWN), ylim=(0.0, top))
    axes.grid(visible=True)
    return axes


def _curve(fig: Figure, inputs: Inputs, top: float) -> None:
    times = np.linspace(0.0, SHOWN, 401)
    _axes(fig, top).plot(times, _shown(inputs)(times * number(inputs, "L")))
