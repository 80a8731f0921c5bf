"""The controller's signal after a set-point step: where it begins, where it ends, and which step an actuator stands."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.exhibits.exercises import Exercises, Values
from replicate.exhibits.variants import Answer, Answers, Inputs
from replicate.teaching.drawing_numbers import gain_apart_from_one, no_common_value, number, two_digits
from replicate.teaching.lag_loop import lag_loop

if TYPE_CHECKING:
    from random import Random

CLEAR = 0.1  # so far apart, relative, that one answer is not taken for another


def control_effort(exercises: Exercises, name: str, original: Inputs) -> None:
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
            "dead time and gains are not near one": lambda x: all(abs(number(x, name) - 1.0) > CLEAR for name in "KLk"),
            "the loop is stable": lambda x: lag_loop(x).is_stable(),
            "the signal is largest at the start": _largest_at_the_start,
            "first and last value differ": lambda x: abs(number(x, "k") * number(x, "K") - 1.0) > CLEAR,
        },
        shown=_shown,
        stated="State the answers with three significant digits.",
    )(_answers)


def _variant(rng: Random) -> Inputs:
    return {
        "K": gain_apart_from_one(rng, 1.1, 2.5),
        "T": two_digits(rng, 2.0, 6.0),
        "L": two_digits(rng, 0.3, 1.5),
        "k": two_digits(rng, 1.2, 4.0),
        "ki": two_digits(rng, 0.2, 0.9),
        "U": two_digits(rng, 2.0, 9.0),
    }


def _largest_at_the_start(inputs: Inputs) -> bool:
    """Whether no later value is larger: neither the one just before the output moves nor the last."""
    k, ki, K, L = (number(inputs, name) for name in ("k", "ki", "K", "L"))
    if k < 1.0 / K or not lag_loop(inputs).is_stable():
        return False
    return ki * L < 0.5 * k and lag_loop(inputs).respond().control.peak().value <= (k + ki * L) * (1 + 1e-9)


def _answers(inputs: Inputs) -> Answers:
    k, ki, K, L, U = (number(inputs, name) for name in ("k", "ki", "K", "L", "U"))
    largest = k + ki * L
    return {
        "u(0+)": Answer(k, digits=3, mistakes={"integral gain": ki, "gain of the process": k * K}, asked="$u(0+)$"),
        "u(L)": Answer(
            largest,
            digits=3,
            mistakes={"integral part forgotten": k, "a whole unit of time": k + ki},
            asked="$u$ at $t = L$",
        ),
        "u(inf)": Answer(1 / K, digits=3, mistakes={"not inverted": K, "gain forgotten": 1.0}, asked=r"$u(\infty)$"),
        "largest step": Answer(
            U / largest,
            digits=3,
            mistakes={"at the start only": U / k, "in the end only": U * K},
            asked="largest step without saturation",
        ),
    }


def _shown(inputs: Inputs) -> Values:
    return {"peak": lag_loop(inputs).respond().control.peak().value}
