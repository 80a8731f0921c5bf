"""A few numbers that stand for very many, close for what is nearly the same and apart for all else.

A hash would differ after the least rounding. Sums against fixed patterns do not: a change of 1e-10 in every value
changes them by about as little, while another curve, another seed or one changed pixel changes them visibly.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: Directions and wavelengths, in box units, of the waves that a drawing is weighed with; incommensurable.
WAVES = (
    2.0
    * np.pi
    * np.array(
        [
            [0.31, 0.17],
            [1.13, -0.71],
            [0.59, 2.03],
            [-3.37, 1.91],
            [5.71, 3.13],
            [2.89, -9.07],
            [17.3, 6.1],
            [-11.9, 23.7],
        ]
    )
)
_PHASES = np.array([0.1, 0.7, 1.3, 1.9, 2.3, 2.9, 3.7, 4.3])

SIGNS = 4
BLOCKS = 16
MOST_VALUES = 40

_DIGITS = 6


def line_waves(starts: Array, ends: Array) -> Array:
    """Return the integrals of the waves along segments; they do not depend on how a line is cut into segments.

    Parameters
    ----------
    starts, ends
        Shape (n, 2), in box units.

    Returns
    -------
    ndarray
        The length, then one number for each wave.
    """
    length = np.hypot(*(ends - starts).T)
    middle, half = (starts + ends) / 2.0, (ends - starts) / 2.0
    return np.array([length.sum(), *((length * _wave(middle, half, i)).sum() for i in range(len(WAVES)))])


def point_waves(points: Array) -> Array:
    """Return the number of points and their sums against the waves; their order does not matter."""
    still = np.zeros_like(points)
    return np.array([float(len(points)), *(_wave(points, still, i).sum() for i in range(len(WAVES)))])


def _wave(points: Array, half: Array, i: int) -> Array:
    # The mean of cos over a segment is its value in the middle times sinc of half the phase along it.
    return np.asarray(np.cos(points @ WAVES[i] + _PHASES[i]) * np.sinc(half @ WAVES[i] / np.pi))


def sign_sums(values: Array) -> Array:
    """Return the sums of values under fixed signs, divided by the square root of their number.

    Examples
    --------
    >>> import numpy as np
    >>> one = np.linspace(0.0, 1.0, 10_000)
    >>> other = one.copy()
    >>> other[5000] += 0.1
    >>> bool(np.abs(sign_sums(one * (1 + 1e-10)) - sign_sums(one)).max() < 1e-7)
    True
    >>> bool(np.abs(sign_sums(other) - sign_sums(one)).min() > 0.9e-3)
    True
    """
    flat = np.nan_to_num(np.ravel(values), nan=0.0, posinf=0.0, neginf=0.0)
    if not flat.size:
        return np.zeros(SIGNS)
    bits = _hashed(np.arange(flat.size, dtype=np.uint64))
    signs = [((bits >> np.uint64(7 * i + 3)) & np.uint64(1)).astype(float) * 2.0 - 1.0 for i in range(SIGNS)]
    return np.array([float(sign @ flat) for sign in signs]) / math.sqrt(flat.size)


def _hashed(numbers: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Return the finaliser of splitmix64 (Steele, Lea, Flood, OOPSLA 2014) of every number."""
    with np.errstate(over="ignore"):
        mixed = numbers * np.uint64(0x9E3779B97F4A7C15)
        mixed = (mixed ^ (mixed >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        mixed = (mixed ^ (mixed >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
        result: NDArray[np.uint64] = np.asarray(mixed ^ (mixed >> np.uint64(31)))
        return result


def values_digest(values: Array) -> dict[str, Any]:
    """Describe many numbers, or rows of numbers, in a given order: how many, the means of blocks, the sign sums."""
    rows = np.asarray(values, dtype=float).reshape(len(values), -1)
    blocks = [block.mean(axis=0) for block in np.array_split(rows, min(BLOCKS, len(rows)))]
    return {"n": len(rows), "means": [rounded(block) for block in blocks], "signs": rounded(sign_sums(rows))}


def rounded(values: Array | Sequence[float], digits: int = _DIGITS) -> list[float]:
    """Return numbers for JSON; no negative zero, and a large number if one is infinite."""
    finite = np.nan_to_num(np.asarray(values, dtype=float), nan=0.0, posinf=1e30, neginf=-1e30)
    return [float(f"{value:.{digits}g}") + 0.0 for value in np.ravel(finite)]
