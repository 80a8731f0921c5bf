r"""Stability by the argument principle, never by a Pade model.

For the characteristic function :math:`f = D (1 + L)` with D of degree n and |L| finally below one, the number
Z of zeros in the open right half-plane follows from the continuous change of its argument along the imaginary axis,

.. math:: \Delta_{0\to\infty} \arg f(i\omega) = (n - 2 Z) \frac{\pi}{2}.

Beyond the frequency where |L| < 1 for good, 1 + L cannot encircle the origin, so the remainder is known in closed form.
The axis may be shifted to Re s = sigma.

Reference: Michiels and Niculescu, "Stability, Control, and Computation for Time-Delay Systems" (2014), chapter 1.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from replicate.loops.errors import ImproperLoopError
from replicate.loops.frequency_grids import loop_grid
from replicate.loops.loop_transfer import LoopTransfer

Array = NDArray[np.float64]

LARGEST_TURN = 0.8  # rad between neighbouring points; anything below pi/2 identifies the branch
ON_AXIS = 1e-14  # relative distance from the axis at which a root is on it to rounding
DEEPEST = 60  # bisections of one interval before a zero is taken to lie on the axis


def unstable_poles(transfer: LoopTransfer) -> int:
    """Return the number of closed-loop poles with Re s >= 0; a pole on the axis counts as unstable.

    Raises
    ------
    ImproperLoopError
        If the loop is of neutral type with |L| >= 1 at infinite frequency and dead time: it then has infinitely many
        unstable poles.
    """
    if transfer.feedthrough >= 1.0 and transfer.dead_time > 0.0:
        msg = f"|L| tends to {transfer.feedthrough:g} >= 1 at infinite frequency: the loop has infinitely many unstable poles"  # noqa: E501
        raise ImproperLoopError(msg)
    if transfer.dead_time == 0.0 and transfer.plant.is_rational:
        closed = np.polyadd(transfer.den, transfer.num)
        roots = np.roots(closed)
        return int(np.sum(roots.real >= -ON_AXIS * np.abs(roots)))
    end = transfer.beyond(0.5 * (1.0 + transfer.feedthrough))
    w = loop_grid(transfer, end)
    w = np.concatenate([[0.0], w]) if transfer.plant.is_rational else w
    turn = _argument_change(transfer, w)
    if turn is None:
        return 1  # a zero on the axis itself
    poles = np.roots(transfer.den)
    # arg D from the last point to infinity, root by root
    remainder = float(np.sum(0.5 * np.pi - np.angle(1j * end - poles)))
    closing = -float(np.angle(1.0 + transfer(1j * end)))
    degree = transfer.den.size - 1
    zeros = 0.5 * degree - (turn + remainder + closing) / np.pi
    return max(0, round(zeros))


def is_stable(transfer: LoopTransfer) -> bool:
    """Return whether all closed-loop poles lie in the open left half-plane."""
    try:
        return unstable_poles(transfer) == 0
    except ImproperLoopError:
        return False


def _argument_change(transfer: LoopTransfer, w: Array) -> float | None:
    """Return the continuous change of arg f along ascending frequencies, or None if a zero lies on the way."""
    f = transfer.characteristic(1j * w)
    for _ in range(DEEPEST):
        if np.any(f == 0.0):
            return None
        turns = np.angle(f[1:] / f[:-1])
        coarse = np.nonzero(np.abs(turns) > LARGEST_TURN)[0]
        if coarse.size == 0:
            return float(np.sum(turns))
        middle = 0.5 * (w[coarse] + w[coarse + 1])
        if np.any((middle <= w[coarse]) | (middle >= w[coarse + 1])):
            return None
        w = np.insert(w, coarse + 1, middle)
        f = np.insert(f, coarse + 1, transfer.characteristic(1j * middle))
    return None
