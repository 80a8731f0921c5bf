"""Read the margins and the maximum sensitivity off a Nyquist curve."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from replicate.exhibits.exercises import Exercises
from replicate.exhibits.variants import Answer, Answers, Inputs, VariedFigure
from replicate.loops import Loop
from replicate.teaching.drawing_numbers import no_mistake_accepted
from replicate.teaching.phase_margin import phase_margin

if TYPE_CHECKING:
    from random import Random

    from matplotlib.figure import Figure

DISTANCE = 0.02  # read off the figure, whose grid has a line every 0.25
ANGLE = 2.0  # degrees


def nyquist_reading(
    exercises: Exercises,
    name: str,
    original: Inputs,
    *,
    loop: Callable[[Inputs], Loop],
    variant: Callable[[Random], Inputs],
) -> None:
    """Register the exercise.

    Parameters
    ----------
    loop
        Makes the loop of the inputs. It has one gain crossover, and its curve passes the critical point on the right.
    variant
        Draws the inputs.
    """
    found = lru_cache(maxsize=64)(lambda items: _read(loop(dict(items))))

    def read(inputs: Inputs) -> tuple[float, float, float]:
        """Return the crossing of the real axis, the phase margin, and the distance from the critical point."""
        return found(tuple(inputs.items()))

    def answers(inputs: Inputs) -> Answers:
        crossing, phase, distance = read(inputs)
        return {
            "gain margin": Answer(
                1 / crossing,
                tolerance=DISTANCE / crossing**2,
                mistakes={"not inverted": crossing, "distance to the critical point": 1 / (1 - crossing)},
                asked="gain margin",
            ),
            "phase margin": phase_margin(phase, ANGLE),
            "Ms": Answer(
                1 / distance,
                tolerance=DISTANCE / distance**2,
                mistakes={"not inverted": distance, "at the crossing of the real axis": 1 / (1 - crossing)},
                asked="$M_s$",
            ),
        }

    def draw(fig: Figure, inputs: Inputs) -> None:
        _draw(fig, loop(inputs))

    def clear(inputs: Inputs) -> bool:
        crossing, phase, _ = read(inputs)
        return 0.15 < crossing < 0.8 and 20.0 < phase < 80.0 and no_mistake_accepted(answers(inputs))

    exercises.vary(
        name,
        original=original,
        variant=variant,
        requires={
            "the loop is stable": lambda inputs: loop(inputs).is_stable(),
            "margins that can be read, and told from what they are taken for": clear,
        },
        figures={name: VariedFigure("A Nyquist curve", _ALT, draw, (3.6, 3.6))},
        stated=(
            "Distances may be read off by 0.02, angles by 2 degrees; state margins and $M_s$ with two or three digits."
        ),
    )(answers)


_ALT = (
    "Nyquist curve of the loop near the critical point, in a square from minus 1.5 to 0.5, with the unit circle and a "
    "grid of lines every 0.25. The margins and the shortest distance are to be read."
)


def _read(loop: Loop) -> tuple[float, float, float]:
    margins = loop.margins()
    return 1 / margins.gain, margins.phase, 1 / loop.sensitivity_peak().value


def _draw(fig: Figure, loop: Loop) -> None:
    margins = loop.margins()
    omega = np.geomspace(0.02 * margins.gain_crossover, 8.0 * margins.phase_crossover, 1500)
    curve = loop.nyquist(omega)
    axes = fig.subplots()
    angle = np.linspace(0.0, 2.0 * np.pi, 361)
    axes.plot(np.cos(angle), np.sin(angle), color="0.45", linewidth=0.9, linestyle="--")
    axes.plot(curve.real, curve.imag)
    axes.plot([-1.0], [0.0], "+", color="C3", markersize=9)
    ticks = np.arange(-1.5, 0.51, 0.25)
    axes.set(
        xlim=(-1.5, 0.5), ylim=(-1.5, 0.5), xticks=ticks, yticks=ticks, xlabel="real part", ylabel="imaginary part"
    )
    axes.set_xticklabels([f"{tick:g}" if tick % 0.5 == 0 else "" for tick in ticks])
    axes.set_yticklabels([f"{tick:g}" if tick % 0.5 == 0 else "" for tick in ticks])
    axes.grid(visible=True)
    axes.set_aspect("equal")
