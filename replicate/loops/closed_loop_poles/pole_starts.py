"""Where to look for closed-loop poles: eigenvalues of a discretisation, and the asymptote of the fast ones.

A rational plant's candidates are the eigenvalues of the infinitesimal generator, discretised by Chebyshev collocation
of the transport of the control signal through the dead time (Breda, Maset and Vermiglio, "Stability of Linear Delay
Differential Equations", 2015, chapter 4).
"""

from __future__ import annotations

from functools import cache

import numpy as np
import scipy.linalg
from numpy.polynomial import chebyshev as cheb
from numpy.typing import NDArray

from replicate.loops.controller import PID
from replicate.loops.frequency_domain.loop_transfer import LoopTransfer
from replicate.loops.numerics import chebyshev
from replicate.loops.plant import Plant
from replicate.loops.time_domain.chain import build_chain, gains

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

MOST_NODES = 400  # of the discretisation, however many poles are asked for
SMALL = 0.3  # a loop gain that is far from -1
NODES, PER_TURN = (
    (24, 160),
    1.2,
)  # least and most of the discretisation for few poles; more for each rad of the dead time
ROUNDING = 1e-13  # value of a polynomial of a basis that is zero
SPARE = 8  # turns of the dead time beyond the number of poles
ITERATIONS = 30  # each gains a digit or more where the frequency is high


def generator_eigenvalues(plant: Plant, controller: PID, transfer: LoopTransfer, count: int = 1) -> ComplexArray:
    """Return approximate poles, Im >= 0, at least so many: where to look for the exact ones."""
    chain = build_chain(plant, controller, integral=controller.ki != 0.0, derivative=controller.kd != 0.0)
    chain = chain.balanced(gains(controller))
    # the set-point filter's states are outside the loop
    outside = controller.setpoint_filter_polynomials()[1].size - 1
    n = chain.e.size - outside
    g = gains(controller)
    a, b, ux, uv = chain.a[:n, :n], chain.b[:n], (g @ chain.wx)[:n], g @ chain.wv
    delays = np.array([part.dead_time for part in plant.parts])
    longest = float(delays[-1])
    if delays[0] == 0.0:  # close the path without dead time
        direct = 1.0 - float(uv[0])
        ux, uv = ux / direct, uv / direct
        a, b = a + np.outer(b[:, 0], ux), b + np.outer(b[:, 0], np.where(delays > 0.0, uv, 0.0))
        delays, b, uv = delays[1:], b[:, 1:], uv[1:]
    # enough nodes to resolve the phase that the loop can turn during one dead time at its fastest relevant frequency
    crossing = transfer.beyond(max(SMALL, 0.5 * (1.0 + transfer.feedthrough)))
    degree = int(min(NODES[1], max(NODES[0], np.ceil(PER_TURN * crossing * longest) + 16)))
    degree = max(degree, min(MOST_NODES, 3 * count + 16))
    d = _differentiation_matrix(degree) * (2.0 / longest)
    # unknowns: X and u(t + theta) at the nodes theta = -L..0; the last node is u itself, given by the controller
    size = n + degree
    values = chebyshev.basis(1.0 - 2.0 * delays / longest, degree).T @ chebyshev.values_to_coefficients(degree)
    inputs = values[:, :degree]  # v_i = u(t - L_i) from the nodes; u(t) itself has no part in it
    inputs[np.abs(inputs) < ROUNDING] = 0.0
    own = np.where(np.abs(values[:, degree]) < ROUNDING, 0.0, values[:, degree])
    control = np.concatenate([ux, uv @ inputs]) / (1.0 - float(uv @ own))
    matrix = np.zeros((size, size))
    matrix[:n, :n] = a
    matrix[:n, n:] = b @ inputs
    matrix[:n] += np.outer(b @ own, control)
    matrix[n:, n:] = d[:degree, :degree]
    matrix[n:] += np.outer(d[:degree, degree], control)
    eigenvalues = np.asarray(scipy.linalg.eigvals(matrix), dtype=complex)
    return eigenvalues[eigenvalues.imag >= 0.0]


@cache
def _differentiation_matrix(degree: int) -> Array:
    slopes = cheb.chebval(chebyshev.nodes(degree), cheb.chebder(np.eye(degree + 1), axis=0))  # (degree+1 basis, nodes)
    return np.asarray(slopes.T @ chebyshev.values_to_coefficients(degree))


def asymptotic_starts(transfer: LoopTransfer, count: int) -> ComplexArray:
    """Return about where the poles of high frequency are: s L = ln(-N(s)/D(s)) + 2 pi i m, L the longest dead time."""
    turns = np.asarray(2j * np.pi * np.arange(count + SPARE), dtype=complex)
    longest = transfer.longest_dead_time
    s = np.asarray(turns / longest, dtype=complex)
    with np.errstate(all="ignore"):
        for _ in range(ITERATIONS):
            s = (np.log(-transfer.without_longest(s)) + turns) / longest
            s, turns = s[np.isfinite(s)], turns[np.isfinite(s)]
    return np.asarray(s[s.imag >= 0.0])
