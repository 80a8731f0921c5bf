"""PID settings of Example 2's plant that minimise the ISTE, the criterion of the competing settings."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from replicate.loops import PID, Loop
from replicate.papers.ali.examples import EXAMPLE_2
from replicate.papers.ali.structures import Settings, plant, series

Array = NDArray[np.float64]
Kind = Literal["setpoint", "load"]

UNTIL = 8.0  # the best responses have settled long before
NODES, WEIGHTS = np.polynomial.legendre.leggauss(16)  # per dead time, inside of which a response is smooth
START = Settings(3.0, 1.5, 0.1)  # stable in every form


def parallel(settings: Settings) -> PID:
    """Return the parallel form without derivative filter, all of it acting on the error."""
    return PID.ideal(settings.Kp, settings.Ti, settings.Td, b=1.0, c=1.0)


FORMS: dict[str, Callable[[Settings], PID]] = {"parallel": parallel, "series": series}


def iste(controlled: Loop, kind: Kind) -> float:
    r"""Return :math:`\int_0^\infty t^2 e^2\,dt` after a unit step of the set point or of a load at the plant input."""
    return float(np.sum(_residuals(controlled, kind) ** 2))


def _residuals(controlled: Loop, kind: Kind) -> Array:
    """Return numbers whose squares add up to the ISTE: the weighted errors at the nodes of Gauss' rule."""
    step = 1.0 if kind == "setpoint" else 0.0
    output = controlled.respond(setpoint=step, load=1.0 - step, until=UNTIL).output
    half = 0.5 * controlled.plant.dead_time
    starts = np.arange(0.0, UNTIL - half, 2.0 * half)
    times = (starts[:, None] + half * (1.0 + NODES)).ravel()
    weights = np.tile(half * WEIGHTS, starts.size)
    return np.asarray(np.sqrt(weights) * times * (step - output(times)))


@cache
def best(form: str, kind: Kind) -> Settings:
    """Return the settings with the smallest ISTE, to three digits.

    Raises
    ------
    ValueError
        If the search does not converge, or ends at an unstable loop.
    """

    def closed(logarithms: Array) -> Loop:
        return Loop(plant(float(EXAMPLE_2)), FORMS[form](Settings(*np.exp(logarithms).tolist())))

    def residuals(logarithms: Array) -> Array:
        return _residuals(closed(logarithms), kind)

    start = np.log([START.Kp, START.Ti, START.Td])
    found = least_squares(residuals, start, method="lm", xtol=1e-7, ftol=1e-11)
    if not found.success or not closed(found.x).is_stable():
        msg = f"ISTE, {form} form, {kind}: {found.message}"
        raise ValueError(msg)
    return Settings(*(float(f"{value:.3g}") for value in np.exp(found.x)))
