"""Compute the metrics of many loops, block by block."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from replicate.loops import checks
from replicate.loops.controller import PID
from replicate.loops.errors import LoopError
from replicate.loops.one_thread import one_thread
from replicate.loops.plant import Plant
from replicate.loops.sweep.axes import Axis, controller_axis, plant_axis
from replicate.loops.sweep.block_metrics import answered, block_metrics, is_batched
from replicate.loops.sweep.blocks import Block, grid_blocks, pair_blocks
from replicate.loops.sweep.controller_table import ControllerTable
from replicate.loops.sweep.metric_names import POLE, STABLE, checked_metrics
from replicate.loops.sweep.one_loop import LoopMetrics, loop_metrics
from replicate.loops.sweep.paces import by_pace
from replicate.loops.sweep.sweep_result import GRID, PAIRWISE, SweepResult

# The C library of Linux maps blocks of memory that are larger than any it has freed so far (up to 32 MiB), and gives
# them back: each block of loops would ask for its pages anew, a sixth of the time. An array of this size is freed
# first.
KEPT = 31 * 2**20


def sweep(
    plants: Any,
    controllers: Any,
    metrics: str | Iterable[str] = ("overshoot", "settling_time", "iae", "ms"),
    until: float | None = None,
    pairing: str = GRID,
    band: float = 0.02,
) -> SweepResult:
    """Return exact metrics of many loops: every controller on every plant, or pair by pair.

    Only what is asked for is computed, and no response outlives its loop. Each value is the one that `Loop` gives.
    A loop that has no such value (unstable, not settled within ``until``, no final value) has ``nan``, with the reason.

    Parameters
    ----------
    plants : Plant, str, list, array of shape (n, 3), or DataFrame
        Plants of any kind: objects, texts, rows (gain, time constant, dead time); or a data frame with the columns
        ``gain, time_constant, dead_time``, or ``num, den, dead_time``, or ``plant``.
    controllers : PI, PID, str, list, array of shape (n, 2 to 4), or DataFrame
        Objects, texts, rows (k, ki), (k, ki, kd) or (k, ki, kd, b); or a data frame whose columns are parameters of
        `PID`.
    metrics
        Of the set-point step ``overshoot, peak, peak_time, settling_time, rise_time, delay_time, iae, ise, ie, itae,
        itse, total_variation`` (of the control signal), with ``load_`` before the name those of the unit load step, and
        of the loop ``ms, mp, gain_margin, phase_margin, delay_margin, rightmost_pole, stable``. Fractions, degrees and
        the plant's unit of time, as the methods of `Loop` and `Signal`.
    until
        Horizon of the responses; by default each has its own, when every mode has decayed to rounding.
    pairing
        ``grid``: every controller on every plant; ``pairwise``: the first with the first and so on, where a single
        object goes with all.
    band
        Half-width of the settling band, a fraction of the final value.

    Returns
    -------
    SweepResult
        ``result["overshoot"]`` has shape (plants, controllers) of a grid, (pairs,) of pairs; ``result["stable"]`` is
        always there, ``result.reason`` says why values are missing.

    Raises
    ------
    LoopError
        If there are no plants or no controllers, one of them is not valid (the message says which), a metric is
        unknown, or pairs do not match.

    Examples
    --------
    >>> from replicate.loops import Plant
    >>> plants = [Plant([1.0], [1.0, 1.0], dead_time=1.0), Plant([1.0], [1.0, 2.0, 1.0], dead_time=0.5)]
    >>> result = sweep(plants, [(0.5, 0.4), (0.5, 0.0), (9.0, 9.0)], metrics=["overshoot", "gain_margin"])
    >>> result["overshoot"].shape
    (2, 3)
    >>> result["stable"]
    array([[ True,  True, False],
           [ True,  True, False]])
    >>> result.reason[0, 2]
    'the loop is unstable'
    """
    return swept(plants, controllers, checked_metrics(metrics), until, pairing, band)


def swept(
    plants: Any,
    controllers: Any,
    names: tuple[str, ...],
    until: float | None = None,
    pairing: str = GRID,
    band: float = 0.02,
) -> SweepResult:
    """Return the result of a sweep that may ask for the package's own metrics, too; the rest as for `sweep`."""
    band = checks.settling_band(band)
    if until is not None:
        until = checks.positive("the horizon until", until, allowed="a finite time > 0")
    if pairing not in (GRID, PAIRWISE):
        msg = f"pairing must be '{GRID}' or '{PAIRWISE}', not {checks.shown(pairing)}"
        raise LoopError(msg)
    plant_side, controller_side = plant_axis(plants), controller_axis(controllers)
    shape = _shape(plant_side, controller_side, pairing)
    columns = tuple(dict.fromkeys([*names, STABLE]))
    values = {name: _empty(name, shape) for name in columns}
    reason = np.full(shape, "", dtype=object)
    table = ControllerTable.of(controller_side)
    blocks = grid_blocks(plant_side, table) if pairing == GRID else pair_blocks(plant_side, table, shape[0])
    flat = {name: array.reshape(-1) for name, array in values.items()}
    np.empty(KEPT, dtype=np.uint8)
    with one_thread():
        for block in blocks:
            _compute(block, controller_side, table, names, until, band, flat, reason.reshape(-1))
    return SweepResult(
        pairing, _labels(plant_side, pairing, shape), _labels(controller_side, pairing, shape), names, values, reason
    )


def _shape(plants: Axis[Plant], controllers: Axis[PID], pairing: str) -> tuple[int, ...]:
    if pairing == GRID:
        return len(plants), len(controllers)
    if len(plants) == len(controllers) or plants.single or controllers.single:
        return (max(len(plants), len(controllers)),)
    msg = f"pairs need as many plants as controllers, not {len(plants)} plants and {len(controllers)} controllers"
    raise LoopError(msg)


def _labels(axis: Axis[Any], pairing: str, shape: tuple[int, ...]) -> list[Any]:
    return list(axis.labels) * (shape[0] if pairing == PAIRWISE and axis.single else 1)


def _empty(name: str, shape: tuple[int, ...]) -> NDArray[Any]:
    if name == STABLE:
        return np.zeros(shape, dtype=bool)
    return np.full(shape, complex("nan+nanj") if name == POLE else float("nan"))


def _compute(
    block: Block,
    controllers: Axis[PID],
    table: ControllerTable,
    names: tuple[str, ...],
    until: float | None,
    band: float,
    values: dict[str, NDArray[Any]],
    reason: NDArray[np.object_],
) -> None:
    """Enter the metrics of a block into the flat arrays of the result."""
    places, rows = block.places, block.rows
    alone = np.ones(places.size, dtype=bool)
    together = answered(names) if is_batched(block.plant, block.form, places.size) else ()
    if together:
        gains = table.k[rows], table.ki[rows], table.kd[rows], table.b[rows]
        with np.errstate(over="ignore", invalid="ignore"):  # of gains beyond all measure: left to the single loop
            for part, loops in by_pace(block.plant, block.form, gains):
                found = block_metrics(loops, together, until, band)
                alone[part] = found.alone
                own = places[part]
                values[STABLE][own] = found.stable
                for name, array in found.values.items():
                    values[name][own[~found.alone]] = array[~found.alone]
                for flags, why in found.reasons:
                    for place in own[flags & ~found.alone]:
                        reason[place] = f"{reason[place]}; {why}" if reason[place] else why
    rest = tuple(name for name in names if name not in together)
    for i in np.arange(places.size) if rest else np.nonzero(alone)[0]:
        asked = names if alone[i] else rest
        place = places[i]
        _keep(loop_metrics(block.plant, controllers[int(rows[i])], asked, until, band), place, values, reason)


def _keep(found: LoopMetrics, place: int, values: dict[str, NDArray[Any]], reason: NDArray[np.object_]) -> None:
    values[STABLE][place] = found.stable
    for name, value in found.values.items():
        values[name][place] = value
    reason[place] = "; ".join(dict.fromkeys(part for part in (reason[place], found.reason) if part))
