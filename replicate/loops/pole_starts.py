"""Where to look for closed-loop poles: eigenvalues of a discretisation, or minima on a grid for function plants.

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
from scipy.optimize import brentq

from replicate.loops import chebyshev
from replicate.loops.chain import build_chain, gains
from replicate.loops.controller import PID
from replicate.loops.loop_transfer import LoopTransfer
from replicate.loops.plant import Plant

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

MOST_NODES = 400  # of the discretisation, however many poles are asked for
SPARE = 8  # turns of the dead time beyond the number of poles
ITERATIONS = 30  # each gains a digit or more where the frequency is high
RADII, ANGLES = 160, 60  # of the grid for plants given by a function
NEAREST = 1e-9  # rad from the negative real axis at which it is seen whether a function has a cut there
CLOSEST, IMAGINARY = 1e-13, 1e-11  # the same where a cut begins like a power of s
REAL = 1e-6  # imaginary part, relative to the modulus, of a value that is real


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
    crossing = transfer.beyond(max(0.3, 0.5 * (1.0 + transfer.feedthrough)))
    degree = int(min(160, max(24, np.ceil(1.2 * crossing * longest) + 16)))
    degree = max(degree, min(MOST_NODES, 3 * count + 16))
    d = _differentiation_matrix(degree) * (2.0 / longest)
    # unknowns: X and u(t + theta) at the nodes theta = -L..0; the last node is u itself, given by the controller
    size = n + degree
    values = chebyshev.basis(1.0 - 2.0 * delays / longest, degree).T @ chebyshev.values_to_coefficients(degree)
    inputs = values[:, :degree]  # v_i = u(t - L_i) from the nodes; u(t) itself has no part in it
    inputs[np.abs(inputs) < 1e-13] = 0.0
    own = np.where(np.abs(values[:, degree]) < 1e-13, 0.0, values[:, degree])
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
    return np.asarray(s[np.isfinite(s) & (s.imag >= 0.0)])


def starts_on_grid(transfer: LoopTransfer) -> ComplexArray:
    """Return starts, Im >= 0, for a plant given by a function.

    They are the local minima of |1 + 1/L|, which is zero at the poles and free of the scale of L, on a polar grid of
    the upper half-plane and, where the function has no cut there, on the negative real axis.
    """
    end = transfer.beyond(0.3)
    radius = np.geomspace(1e-4 * end, 3.0 * end, RADII)
    angle = np.linspace(0.0, 0.98 * np.pi, ANGLES)
    with np.errstate(all="ignore"):
        s = radius[:, None] * np.exp(1j * angle[None, :])
        relative = np.abs(1.0 + 1.0 / transfer(s))
        inner = relative[1:-1, :]
        low = (inner <= relative[:-2, :]) & (inner <= relative[2:, :])
        padded = np.pad(relative, ((0, 0), (1, 1)), mode="edge")[1:-1]
        low &= (inner <= padded[:, :-2]) & (inner <= padded[:, 2:])
        return np.concatenate([s[1:-1][low], _starts_on_axis(transfer, radius)])


def has_cut(transfer: LoopTransfer, s: ComplexArray) -> NDArray[np.bool_]:
    """Return where on the negative real axis, at points ``s``, the function has a cut or a pole."""
    with np.errstate(all="ignore"):
        value = transfer(-np.abs(s) * np.exp(-1j * NEAREST))
        return np.asarray(~(np.abs(value.imag) <= REAL * np.abs(value)))


def begin_of_cut(transfer: LoopTransfer, scale: float) -> float:
    """Return how far from s = 0 the cut on the negative real axis begins, to a tenth; 0 if at rest, ``inf`` without."""
    radius = scale * np.geomspace(1e-12, 1e3, 400)
    with np.errstate(all="ignore"):
        value = transfer(-radius * np.exp(-1j * CLOSEST))
        cut = np.isfinite(value) & (np.abs(value.imag) > IMAGINARY * np.abs(value))
    if not cut.any():
        return float("inf")
    first = int(np.argmax(cut))
    return float(radius[first - 1]) if first else 0.0


def _starts_on_axis(transfer: LoopTransfer, radius: Array) -> ComplexArray:
    """Return starts on the negative real axis, where L is real: sign changes and minima of 1 + 1/L."""

    def excess(x: float) -> float:
        return float(1.0 + 1.0 / complex(transfer(complex(-x))).real)

    smooth = ~has_cut(transfer, radius.astype(complex))
    value = 1.0 + 1.0 / transfer(-radius.astype(complex)).real
    smooth &= np.isfinite(value)
    both = smooth[1:] & smooth[:-1]
    found = [
        float(brentq(excess, radius[i], radius[i + 1])) for i in np.nonzero(both & (value[1:] * value[:-1] < 0.0))[0]
    ]
    size = np.where(smooth, np.abs(value), np.inf)
    low = (size[1:-1] < size[:-2]) & (size[1:-1] < size[2:]) & both[1:] & both[:-1]
    return -np.array([*found, *radius[1:-1][low]], dtype=complex)
