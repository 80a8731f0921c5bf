"""A sweep in blocks: loops of one plant and one form of controller, few enough to be kept in memory at once."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from replicate.loops.controller import PID
from replicate.loops.plant import Plant
from replicate.loops.sweep.axes import Axis
from replicate.loops.sweep.controller_table import ControllerTable

Places = NDArray[np.intp]

MOST = 4096  # loops of a block: enough to make the price of a call small, few enough for memory


@dataclass(frozen=True)
class Block:
    """Some loops of one plant whose controllers have one form.

    Attributes
    ----------
    plant, form
        What they share.
    places
        Their places in the flattened result.
    rows
        The rows of the controller table.
    """

    plant: Plant
    form: PID
    places: Places
    rows: Places


def grid_blocks(plants: Axis[Plant], controllers: ControllerTable) -> Iterator[Block]:
    """Yield the blocks of every controller on every plant."""
    size = controllers.k.size
    rows_by_form = [np.nonzero(controllers.form == i)[0] for i in range(len(controllers.forms))]
    for i in range(len(plants)):
        plant = plants[i]
        for form, rows in zip(controllers.forms, rows_by_form, strict=True):
            for start in range(0, rows.size, MOST):
                part = rows[start : start + MOST]
                yield Block(plant, form, i * size + part, part)


def pair_blocks(plants: Axis[Plant], controllers: ControllerTable, count: int) -> Iterator[Block]:
    """Yield the blocks of pairs, those of equal plants together; a single plant or controller goes with all."""
    plant_of = np.zeros(count, dtype=np.intp) if plants.single else _equal(plants)
    row_of = np.arange(count) if controllers.k.size == count else np.zeros(count, dtype=np.intp)
    key = plant_of * len(controllers.forms) + controllers.form[row_of]
    order = np.argsort(key, kind="stable")
    edges = [0, *(np.nonzero(np.diff(key[order]))[0] + 1).tolist(), count]
    for begin, end in pairwise(edges):
        first = order[begin]
        plant, form = plants[int(plant_of[first])], controllers.forms[controllers.form[row_of[first]]]
        for start in range(begin, end, MOST):
            places = order[start : min(start + MOST, end)]
            yield Block(plant, form, places, row_of[places])


def _equal(plants: Axis[Plant]) -> Places:
    """Return for each plant the place of the first one that equals it."""
    if plants.numbers is not None:
        _, first, group = np.unique(plants.numbers, axis=0, return_index=True, return_inverse=True)
        return np.asarray(first[group.ravel()])
    known: dict[object, int] = {}
    same = []
    for i in range(len(plants)):
        plant = plants[i]
        key = (plant.num.tobytes(), plant.den.tobytes(), plant.dead_time) if type(plant) is Plant else id(plant)
        same.append(known.setdefault(key, i))
    return np.array(same, dtype=np.intp)
