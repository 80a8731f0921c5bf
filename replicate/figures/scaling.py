"""Curves as they look: in fractions of the width and height of their axes.

In these units a tolerance means the same for every figure, and a logarithmic axis is as wide as it is drawn.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from replicate.figures.differences import RELATIVE
from replicate.figures.polylines import Points

#: Curves are the same up to this fraction of the size of their axes: far less than one could see, and a few
#: times the error of thinning.
TOLERANCE = 2e-4


def in_units(points: Points, axes: Mapping[str, Any]) -> Points:
    """Return points as fractions of the axes; a logarithmic axis is measured in its logarithm.

    Examples
    --------
    >>> import numpy as np
    >>> axes = {"xlim": [1.0, 100.0], "xscale": "log", "ylim": [0.0, 4.0]}
    >>> in_units(np.array([[10.0, 1.0]]), axes).tolist()
    [[0.5, 0.25]]
    """
    columns = []
    for place, axis in enumerate("xy"):
        values, (low, high) = points[:, place], _limits(axes, axis)
        if axes.get(f"{axis}scale") == "log":
            with np.errstate(all="ignore"):
                values = np.log(values)
        columns.append((values - low) / (high - low))
    return np.column_stack(columns)


def finite(points: Points) -> NDArray[np.bool_]:
    """Return which points are there; the others are breaks, or have no place on a logarithmic axis."""
    return np.asarray(np.logical_and.reduce(np.isfinite(points), axis=1))


def from_units(value: float, axes: Mapping[str, Any], axis: str) -> float:
    """Return the data coordinate of a fraction of an axis."""
    low, high = _limits(axes, axis)
    scaled = low + value * (high - low)
    return float(np.exp(scaled)) if axes.get(f"{axis}scale") == "log" else float(scaled)


def rounding(axes: Mapping[str, Any], axis: str) -> float:
    """Return what rounding may do to the values on an axis, as a fraction of it.

    It matters where an axis shows a small change of a large value.
    """
    if axes.get(f"{axis}scale") == "log":
        return 0.0
    low, high = _limits(axes, axis)
    return RELATIVE * max(abs(low), abs(high)) / abs(high - low)


def _limits(axes: Mapping[str, Any], axis: str) -> tuple[float, float]:
    limits = np.asarray(axes.get(f"{axis}lim", (0.0, 1.0)), dtype=float)
    if axes.get(f"{axis}scale") == "log":
        limits = np.log(limits)
    return float(limits[0]), float(limits[1])
