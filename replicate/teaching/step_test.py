"""A noisy step test from which gain, time constant and dead time of a process are to be identified."""

from __future__ import annotations

import hashlib
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy import optimize

from replicate.exhibits.exercises import Exercises, Values
from replicate.exhibits.variants import Answer, Answers, Inputs, VariedFigure
from replicate.teaching.drawing_numbers import gain_apart_from_one, no_common_value, number, two_digits

if TYPE_CHECKING:
    from random import Random

    from matplotlib.figure import Figure

Array = NDArray[np.float64]

SAMPLES = 80
NOISE = 0.02  # standard deviation, as a fraction of the final change
READ = 0.05  # what is read off the figure may be off by this fraction of a time constant or of the gain
ERRORS = 3.0  # standard errors that are accepted besides


def step_test(exercises: Exercises, name: str, original: Inputs) -> None:
    """Register the exercise.

    Parameters
    ----------
    original
        ``K``, ``T``, ``L`` of the process, ``u``: the step of its input, ``seed``: of the noise.
    """
    exercises.vary(
        name,
        original=original,
        variant=_variant,
        requires={
            "no common value among the numbers": no_common_value,
            "dead time and time constant can be told apart": lambda x: 0.3 < number(x, "L") / number(x, "T") < 1.2,
        },
        shown=_shown,
        stated="Answers within the scatter of the data are right; state them with two or three digits.",
        figures={name: VariedFigure("A step test", _ALT, _draw, (6.0, 2.4))},
        files=lambda inputs: {f"{name}.csv": _csv(inputs)},
    )(_answers)


def _variant(rng: Random) -> Inputs:
    return {
        "K": gain_apart_from_one(rng, 1.2, 3.0),
        "T": two_digits(rng, 3.0, 8.0),
        "L": two_digits(rng, 1.0, 6.0),
        "u": two_digits(rng, 1.3, 2.9),
        "seed": float(rng.randint(1000, 9999)),
    }


def _model(t: Array, K: float, T: float, L: float, u: float) -> Array:
    """Return the response of K e^{-sL}/(1 + sT) to a step of height u."""
    return np.where(t > L, K * u * -np.expm1(-np.maximum(t - L, 0.0) / T), 0.0)


def _data(inputs: Inputs) -> tuple[Array, Array]:
    K, T, L, u = (number(inputs, name) for name in ("K", "T", "L", "u"))
    t = np.linspace(0.0, np.ceil(L + 6.0 * T), SAMPLES + 1)
    seed = int.from_bytes(hashlib.sha256(f"{sorted(inputs.items())}".encode()).digest()[:8], "big")
    noise = np.random.default_rng(seed).standard_normal(t.size)
    return t, np.round(_model(t, K, T, L, u) + NOISE * K * u * noise, 3)


def _fitted(inputs: Inputs) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    """Return K, T, L of the least squares, and their standard errors."""
    return _fit(tuple(inputs.items()))


@lru_cache(maxsize=256)
def _fit(items: tuple[tuple[str, float | str], ...]) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    inputs = dict(items)
    (t, y), u = _data(inputs), number(inputs, "u")
    start = [number(inputs, name) for name in ("K", "T", "L")]
    found, covariance = optimize.curve_fit(lambda t, K, T, L: _model(t, K, T, L, u), t, y, p0=start)
    K, T, L = (float(value) for value in found)
    a, b, c = (float(value) for value in np.sqrt(np.diag(covariance)))
    return (K, T, L), (a, b, c)


def _answers(inputs: Inputs) -> Answers:
    (K, T, L), errors = _fitted(inputs)
    u = number(inputs, "u")
    a, b, c = (ERRORS * error for error in errors)
    return {
        "K": Answer(
            K,
            tolerance=READ * K + a,
            mistakes={"not divided by the step": K * u, "divided twice": K / u},
            asked="$K$",
        ),
        "T": Answer(
            T,
            tolerance=READ * T + b,
            mistakes={"dead time not subtracted": T + L, "settled instead of 63 per cent": 4 * T},
            asked="$T$",
        ),
        "L": Answer(L, tolerance=READ * T + c, mistakes={"time of 63 per cent": L + T, "none": 0.0}, asked="$L$"),
    }


def _shown(inputs: Inputs) -> Values:
    (K, T, L), (a, b, c) = _fitted(inputs)
    return {
        "dK": a,
        "dT": b,
        "dL": c,
        "final": K * number(inputs, "u"),
        "63": 0.632 * K * number(inputs, "u"),
        "at": L + T,
    }


def _csv(inputs: Inputs) -> str:
    t, y = _data(inputs)
    return "t,y\n" + "".join(f"{a:.4g},{b:.3f}\n" for a, b in zip(t, y, strict=True))


_ALT = (
    "Measured output over time after a step of the input at time zero: a pause, an exponential rise, and "
    "noise of about two per cent. The data are in the file that goes with the sheet."
)


def _draw(fig: Figure, inputs: Inputs) -> None:
    t, y = _data(inputs)
    axes = fig.subplots()
    axes.plot(t, y, ".", markersize=3.5)
    axes.set(xlabel="time $t$", ylabel="output $y$", xlim=(0.0, float(t[-1])), ylim=(min(0.0, float(y.min())), None))
    axes.grid(visible=True)
