"""Curves as they look: in fractions of the width and height of their axes.

In these units a tolerance means the same for every figure, and an axis is as wide as it is drawn, whatever its scale:
a logarithmic one is measured in its logarithm; any other that is not linear by a table that was read off it; polar
axes by where angle and radius lie in the picture.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from replicate.figures.differences import RELATIVE
from replicate.figures.polylines import Points

#: Curves are the same up to this fraction of the size of their axes: far less than one could see, and a few
#: times the error of thinning.
TOLERANCE = 2e-4

Array = NDArray[np.float64]
Axes = Mapping[str, Any]

#: What lies further out of view, in sizes of the axes, counts as lying there: a distance can then be squared.
_FAR = 1e50

#: The logarithm of what matplotlib puts in place of values that have none; curves without such values have breaks.
_CLIPPED = -1000.0 * np.log(10.0)


def in_units(points: Points, axes: Axes) -> Points:
    """Return points as fractions of the axes.

    Examples
    --------
    >>> import numpy as np
    >>> axes = {"xlim": [1.0, 100.0], "xscale": "log", "ylim": [0.0, 4.0]}
    >>> in_units(np.array([[10.0, 1.0]]), axes).tolist()
    [[0.5, 0.25]]
    """
    if axes.get("units") == "box":
        units = np.array(points, dtype=float)
    elif "polar" in axes:
        units = _from_polar(points, axes["polar"])
    else:
        units = np.column_stack([_fractions(points[:, place], axes, axis) for place, axis in enumerate("xy")])
    return np.where(np.isfinite(units), np.clip(units, -_FAR, _FAR), units)


def finite(points: Points) -> NDArray[np.bool_]:
    """Return which points are there; the others are breaks."""
    return np.asarray(np.logical_and.reduce(np.isfinite(points), axis=1))


def place_of(units: Sequence[float], axes: Axes) -> tuple[float, float]:
    """Return the data coordinates of a point that is given in fractions of the axes."""
    if axes.get("units") == "box":
        return float(units[0]), float(units[1])
    if "polar" in axes:
        return _to_polar(units, axes["polar"])
    return from_units(float(units[0]), axes, "x"), from_units(float(units[1]), axes, "y")


def from_units(value: float, axes: Axes, axis: str) -> float:
    """Return the data coordinate of a fraction of an axis; of no use on polar axes."""
    if axes.get("units") == "box" or "polar" in axes:
        return value
    if f"{axis}table" in axes:
        data, fractions = _table(axes[f"{axis}table"])
        return float(np.interp(value, fractions, data))
    low, high = _limits(axes, axis)
    scaled = low + value * (high - low)
    return float(np.exp(scaled)) if axes.get(f"{axis}scale") == "log" else float(scaled)


def rounding(axes: Axes, axis: str) -> float:
    """Return what rounding may do to the values on an axis, as a fraction of it.

    It matters where an axis shows a small change of a large value.
    """
    if axes.get(f"{axis}scale") != "linear" or axes.get("units") == "box" or "polar" in axes:
        return 0.0
    low, high = _limits(axes, axis)
    relative = RELATIVE * 1e-3 if axes.get(f"{axis}kind") == "date" else RELATIVE
    return relative * max(abs(low), abs(high)) / abs(high - low)


def _fractions(values: Array, axes: Axes, axis: str) -> Array:
    if f"{axis}table" in axes:
        data, fractions = _table(axes[f"{axis}table"])
        return np.asarray(np.interp(values, data, fractions))  # the table reaches far out of view
    low, high = _limits(axes, axis)
    if axes.get(f"{axis}scale") == "log":
        with np.errstate(all="ignore"):
            values = np.where(values <= 0.0, _CLIPPED, np.log(values))
    with np.errstate(over="ignore"):
        fractions = np.asarray((values - low) / (high - low))
    beyond = np.isfinite(values) & np.isinf(fractions)  # a value is there though its fraction has no number
    return np.where(beyond, np.copysign(_FAR, fractions), fractions)


def _table(table: Mapping[str, Sequence[float]]) -> tuple[Array, Array]:
    """Return data values in increasing order and the fraction of the axis where each is."""
    data = np.asarray(table["data"], dtype=float)
    fractions = np.asarray(table["at"], dtype=float)
    order = np.argsort(data, kind="stable")
    return data[order], fractions[order]


def _limits(axes: Axes, axis: str) -> tuple[float, float]:
    limits = np.asarray(axes.get(f"{axis}lim", (0.0, 1.0)), dtype=float)
    if axes.get(f"{axis}scale") == "log":
        limits = np.log(limits)
    return float(limits[0]), float(limits[1])


def _from_polar(points: Points, polar: Mapping[str, Any]) -> Points:
    """Map angle and radius onto the axes: the disk of radius 1 first, then to where it lies in their box."""
    angle = points[:, 0] * polar["direction"] + polar["offset"]
    radius = _fractions(points[:, 1], polar, "r")
    radius = np.where(radius < -1e-12, np.nan, radius)
    disk = np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])
    matrix = np.reshape(polar["matrix"], (2, 3))
    return np.asarray(disk @ matrix[:, :2].T + matrix[:, 2])


def _to_polar(units: Sequence[float], polar: Mapping[str, Any]) -> tuple[float, float]:
    matrix = np.reshape(polar["matrix"], (2, 3))
    disk = np.linalg.solve(matrix[:, :2], np.asarray(units, dtype=float) - matrix[:, 2])
    angle = (np.arctan2(disk[1], disk[0]) - polar["offset"]) / polar["direction"]
    return float(angle % (2.0 * np.pi)), from_units(float(np.hypot(*disk)), polar, "r")
