"""When many responses have settled after a load that enters while the set-point response is still running.

Both responses of a loop are marched in pieces of the same length. Where the load enters at a multiple of it, their sum
is that of the pieces, and what settles is read from the sum as from any other response.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import ceil
from typing import Any

import numpy as np
from numpy.typing import NDArray

from replicate.loops.controller import PID
from replicate.loops.plant import Plant
from replicate.loops.sweep.axes import controller_axis
from replicate.loops.sweep.batch_poles import rightmost_poles
from replicate.loops.sweep.block_metrics import is_batched
from replicate.loops.sweep.controller_table import ControllerTable
from replicate.loops.sweep.loop_columns import LoopColumns, Places
from replicate.loops.sweep.marching import Piece, march
from replicate.loops.sweep.piece_law import WEIGHTS
from replicate.loops.sweep.response_metrics import ResponseMetrics
from replicate.loops.sweep.stability_counts import STABLE, stability
from replicate.loops.time_domain.slow_modes import SETTLED

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complexfloating[Any, Any]]

ALIGNED = 1e-9  # of a piece, by which a load may miss where one begins


def settling_after_load(plant: Plant, controllers: Sequence[PID], load_at: float, band: float = 0.02) -> Array:
    """Return the last times, counted from a unit load step, outside a band around the final value.

    The set-point steps to one at t = 0, the load at the plant input at ``load_at``.

    Parameters
    ----------
    load_at
        A multiple of the dead time.
    band
        Half-width of the band, a fraction of the final value.

    Returns
    -------
    ndarray
        Shape (n,); ``nan`` where the single loop must be asked: an unstable one, one that is too few, too slow or too
        stiff, and one that has settled before the load enters and leaves the band no more.

    Examples
    --------
    >>> from replicate.loops import PI, Loop
    >>> plant = Plant.foptd(gain=1.0, time_constant=1.0, dead_time=1.0)
    >>> controllers = [PI(k, 0.4) for k in (0.3, 0.4, 0.5, 0.6)]
    >>> times = settling_after_load(plant, controllers, load_at=5.0)
    >>> one = Loop(plant, controllers[2]).respond(load=1.0, load_at=5.0, until=60.0).output
    >>> bool(np.isclose(times[2], one.settling_time() - 5.0, rtol=1e-12))
    True
    """
    table = ControllerTable.of(controller_axis(list(controllers)))
    found = np.full(len(controllers), np.nan)
    for place, form in enumerate(table.forms):
        rows = np.nonzero(table.form == place)[0]
        if plant.dead_time and is_batched(plant, form, rows.size):
            loops = LoopColumns.of(plant, form, table.k[rows], table.ki[rows], table.kd[rows], table.b[rows])
            pole, proven = rightmost_poles(loops)
            chosen = np.nonzero((stability(loops)[0] == STABLE) & proven & (pole.real < 0.0))[0]
            if chosen.size:
                settled = _settled(loops.take(chosen), load_at / loops.time, pole[chosen], band)
                found[rows[chosen]] = settled * loops.time
    return found


def _settled(loops: LoopColumns, load_at: float, pole: ComplexArray, band: float) -> Array:
    lasting = 4.0 + ceil(SETTLED / float(np.min(-pole.real)))
    after_step = march(loops, 1.0, 0.0, ceil(load_at) + lasting)
    after_load = march(loops, 0.0, loops.gain, lasting)
    begins = load_at / after_load.lengths[0] if after_load.pieces else 0.5
    shift = round(begins)
    if abs(begins - shift) > ALIGNED or len(after_step.pieces) < shift + len(after_load.pieces):
        return np.full(len(loops), np.nan)
    failed = after_step.failed | after_load.failed | after_step.unresolved | after_load.unresolved
    columns = np.nonzero(~failed)[0]
    pieces = [_sum(*pair, columns) for pair in zip(after_step.pieces[shift:], after_load.pieces, strict=False)]
    found = ResponseMetrics(replace(after_load, final=after_step.final, pieces=pieces, failed=failed))
    time, outside = found.settling_time(band)
    return np.where(found.doubtful | outside | (time == 0.0), np.nan, time)


def _sum(first: Piece, second: Piece, columns: Places) -> Piece:
    """Return the sum of two pieces in some columns, which both have."""
    one, other = (piece.values[:, np.searchsorted(piece.columns, columns)] for piece in (first, second))
    values = one + other
    return Piece(columns, values, values.min(axis=0), values.max(axis=0), WEIGHTS @ values)
