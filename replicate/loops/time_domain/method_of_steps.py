"""Exact time responses by a spectral method of steps.

Time is cut into pieces of length ``dead_time / m``. On each piece the chain (`replicate.loops.time_domain.chain`) is
solved in integral form on Chebyshev-Lobatto nodes,

    (I - h/2 S (x) A) X = 1 (x) X_0 + h/2 (S (x) B) v + h/2 (S 1 (x) E) r,

S being the Chebyshev integration matrix: one fixed linear map from (delayed input, state at the start, reference) to
(control signal, output, state at the end). Kinks and jumps fall on the ends of pieces, so every piece is smooth and the
result converges spectrally. The number of pieces is raised until the last Chebyshev coefficients are at rounding level.

Without dead time the loop is closed inside the piece, which makes it an ordinary linear differential equation.

Reference: Bellman and Cooke, "Differential-Difference Equations" (1963), chapter 3, for the method of steps.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from replicate.loops.controller import PID
from replicate.loops.errors import ImproperLoopError, LoopError
from replicate.loops.frequency_domain.loop_transfer import ILL_POSED
from replicate.loops.kept import Kept
from replicate.loops.numerics import chebyshev
from replicate.loops.plant import Plant
from replicate.loops.time_domain.chain import Chain, build_chain, gains
from replicate.loops.time_domain.many_pieces import carried, march_together

Array = NDArray[np.float64]

DEGREE = 18
RESOLVED = 2e-14  # size of the last coefficients relative to the largest, at which a piece counts as resolved
NEARLY = 1e-9  # size up to which coefficients that no longer fall are the rounding error of the problem
WHOLE = 1e-14  # of a number of pieces: what is not a piece more
STIFFNESS = 3.5  # largest (spectral radius x piece length) to start from
MOST_PIECES = 2000  # beyond, pieces that adapt are faster
LARGEST = 1e100  # size of a diverging response at which its metrics could overflow
TINY = float(np.finfo(float).tiny)
FEW = 4  # dead times, up to which responses go on piece by piece; also up to PAYS for each piece of a dead time, whose
PAYS = 3  # map costs the square of their number
MOST_ALONE = 8  # responses; more of them go on together, piece by piece


@dataclass(frozen=True)
class PieceMap:
    """The fixed map of one piece, as matrices acting on the node values of v, the start state and the unit set-point.

    Shapes, with p = DEGREE + 1 nodes and n states: ``basis`` (4, p, p + n + 1), ``output`` (p, p + n + 1) and ``state``
    (n, p + n + 1); the columns are v at the nodes, the state, and r.
    """

    basis: Array
    output: Array
    state: Array


def piece_map(chain: Chain, length: float, degree: int = DEGREE) -> PieceMap:
    """Return the map of a piece; loops of one plant whose gains are scaled alike share it."""
    parts = (chain.a, chain.b, chain.e, chain.c, chain.d, chain.wx, chain.wv, chain.wr)
    key = (length, degree, *(part.tobytes() for part in parts))
    return _MAPS.get(key, lambda: _solved_map(chain, length, degree))


_MAPS: Kept[PieceMap] = Kept(64)


def _solved_map(chain: Chain, length: float, degree: int) -> PieceMap:
    """Solve the collocation system of one piece for all its inputs at once."""
    points, n = degree + 1, chain.e.size
    half_s = 0.5 * length * chebyshev.integration(degree)
    right = np.zeros((points, n, points + n + 1))
    right[:, :, :points] = half_s[:, None, :] * chain.b[None, :]
    right[:, :, points:-1] = np.eye(n)
    right[:, :, -1] = half_s.sum(axis=1)[:, None] * chain.e
    states = _solved(half_s, chain.a, right)

    through = np.zeros((points, points + n + 1))
    through[:, :points] = np.eye(points)
    output = np.einsum("i,pic->pc", chain.c, states) + chain.d[0] * through
    basis = np.einsum("wi,pic->wpc", chain.wx, states) + chain.wv[:, :, None] * through
    basis[:, :, -1] += chain.wr[:, None]
    return PieceMap(basis, output, states[-1])


def _solved(half_s: Array, a: Array, right: Array) -> Array:
    """Solve (I - S/2 (x) A) X = right for the states at the nodes, shape (points, n, columns)."""
    points, n = half_s.shape[0], a.shape[0]
    if n == 0:
        return right
    system = (half_s[:, None, :, None] * -a[:, None, :]).reshape(points * n, points * n)
    system.flat[:: points * n + 1] += 1.0
    return np.asarray(np.linalg.solve(system, right.reshape(points * n, -1)).reshape(points, n, -1), dtype=float)


def respond(
    plant: Plant, controllers: Sequence[PID], until: float, *, setpoint: float, load: float, unit: float = 1.0
) -> list[tuple[Array, Array, Array]] | None:
    """Compute output and control signal of one plant under several controllers that differ only in k, ki, kd and b.

    Parameters
    ----------
    until
        Horizon.
    setpoint, load
        Heights of the steps at t = 0 in the set-point and at the plant input (before the dead time).
    unit
        Unit of time in the user's, for messages.

    Returns
    -------
    list of tuple, or None
        For each controller breaks and the Chebyshev coefficients of output and control signal,
        shape (pieces, DEGREE + 1); None if more than MOST_PIECES pieces were needed.

    Raises
    ------
    LoopError
        If the controllers differ in more than their gains, or the response grows out of range.
    """
    chain, gain_matrix = _common_chain(plant, controllers)
    closed = [] if plant.dead_time else [_close(chain, g) for g in gain_matrix.T]
    radius = max(_RADII.get((a.shape, a.tobytes()), partial(_radius, a)) for a in [c.a for c in closed] or [chain.a])
    splits = max(1, int(np.ceil((plant.dead_time or until) * radius / STIFFNESS)))
    previous = float("inf")
    to_coefficients = chebyshev.values_to_coefficients(DEGREE).T
    while True:
        length = (plant.dead_time or until) / splits
        pieces = max(int(np.ceil(until / length * (1.0 - WHOLE))), 1)
        if pieces > MOST_PIECES:
            return None
        with np.errstate(over="ignore", invalid="ignore"):
            if plant.dead_time:
                values = _march(chain, gain_matrix, length, splits, pieces, setpoint, load)
            else:
                parts = [_march_closed(c, chain, length, pieces, setpoint, load) for c in closed]
                values = np.stack([[p[i] for p in parts] for i in range(2)])
            found = values @ to_coefficients
        remaining = _unresolved(found, length * unit)
        # halving the pieces no longer helps once the tail is the rounding error of an ill-conditioned plant
        if remaining <= RESOLVED or (remaining < NEARLY and remaining > 0.25 * previous):
            breaks, share = chebyshev.cut(length, pieces, until)
            return [(breaks, y, u) for y, u in zip(*chebyshev.cut_last(found, share), strict=True)]
        previous = remaining
        splits *= 2


def _radius(a: Array) -> float:
    """Return the largest modulus of an eigenvalue."""
    return float(np.max(np.abs(np.linalg.eigvals(a)), initial=0.0))


_RADII: Kept[float] = Kept(64)


def _common_chain(plant: Plant, controllers: Sequence[PID]) -> tuple[Chain, Array]:
    first = controllers[0]
    shape = ("c", "derivative_filter", "measurement_filter", "measurement_filter_order", "setpoint_filter")
    for other in controllers[1:]:
        for name in shape:
            if getattr(other, name) != getattr(first, name):
                msg = f"controllers in one sweep must share {name}: {getattr(first, name)} and {getattr(other, name)}"
                raise LoopError(msg)
    gain_matrix = np.stack([gains(controller) for controller in controllers], axis=1)
    chain = build_chain(plant, first, integral=bool(gain_matrix[2].any()), derivative=bool(gain_matrix[3].any()))
    return chain.balanced(np.max(np.abs(gain_matrix), axis=1)), gain_matrix


def _unresolved(coefficients: Array, length: float) -> float:
    """Return the size of the last two coefficients relative to the largest, the worst of all signals.

    Shape (2, controllers, pieces, points), output and control signal; LoopError if they grow out of range.
    """
    sizes = np.abs(coefficients)
    largest = sizes.max(axis=(2, 3))
    if not np.all(largest < LARGEST):
        beyond = int(np.argmin(sizes.max(axis=(0, 1, 3)) < LARGEST))
        msg = f"the response grows beyond {LARGEST:g} by t = {(beyond + 1) * length:g}: choose a shorter horizon"
        raise LoopError(msg)
    return float(np.max(sizes[..., -2:].max(axis=(2, 3)) / np.maximum(largest, TINY)))


def _march(
    chain: Chain, gain_matrix: Array, length: float, splits: int, pieces: int, setpoint: float, load: float
) -> Array:
    """Step through the pieces; returns node values of y and u, shape (2, controllers, pieces, points)."""
    fixed = piece_map(chain, length)
    points, n, sweep = DEGREE + 1, chain.e.size, gain_matrix.shape[1]
    many = pieces > max(FEW, PAYS * splits) * splits
    if many and sweep <= MOST_ALONE and not (gain_matrix[3] * chain.setpoint_impulse).any():
        alone = [np.concatenate([np.tensordot(g, fixed.basis, 1), fixed.output, fixed.state]) for g in gain_matrix.T]
        start = chain.start * setpoint
        return np.stack([march_together(rows, splits, start, pieces, setpoint, load) for rows in alone], axis=1)
    history = np.zeros((pieces + splits, points, sweep))  # u, shifted by one dead time
    output = np.empty((pieces, points, sweep))
    inputs = np.zeros((points + n + 1, sweep))
    used = gain_matrix.any(axis=1)
    own, size = gain_matrix[used], int(used.sum()) * points
    blocks = np.concatenate([fixed.basis[used].reshape(size, inputs.shape[0]), fixed.output, fixed.state])
    inputs[-1] = setpoint
    inputs[points:-1] = chain.start[:, None] * setpoint
    impulse = gain_matrix[3] * chain.setpoint_impulse * setpoint
    feedback = gain_matrix[3] * chain.wv[3, 0]  # an impulse in v passes through the ideal derivative into u
    result = np.empty((blocks.shape[0], sweep))
    has_impulse = bool(impulse.any())
    for j in range(pieces):
        inputs[:points] = history[j]
        if load and j >= splits:
            inputs[:points] += load
        if has_impulse and j >= splits and j % splits == 0:
            inputs[points:-1] += chain.b * impulse
            impulse = feedback * impulse
        np.matmul(blocks, inputs, out=result)
        history[j + splits] = np.einsum("ws,wps->ps", own, result[:size].reshape(own.shape[0], points, sweep))
        output[j] = result[size : size + points]
        inputs[points:-1] = result[size + points :]
    return np.stack([np.moveaxis(output, 2, 0), np.moveaxis(history[splits:], 2, 0)])


@dataclass(frozen=True)
class _Closed:
    """The loop closed without dead time: X' = a X + b (load) + e (set-point), u = ux X + ud (load) + ur (set-point)."""

    a: Array
    b: Array
    e: Array
    ux: Array
    ud: float
    ur: float
    impulse: float


def _close(chain: Chain, g: Array) -> _Closed:
    # u = g.(W_x X + W_v v + W_r r) with v = u + load
    through, b = float((g @ chain.wv)[0]), chain.b[:, 0]
    algebraic = 1.0 - through
    if abs(algebraic) < ILL_POSED:
        msg = "the loop without dead time is not well posed: its algebraic feedback equals one"
        raise ImproperLoopError(msg)
    ux, ud, ur = g @ chain.wx / algebraic, through / algebraic, float(g @ chain.wr) / algebraic
    return _Closed(
        chain.a + np.outer(b, ux), b * (1.0 + ud), chain.e + b * ur, ux, ud, ur,
        g[3] * chain.setpoint_impulse / algebraic,
    )  # fmt: skip


def _march_closed(
    closed: _Closed, chain: Chain, length: float, pieces: int, setpoint: float, load: float
) -> tuple[Array, Array]:
    points, n = DEGREE + 1, chain.e.size
    half_s = 0.5 * length * chebyshev.integration(DEGREE)
    drive = closed.b * load + closed.e * setpoint
    right = np.zeros((points, n, n + 1))
    right[:, :, :n] = np.eye(n)
    right[:, :, n] = half_s.sum(axis=1)[:, None] * drive
    flow = _solved(half_s, closed.a, right)
    # output and control signal at the nodes, from the state at the piece's start
    u, y = np.tensordot(closed.ux, flow, (0, 1)), np.tensordot(chain.c, flow, (0, 1))
    u[:, n] += closed.ud * load + closed.ur * setpoint
    y += chain.d[0] * u
    y[:, n] += chain.d[0] * load
    end = np.zeros((n + 1, n + 1))
    end[:n], end[n, n] = flow[-1], 1.0
    starts = carried(end, np.append((chain.b[:, 0] * closed.impulse + chain.start) * setpoint, 1.0), pieces)
    return (y @ starts).T, (u @ starts).T
