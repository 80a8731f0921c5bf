"""Closed-loop poles of loops with dead time.

Candidates are the eigenvalues of the infinitesimal generator, discretised by Chebyshev collocation of the transport of
the control signal through the dead time (Breda, Maset and Vermiglio, "Stability of Linear Delay Differential
Equations",
2015, chapter 4); each is polished by Newton's method on the exact characteristic function. The discretisation only says
where to look: what is returned satisfies f(s) = 0 to rounding, and stability is decided by the argument principle.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg
from numpy.polynomial import chebyshev as cheb
from numpy.typing import NDArray

from replicate.loops import chebyshev
from replicate.loops.chain import build_chain, gains
from replicate.loops.controller import PID
from replicate.loops.errors import LoopError
from replicate.loops.loop_transfer import LoopTransfer
from replicate.loops.plant import Plant

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

NEWTON_STEPS = 40
MOST_STARTS = 24


def rightmost_poles(plant: Plant, controller: PID, transfer: LoopTransfer, count: int = 1) -> ComplexArray:
    """Return the rightmost closed-loop poles, sorted by descending real part, Im >= 0 (a pair counts once).

    A static loop has none.

    Raises
    ------
    LoopError
        If no pole is found.
    """
    polynomial = plant.is_rational and plant.dead_time == 0.0
    if not plant.is_rational:
        starts = _starts_on_grid(transfer)
    elif polynomial:
        starts = np.asarray(np.roots(np.polyadd(transfer.den, transfer.num)), dtype=complex)
        if starts.size == 0:  # a static loop
            return starts
    else:
        starts = _generator_eigenvalues(plant, controller, transfer)
    starts = starts[np.argsort(-starts.real)][: 4 * count + MOST_STARTS]
    polished, converged = _newton(transfer, starts.real + 1j * np.abs(starts.imag))
    if polynomial:  # a multiple root has no slope for Newton: there the eigenvalue is as good as it gets
        polished, converged = np.where(converged, polished, starts), np.ones(starts.size, dtype=bool)
    found: list[complex] = []
    for value in polished[converged]:
        pole = complex(value.real, abs(value.imag))
        if abs(pole.imag) < 1e-12 * abs(pole):
            pole = complex(pole.real, 0.0)
        if not plant.is_rational and pole.imag < 1e-9 * max(1.0, abs(pole)) and pole.real <= 0.0:
            continue  # on the cut
        if all(abs(pole - other) > 1e-8 * max(1e-3, abs(pole)) for other in found):
            found.append(pole)
    if not found:
        msg = "no closed-loop pole was found"
        raise LoopError(msg)
    ordered = sorted(found, key=lambda p: (-p.real, p.imag))
    return np.array(ordered[:count])


def _generator_eigenvalues(plant: Plant, controller: PID, transfer: LoopTransfer) -> ComplexArray:
    chain = build_chain(plant, controller, integral=controller.ki != 0.0, derivative=controller.kd != 0.0)
    # the set-point filter's states are outside the loop
    outside = controller.setpoint_filter_polynomials()[1].size - 1
    n = chain.b.size - outside
    g = gains(controller)
    a, b, ux, uv = chain.a[:n, :n], chain.b[:n], (g @ chain.wx)[:n], float(g @ chain.wv)
    # enough nodes to resolve the phase that the loop can turn during one dead time at its fastest relevant frequency
    crossing = transfer.beyond(max(0.3, 0.5 * (1.0 + transfer.feedthrough)))
    degree = int(min(160, max(24, np.ceil(1.2 * crossing * plant.dead_time) + 16)))
    d = _differentiation_matrix(degree) * (2.0 / plant.dead_time)
    # unknowns: X and u(t + theta) at the nodes theta = -L..0; the last node is u itself, given by the controller
    size = n + degree
    matrix = np.zeros((size, size))
    matrix[:n, :n] = a
    matrix[:n, n] = b  # v = u(t - L), the first node
    matrix[n:, n:] = d[:degree, :degree]
    matrix[n:, :n] += np.outer(d[:degree, degree], ux)
    matrix[n:, n] += d[:degree, degree] * uv
    eigenvalues = np.asarray(scipy.linalg.eigvals(matrix), dtype=complex)
    return eigenvalues[eigenvalues.imag >= 0.0]


def _differentiation_matrix(degree: int) -> Array:
    slopes = cheb.chebval(chebyshev.nodes(degree), cheb.chebder(np.eye(degree + 1), axis=0))  # (degree+1 basis, nodes)
    return np.asarray(slopes.T @ chebyshev.values_to_coefficients(degree))


def _starts_on_grid(transfer: LoopTransfer) -> ComplexArray:
    """Return local minima of |f| on a polar grid of the upper half-plane: starts for plants given by a function."""
    end = transfer.beyond(0.3)
    radius = np.geomspace(1e-4 * end, 3.0 * end, 160)
    angle = np.linspace(0.0, 0.98 * np.pi, 60)
    s = radius[:, None] * np.exp(1j * angle[None, :])
    relative = np.abs(1.0 + 1.0 / transfer(s))  # zero at the poles, and free of the scale of L
    inner = relative[1:-1, :]
    low = (inner <= relative[:-2, :]) & (inner <= relative[2:, :])
    padded = np.pad(relative, ((0, 0), (1, 1)), mode="edge")[1:-1]
    low &= (inner <= padded[:, :-2]) & (inner <= padded[:, 2:])
    return np.asarray(s[1:-1][low])


def _newton(transfer: LoopTransfer, s: ComplexArray) -> tuple[ComplexArray, NDArray[np.bool_]]:
    """Polish zeros of the characteristic function by Newton's method with limited steps, all at once.

    Returns the points and whether each has converged; a multiple zero stops at the root of the rounding error.
    """
    s = np.array(s, dtype=complex)
    step = np.full(s.shape, np.inf, dtype=complex)
    with np.errstate(all="ignore"):
        for _ in range(NEWTON_STEPS):
            moving = (np.abs(step) > 4e-16 * np.abs(s)) & np.isfinite(s) & (s != 0.0)
            if not moving.any():
                break
            at = s[moving]
            change = transfer.characteristic(at) / _characteristic_slope(transfer, at)
            longest = 0.3 * np.maximum(np.abs(at), 1e-6)
            change *= np.minimum(1.0, longest / np.abs(change))
            step[moving] = change
            s[moving] = at - change
    return s, np.isfinite(s) & (s != 0.0) & (np.abs(step) <= 1e-6 * np.abs(s))


def _characteristic_slope(transfer: LoopTransfer, s: ComplexArray) -> ComplexArray:
    slope = np.polyval(np.polyder(transfer.den), s)
    fed_back = np.exp(-s * transfer.dead_time)
    if transfer.plant.is_rational:
        top = np.polyval(np.polyder(transfer.num), s) - transfer.dead_time * np.polyval(transfer.num, s)
        return np.asarray(slope + top * fed_back)
    value = np.polyval(transfer.num, s) * fed_back * transfer.plant.delay_free(s)
    den_slope = slope / np.polyval(transfer.den, s)
    return np.asarray(slope + value * (transfer.log_derivative(s) + den_slope))
