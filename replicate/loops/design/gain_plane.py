"""Stability and Ms over the plane of the PI gains."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from replicate.loops import checks
from replicate.loops.controller import PI
from replicate.loops.errors import ImproperLoopError, UnstableLoopError
from replicate.loops.loop import Loop
from replicate.loops.plant import Plant
from replicate.loops.records import Record

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class GainPlane(Record):
    """Ms of a plant under PI control.

    Attributes
    ----------
    k : array, shape (n,)
        Proportional gains.
    ki : array, shape (m,)
        Integral gains.
    ms : array, shape (m, n)
        The sensitivity peak, ``nan`` where the loop is unstable.
    """

    k: Array
    ki: Array
    ms: Array


def gain_plane(plant: Plant, k: ArrayLike, ki: ArrayLike) -> GainPlane:
    """Return Ms for all pairs of gains.

    Parameters
    ----------
    plant
        The plant.
    k, ki : array
        Gains.

    Raises
    ------
    LoopError
        If the plant is not a Plant, a gain not a finite number, or Ms not known for a stable loop.
    """
    checks.instance("the plant of a gain plane", plant, Plant, "a Plant")
    columns, rows = (np.array([checks.finite(name, x) for x in np.atleast_1d(given)])
                     for name, given in (("k", np.asarray(k)), ("ki", np.asarray(ki))))  # fmt: skip
    return GainPlane(columns, rows, np.array([[_ms(plant, a, b) for a in columns] for b in rows]))


def _ms(plant: Plant, k: float, ki: float) -> float:
    try:
        return Loop(plant, PI(k, ki)).sensitivity_peak().value
    except (ImproperLoopError, UnstableLoopError):
        return float("nan")
