"""The extreme values of a function of one variable: bracketed on a grid, then found by optimisation."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

Array = NDArray[np.float64]


def largest(f: Callable[[Any], Any], grid: Array, values: Array | None = None) -> tuple[float, float]:
    """Return where a function is largest between the ends of a grid, and how large.

    Parameters
    ----------
    f
        The function; continuous, and with no two maxima between neighbouring points of the grid.
    grid
        Shape (n,), ascending.
    values
        The function on the grid, shape (n,), if they are known; ``f(grid)`` for one that works elementwise.

    Examples
    --------
    >>> at, value = largest(lambda x: x * (1.0 - x), np.linspace(0.0, 0.9, 4))
    >>> round(at, 6), round(value, 6)
    (0.5, 0.25)
    """
    known = np.array([float(f(float(x))) for x in grid]) if values is None else values
    best = int(np.argmax(known))
    at, value = float(grid[best]), float(known[best])
    inside = (float(grid[max(best - 1, 0)]), float(grid[min(best + 1, grid.size - 1)]))
    found = minimize_scalar(lambda x: -float(f(float(x))), bounds=inside, method="bounded", options={"xatol": 1e-10})
    return (float(found.x), -float(found.fun)) if -found.fun > value else (at, value)


def smallest(f: Callable[[Any], Any], grid: Array, values: Array | None = None) -> tuple[float, float]:
    """Return where a function is smallest between the ends of a grid, and how small.

    Parameters
    ----------
    f, grid, values
        As for `largest`; no two minima between neighbouring points.

    Examples
    --------
    >>> at, value = smallest(lambda x: (x - 0.3) ** 2, np.linspace(0.0, 1.0, 5))
    >>> round(at, 6), round(value, 6)
    (0.3, 0.0)
    """
    at, value = largest(lambda x: -f(x), grid, None if values is None else -values)
    return at, -value
