"""A set-point step that drives the actuator into its limit: how far the integral part winds up, and what holding does.

For K e^{-sL}/(1 + sT) at the limit U, the output is K U (1 - e^{-(t - L)/T}) from t = L on. It reaches 1, the set
point, at

    t1 = L + T ln(K U/(K U - 1)),

when an integral part that runs on has reached I = ki (t1 - K U (t1 - L) + T), the integral of the error. With an
integral part that is held at zero (clamping) the command k e leaves the limit when e = U/k, at

    t2 = L + T ln(K U/(K U - 1 + U/k)).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from replicate.exhibits.exercises import Exercises, Values
from replicate.exhibits.variants import Answer, Answers, Inputs, VariedFigure, rounded
from replicate.loops.saturation.limited_response import LimitedResponse
from replicate.teaching.drawing_numbers import (
    gain_apart_from_one,
    no_common_value,
    no_mistake_accepted,
    number,
    two_digits,
)
from replicate.teaching.lag_loop import lag_loop

if TYPE_CHECKING:
    from random import Random

    from matplotlib.figure import Figure


def windup(exercises: Exercises, name: str, original: Inputs) -> None:
    """Register the exercise.

    Parameters
    ----------
    original
        ``K``, ``T``, ``L`` of the process, ``k`` and ``ki`` of the controller, ``U``: the actuator's limit.
    """
    exercises.vary(
        name,
        original=original,
        variant=_variant,
        requires={
            "no common value among the numbers": no_common_value,
            "the process can reach the set point, but not quickly": lambda x: 1.2 < _strength(x) < 2.2,
            "gain and limit are not near one": lambda x: all(abs(number(x, key) - 1.0) > 0.1 for key in "KU"),
            "at the limit from the start": lambda x: number(x, "k") > 1.3 * number(x, "U"),
            "the integral part alone keeps the actuator at its limit": lambda x: _wound(x) > 1.15 * number(x, "U"),
            "at the limit until the set point is reached": lambda x: _least_command(x) > 1.02 * number(x, "U"),
            "no mistake is accepted": lambda x: no_mistake_accepted(_answers(x)),
            "the loop is stable": lambda x: lag_loop(x).is_stable(),
        },
        shown=_shown,
        figures={f"{name}-responses": VariedFigure("Windup and how to avoid it", _ALT, _draw, (6.2, 2.3))},
        stated="Carry on with at least four significant digits, and state the answers with three.",
    )(_answers)


def _variant(rng: Random) -> Inputs:
    return {
        "K": gain_apart_from_one(rng, 1.2, 2.5),
        "T": two_digits(rng, 2.0, 6.0),
        "L": two_digits(rng, 0.3, 1.5),
        "k": two_digits(rng, 1.2, 5.0),
        "ki": two_digits(rng, 0.5, 1.9),
        "U": two_digits(rng, 0.6, 0.9) if rng.random() < 0.5 else two_digits(rng, 1.1, 3.5),
    }


def _strength(inputs: Inputs) -> float:
    """Return where the output goes at the limit."""
    return number(inputs, "K") * number(inputs, "U")


def _reached(inputs: Inputs) -> float:
    final = _strength(inputs)
    return number(inputs, "L") + number(inputs, "T") * math.log(final / (final - 1.0))


def _integral(inputs: Inputs, reached: float) -> float:
    """Return the integral part at the time at which the set point is reached."""
    ki, T, L = (number(inputs, name) for name in ("ki", "T", "L"))
    return ki * (reached - _strength(inputs) * (reached - L) + T)


def _wound(inputs: Inputs) -> float:
    return _integral(inputs, _reached(inputs))


def _left(inputs: Inputs) -> float:
    final, share = _strength(inputs), number(inputs, "U") / number(inputs, "k")
    return number(inputs, "L") + number(inputs, "T") * math.log(final / (final - 1.0 + share))


def _limited(inputs: Inputs, anti_windup: str) -> LimitedResponse:
    limit = number(inputs, "U")
    until = 12.0 * number(inputs, "T")
    return lag_loop(inputs).saturated((-limit, limit), anti_windup, until=until)  # type: ignore[arg-type]


def _least_command(inputs: Inputs) -> float:
    """Return the least that the controller with an integral part that runs on asks for before the set point."""
    T, L, k, ki = (number(inputs, name) for name in ("T", "L", "k", "ki"))
    final, t = _strength(inputs), np.linspace(L, _reached(inputs), 201)
    rise = -np.expm1(-(t - L) / T)
    return float(np.min(k * (1.0 - final * rise) + ki * (t - final * (t - L - T * rise))))


def _answers(inputs: Inputs) -> Answers:
    T, L, k, ki, U = (number(inputs, name) for name in ("T", "L", "k", "ki", "U"))
    reached, left, final = _reached(inputs), _left(inputs), _strength(inputs)
    early = L + T * rounded(math.log(rounded(final / (final - 1.0), 4)), 4)
    share = rounded(U / k, 4)
    return {
        "reached": Answer(
            reached,
            digits=3,
            carried=(early,),
            mistakes={"dead time forgotten": reached - L, "gain forgotten": L + T * math.log(U / abs(U - 1.0))},
            asked="time at which the set point is reached",
        ),
        "integral": Answer(
            _wound(inputs),
            digits=3,
            carried=(_integral(inputs, early), _integral(inputs, rounded(reached, 4))),
            mistakes={"error one all the time": ki * reached, "dead time forgotten": _wound(inputs) - ki * L},
            asked="integral part then",
        ),
        "left": Answer(
            left,
            digits=3,
            carried=(L + T * rounded(math.log(rounded(final / (final - 1.0 + share), 4)), 4),),
            mistakes={"not before the set point": reached, "dead time forgotten": left - L},
            asked="time at which the held controller leaves the limit",
        ),
    }


def _shown(inputs: Inputs) -> Values:
    return {"final": _strength(inputs), "least": number(inputs, "U") / number(inputs, "k")}


_ALT = (
    "Output over time after a step of the set point, with the actuator at its limit at first. With an integral part "
    "that runs on the output overshoots far and long; with one that is held at the limit it overshoots less."
)


def _draw(fig: Figure, inputs: Inputs) -> None:
    axes = fig.subplots()
    axes.axhline(1.0, color="0.4", linestyle="--", linewidth=1.0)
    end = 8.0 * number(inputs, "T")
    times = np.linspace(0.0, end, 401)
    for scheme, words in (("none", "integral part runs on"), ("clamping", "held at the limit")):
        axes.plot(times, _limited(inputs, scheme).output(times), label=words)
    axes.set(xlabel="time $t$", ylabel="output $y$", xlim=(0.0, end), ylim=(0.0, None))
    axes.grid(visible=True)
    axes.legend()
