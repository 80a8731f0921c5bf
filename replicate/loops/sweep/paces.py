"""The columns of a block by their pace: loops that share a unit of time.

With dead time it is the dead time, and all go together. Without, a loop is as quick as its fastest pole, and gains that
differ much make loops of very different pace: each group has a unit of time of its own.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from replicate.loops.controller import PID
from replicate.loops.plant import Plant
from replicate.loops.sweep.loop_columns import LoopColumns, Places
from replicate.loops.sweep.stability_counts import polynomial_roots

Array = NDArray[np.float64]

PACE = 4.0  # largest modulus of the closed loop's poles, in a group's unit of time
FEWEST = 4  # loops below which a block costs more than they do one by one


def by_pace(plant: Plant, form: PID, gains: tuple[Array, Array, Array, Array]) -> Iterator[tuple[Places, LoopColumns]]:
    """Yield places and columns of loops that share a unit of time; those that share it with too few are left out."""
    whole = LoopColumns.of(plant, form, *gains)
    if plant.dead_time:
        yield np.arange(len(whole)), whole
        return
    closed = np.repeat(whole.den[:, None], len(whole), axis=1)
    closed[closed.shape[0] - whole.num.shape[0] :] += whole.num
    poles, _ = polynomial_roots(closed)
    with np.errstate(divide="ignore"):
        octave = np.ceil(np.log2(np.abs(poles).max(axis=0)))
    for pace in np.unique(octave[np.isfinite(octave)]):
        places = np.nonzero(octave == pace)[0]
        if places.size >= FEWEST:
            time = whole.time * PACE / 2.0**pace
            yield places, LoopColumns.of(plant, form, *(gain[places] for gain in gains), time=time)
