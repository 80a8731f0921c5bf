"""One piece of a march through time: the fixed linear map from what enters it to what it holds.

A piece may be longer than a dead time: then its own control signal enters it, and the loop is closed inside the piece.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from replicate.loops.errors import LoopError
from replicate.loops.numerics import chebyshev
from replicate.loops.time_domain.chain import Chain

Array = NDArray[np.float64]

DEGREE = 18
SAME = 1e-12  # relative distance of two times that are one

MOST_PIECES = 200_000  # of a march
STARTING = 3.5  # first piece of a march, in units of the fastest time constant
SMOOTHEST = 12  # order of a derivative whose jump, when it arrives, no longer has to fall on the end of a piece
SMALLEST_JUMP = 1e-17  # of the jump that set it off: one that is rounding


@dataclass(frozen=True)
class Row:
    """A signal u = x . X + v . (delayed inputs) + r . (set-point) of a chain."""

    x: Array
    v: Array
    r: float


@dataclass(frozen=True)
class PieceFlow:
    """Matrices of one piece, from (inputs known at the nodes, state at the start, set-point) to what it holds.

    Shapes, with p = DEGREE + 1 nodes, n states, m dead times and q = m p + n + 1 columns: ``u`` and ``y`` (p, q), node
    values of the fed back signal and of the output; ``v`` (m, p, q), the delayed inputs; ``x`` (p, n, q), the states.
    """

    u: Array
    y: Array
    v: Array
    x: Array


def too_many_pieces(most: int, until: float) -> LoopError:
    """Return the error of a response up to a time, in the user's unit, that needs too many pieces."""
    return LoopError(f"the response needs more than {most} pieces up to t = {until:g}: choose a shorter horizon")


def piece_flow(chain: Chain, row: Row, delays: Array, h: float, *, closed: bool = True) -> PieceFlow:
    """Return the map of a piece of length ``h``.

    Parameters
    ----------
    row
        The control signal.
    delays
        The dead times, one for each input of the chain.
    closed
        Whether the control signal itself enters the piece where the piece is longer than a dead time. If not, all
        inputs are known.
    """
    points, n, m = DEGREE + 1, chain.e.size, delays.size
    half_s = 0.5 * h * chebyshev.integration(DEGREE)
    own = [_own_part(h, float(delay)) if closed else np.zeros((points, points)) for delay in delays]
    enter = [np.kron(half_s, chain.b[:, [i]]) for i in range(m)]
    # the state from (known inputs, start state, set-point, own control signal), then the control signal itself
    right = np.zeros((points * n, (m + 1) * points + n + 1))
    for i in range(m):
        right[:, i * points : (i + 1) * points] = enter[i]
        right[:, -points:] += enter[i] @ own[i]
    right[:, m * points : m * points + n] = np.kron(np.ones((points, 1)), np.eye(n))
    right[:, m * points + n] = np.kron(half_s.sum(axis=1), chain.e)
    states = np.linalg.solve(np.eye(points * n) - np.kron(half_s, chain.a), right) if n else right
    through = np.kron(np.eye(points), row.x) @ states
    for i in range(m):
        through[:, i * points : (i + 1) * points] += row.v[i] * np.eye(points)
        through[:, -points:] += row.v[i] * own[i]
    through[:, m * points + n] += row.r
    fed_back = np.eye(points) - through[:, -points:]
    u = np.linalg.solve(fed_back, through[:, :-points]) if any(part.any() for part in own) else through[:, :-points]
    x = (states[:, :-points] + states[:, -points:] @ u).reshape(points, n, u.shape[1])
    v = np.array([part @ u for part in own])
    for i in range(m):
        v[i, :, i * points : (i + 1) * points] += np.eye(points)
    y = np.einsum("i,pic->pc", chain.c, x) + np.einsum("i,ipc->pc", chain.d, v)
    return PieceFlow(np.asarray(u), np.asarray(y), v, x)


def delayed_values(
    breaks: Sequence[float], control: Sequence[Array], start: float, h: float, delay: float
) -> tuple[Array, NDArray[np.bool_]]:
    """Return a signal one dead time ago on the nodes of a piece, as far as earlier pieces hold it.

    Parameters
    ----------
    breaks, control
        The earlier pieces: their ends, and the Chebyshev coefficients on each.
    start, h
        Start and length of the piece.

    Returns
    -------
    values, earlier
        Node values, zero where the piece's own signal has arrived; and where it has not.
    """
    nodes = start + 0.5 * h * (chebyshev.nodes(DEGREE) + 1.0)
    values = np.zeros(nodes.size)
    earlier = _earlier(nominal(h), delay)
    times = nodes[earlier] - delay
    if times.size == 0 or not control:
        return values, earlier
    middle = 0.5 * (times[0] + times[-1]) if times.size > 1 else times[0] + 0.25 * min(h, delay)
    first, last = (min(bisect_right(breaks, t) - 1, len(control) - 1) for t in (times[0], times[-1]))
    central = min(bisect_right(breaks, middle) - 1, len(control) - 1)
    if central < 0:
        return values, earlier
    slack = SAME * start
    if times[0] >= breaks[central] - slack and times[-1] <= breaks[central + 1] + slack:
        read = _read(breaks, control, central, times)
    else:
        first, last = max(first, 0), max(last, 0)
        between = breaks[first + 1 : last + 1]  # the few that matter: a list is made an array as a whole
        pieces = first + np.searchsorted(between, times, side="right")
        parts = [_read(breaks, control, int(piece), times[pieces == piece]) for piece in np.unique(pieces)]
        read = np.concatenate(parts)
    values[earlier] = np.where(times >= -slack, read, 0.0) if times[0] < -slack else read
    return values, earlier


def _read(breaks: Sequence[float], control: Sequence[Array], piece: int, times: Array) -> Array:
    """Return the values of a signal at times of one of its pieces."""
    left, right = breaks[piece], breaks[piece + 1]
    return chebyshev.valued(control[piece], 2.0 * (times - left) / (right - left) - 1.0)  # which clips


@lru_cache(maxsize=256)
def _earlier(h: float, delay: float) -> NDArray[np.bool_]:
    earlier = ~later(h, delay)
    earlier.flags.writeable = False
    return earlier


def integrations(chain: Chain, row: Row, i: int, *, most: int) -> int:
    """Return how many times the i-th input is integrated before it shows in a signal; ``most`` if it never does."""
    if row.v[i]:
        return 0
    reached, size = chain.b[:, i], np.abs(chain.b[:, i])
    for order in range(1, chain.e.size + 1):
        if abs(float(row.x @ reached)) > SAME * float(np.abs(row.x) @ size):
            return order
        reached, size = chain.a @ reached, np.abs(chain.a) @ size
    return most


def _own_part(h: float, delay: float) -> Array:
    """Return the matrix that reads a piece's own polynomial one dead time ago, zero where that is before the piece."""
    x = chebyshev.nodes(DEGREE) - 2.0 * delay / h
    matrix = chebyshev.basis(np.maximum(x, -1.0), DEGREE).T @ chebyshev.values_to_coefficients(DEGREE)
    return np.where(later(h, delay)[:, None], matrix, 0.0)


def later(h: float, delay: float) -> NDArray[np.bool_]:
    """Return which nodes of a piece come more than a dead time after its start; without dead time, all do."""
    if delay == 0.0:
        return np.ones(DEGREE + 1, dtype=bool)
    return np.asarray(0.5 * h * (chebyshev.nodes(DEGREE) + 1.0) > delay * (1.0 + SAME))


def nominal(h: float) -> float:
    """Return a length without its rounding error: lengths that differ by no more share a map."""
    return float(f"{h:.13e}")
