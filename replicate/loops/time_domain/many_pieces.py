"""Many pieces of one response at once: what enters them follows from powers of one matrix.

What enters a piece is a fixed linear map of what has entered the piece before, or one dead time before where a dead
time is several pieces. The squares of that map carry 2, 4, 8 ... of them on together.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

TOGETHER = 2000  # numbers that are carried on at once: for more, the squares cost more than they save


def march_together(blocks: Array, splits: int, start: Array, pieces: int, setpoint: float, load: float) -> Array:
    """Return node values of output and control signal of one response, shape (2, pieces, points).

    Parameters
    ----------
    blocks
        Rows of the control signal (points), the output (points) and the state (n) at the end of a piece, from the
        delayed control signal at its nodes (points), the state at its start (n) and the set-point (1).
    splits
        Pieces of one dead time.
    start
        State at the start, shape (n,).
    pieces
        How many.
    setpoint, load
        Heights of the steps. The load is added to the control signal before it enters the pieces after the dead time.
    """
    n = start.size
    points = (blocks.shape[0] - n) // 2
    blocks = _of_a_dead_time(blocks, splits, points)
    entering, size = splits * points, blocks.shape[1]
    # what does not change is one: set-point and load
    constant = blocks[:, -1] * setpoint
    flow = np.zeros((size, size))
    flow[:entering, :-1], flow[:entering, -1] = blocks[:entering, :-1], constant[:entering] + load
    flow[entering:-1, :-1], flow[entering:-1, -1] = blocks[2 * entering :, :-1], constant[2 * entering :]
    flow[-1, -1] = 1.0
    first = np.zeros(size)
    first[entering:-1], first[-1] = start, 1.0
    inputs = carried(flow, first, -(-pieces // splits))
    inputs[-1] = setpoint
    leaving = (blocks[: 2 * entering] @ inputs).reshape(2, splits, points, -1)
    # of dead times and their pieces, one after the other
    values = leaving[::-1].transpose(0, 3, 1, 2).reshape(2, -1, points)
    return np.asarray(values[:, :pieces])


def carried(flow: Array, first: Array, count: int) -> Array:
    """Return what a linear map makes of a vector, applied 0, 1, ... count - 1 times, as columns.

    Parameters
    ----------
    flow
        The map, shape (n, n).
    first
        The vector, shape (n,).
    count
        How many columns.
    """
    columns = np.empty((first.size, count))
    columns[:, 0] = first
    done = step = 1
    while done < count:
        most = min(step, count - done)
        np.matmul(flow, columns[:, done - step : done - step + most], out=columns[:, done : done + most])
        done += most
        if done < count and done == 2 * step and done * first.size <= TOGETHER:
            squared = flow @ flow
            if np.isfinite(squared).all():  # what grows beyond all numbers would make no number of what stays zero
                flow, step = squared, done
    return columns


def _of_a_dead_time(blocks: Array, splits: int, points: int) -> Array:
    """Return the rows of all pieces of a dead time, in the order of `march_together`, from what enters them all."""
    if splits == 1:
        return blocks
    n = blocks.shape[0] - 2 * points
    size = splits * points + n + 1
    whole, state = np.zeros((2, splits, points, size)), np.zeros((n, size))
    state[:, splits * points : -1] = np.eye(n)
    for j in range(splits):
        rows = blocks[:, points:-1] @ state
        rows[:, j * points : (j + 1) * points] += blocks[:, :points]
        rows[:, -1] += blocks[:, -1]
        whole[:, j], state = rows[: 2 * points].reshape(2, points, size), rows[2 * points :]
    return np.concatenate([whole.reshape(-1, size), state])
