"""The transfer function of a python-control system, free of what rounding adds to it.

The characteristic polynomial and the numerator of a state-space model are computed in exact integer arithmetic from the
binary fractions that its matrices hold (Faddeev and LeVerrier). A coefficient that rounding errors of the matrices'
entries, of relative size eps times the norm, could make zero is zero: it would be a pole at rest that drifts or a zero
at 1e15 that no such system has.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from replicate.loops.errors import LoopError

if TYPE_CHECKING:
    import control

Array = NDArray[np.float64]

EPS = float(np.finfo(float).eps)
COUNTS = 1e-8  # share of a polynomial's value from which a term is more than rounding
ROUNDING = 8.0  # units in the last place, for each order, by which a model's entries may be rounded


def polynomials_of(system: control.TransferFunction | control.StateSpace) -> tuple[Array, Array]:
    """Return (num, den), descending powers of s.

    Raises
    ------
    LoopError
        If the system is neither a transfer function nor a state-space model, is discrete, or has several inputs or
        outputs.
    """
    import control  # takes seconds to import

    if not isinstance(system, control.TransferFunction | control.StateSpace):
        msg = (
            "the system must be a python-control TransferFunction or StateSpace in continuous time, "
            f"not {type(system).__name__}"
        )
        raise LoopError(msg)
    if system.ninputs != 1 or system.noutputs != 1:
        msg = f"the plant must have one input and one output, not {system.ninputs} and {system.noutputs}"
        raise LoopError(msg)
    if system.dt not in (0, None):
        msg = f"the plant must be in continuous time, not sampled with dt = {system.dt}"
        raise LoopError(msg)
    if isinstance(system, control.StateSpace):
        return _from_state_space(*(np.asarray(m, dtype=float) for m in (system.A, system.B, system.C, system.D)))
    return _without_rounding(np.asarray(system.num[0][0], dtype=float), np.asarray(system.den[0][0], dtype=float))


def _from_state_space(a: Array, b: Array, c: Array, d: Array) -> tuple[Array, Array]:
    n = a.shape[0]
    (whole_a, unit_a), (whole_b, unit_b), (whole_c, unit_c) = _integers(a), _integers(b[:, :1]), _integers(c[:1])
    # (s I - A)^-1 = (M_0 s^(n-1) + M_1 s^(n-2) + ...) / (s^n + a_1 s^(n-1) + ...), of integers if A is
    one = np.array([[int(i == j) for j in range(n)] for i in range(n)], dtype=object).reshape(n, n)
    feedthrough = Fraction(float(d[0, 0]))
    den, num, m, whole = [Fraction(1)], [feedthrough], one, 1
    for k in range(1, n + 1):
        num.append(Fraction((whole_c @ m @ whole_b)[0, 0], unit_c * unit_b * unit_a ** (k - 1)))
        product = whole_a @ m
        whole = -sum(product[i, i] for i in range(n)) // k
        den.append(Fraction(whole, unit_a**k))
        m = product + whole * one
    num = [num[k] + (feedthrough * den[k] if k else 0) for k in range(n + 1)]
    den_noise, num_noise = _noise(a, b[:, 0], c[0], abs(float(d[0, 0])))
    own = np.abs(np.linalg.eigvals(a)) if n else np.zeros(0)
    own = own[own > ROUNDING * n * EPS * own.max(initial=0.0)]
    return _denoised(num, num_noise, own), _denoised(den, den_noise, own)


def _integers(matrix: Array) -> tuple[NDArray[Any], int]:
    """Return a matrix of floats as integers and the power of two over which they are."""
    ratios = [float(value).as_integer_ratio() for value in matrix.ravel()]
    unit = max((below for _, below in ratios), default=1)
    exact = np.empty(matrix.size, dtype=object)
    exact[:] = [above * (unit // below) for above, below in ratios]
    return exact.reshape(matrix.shape), unit


def _denoised(polynomial: list[Fraction], noise: Array, frequencies: Array) -> Array:
    """Return coefficients as floats, zero where they may be noise and count for nothing at the model's frequencies."""
    floats = np.array([float(x) for x in polynomial])
    terms = np.abs(floats) * frequencies[:, None] ** np.arange(floats.size - 1, -1, -1.0)
    value = np.abs(np.polyval(floats, 1j * frequencies))
    counts = np.any(terms > COUNTS * value[:, None], axis=0)
    return np.where((np.abs(floats) <= noise) & ~counts, 0.0, floats)


def _noise(a: Array, b: Array, c: Array, d: float) -> tuple[Array, Array]:
    """Return the sizes that rounding of the entries can give to the coefficients of den and num."""
    n = a.shape[0]
    if n == 0:
        return np.zeros(1), np.zeros(1)
    balanced, (scale, _) = scipy.linalg.matrix_balance(a, permute=False, separate=True)
    size, b, c = np.abs(balanced), np.abs(b) / scale, np.abs(c) * scale
    rows = size.sum(axis=1)
    norm = float(rows.max())
    elementary = np.abs(np.poly(-rows))  # elementary symmetric functions of the row sums
    unit = ROUNDING * n * EPS
    den = np.concatenate([[0.0], unit * norm * elementary[:-1]])
    num, reach = [0.0], np.eye(n)
    for k in range(1, n + 1):
        num.append(unit * (float(c @ reach @ b) + d * norm * elementary[k - 1] if k else d))
        reach = size @ reach + elementary[k] * np.eye(n)
    return den, np.array(num)


def _without_rounding(num: Array, den: Array) -> tuple[Array, Array]:
    """Return polynomials without leading numerator coefficients that are rounding, and with poles at rest as such."""
    num, den = np.trim_zeros(np.atleast_1d(num), "f"), np.trim_zeros(np.atleast_1d(den), "f")
    if not num.size:
        return np.zeros(1), den
    poles = np.abs(np.roots(den))
    fastest = float(poles.max(initial=0.0))
    unit = ROUNDING * max(den.size, 2) * EPS
    if fastest and num.size > 1:
        size = np.abs(num) * fastest ** np.arange(num.size - 1, -1, -1.0)
        num = num[int(np.argmax(size > unit * size.max())) :]
    den = den.copy()
    for k in range(den.size - 1, 0, -1):
        if abs(den[k]) > unit * fastest * abs(den[k - 1]):
            break
        den[k] = 0.0
    return num, den
