"""The cut of a function on the negative real axis: what jumps across it, and where it begins."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Function = Callable[[Any], ComplexArray]

BESIDE = 1e-30  # rad between the axis and where the upper side of a cut is evaluated
CLEAR = 1e-3  # share by which a jump depends on that distance: one that is a slope across the axis does wholly
REAL, ROUNDING = 1e-6, 1e-11  # imaginary part, relative to the modulus, of a value that is real, and of one to rounding
RADII = np.geomspace(1e-12, 1e3, 400)  # of the scale, at which a cut is looked for


def jump(function: Function, x: Array) -> Array:
    """Return Im f(-x + i0) for x > 0, half of the jump across the axis; 0 where f is analytic."""
    near, twice = (function(x * complex(-1.0, beside)).imag for beside in (BESIDE, 2.0 * BESIDE))
    return np.where(np.abs(twice - near) <= CLEAR * np.abs(near), near, 0.0)


def has_cut(function: Function, x: Array) -> NDArray[np.bool_]:
    """Return at which points -x the function has a cut or a pole."""
    return _beyond(function, x, REAL) | ~np.isfinite(_modulus(function, x))


def begin_of_cut(function: Function, scale: float) -> float:
    """Return how far from s = 0 the cut on the negative real axis begins, to a tenth; 0 if at rest, ``inf`` without."""
    radius = scale * RADII
    cut = _beyond(function, radius, ROUNDING)
    if not cut.any():
        return float("inf")
    first = int(np.argmax(cut))
    return float(radius[first - 1]) if first else 0.0


def _beyond(function: Function, x: Array, rounding: float) -> NDArray[np.bool_]:
    with np.errstate(all="ignore"):
        return np.abs(jump(function, x)) > rounding * _modulus(function, x)


def _modulus(function: Function, x: Array) -> Array:
    with np.errstate(all="ignore"):
        return np.abs(function(x * complex(-1.0, BESIDE)))
