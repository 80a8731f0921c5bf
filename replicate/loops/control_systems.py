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
    exact_a, exact_b, exact_c = _fractions(a), _fractions(b)[:, :1], _fractions(c)[:1]
    feedthrough = Fraction(float(d[0, 0]))
    # (s I - A)^-1 = (M_0 s^(n-1) + M_1 s^(n-2) + ...) / (s^n + a_1 s^(n-1) + ...)
    one = np.array([[Fraction(int(i == j)) for j in range(n)] for i in range(n)], dtype=object).reshape(n, n)
    den, num, m = [Fraction(1)], [feedthrough], one
    for k in range(1, n + 1):
        num.append((exact_c @ m @ exact_b)[0, 0])
        product = exact_a @ m
        den.append(-sum((product[i, i] for i in range(n)), Fraction(0)) / k)
        m = product + den[-1] * one
    num = [num[k] + (feedthrough * den[k] if k else 0) for k in range(n + 1)]
    den_noise, num_noise = _noise(a, b[:, 0], c[0], abs(float(d[0, 0])))
    den_floats = np.array([float(x) for x in den])
    num_floats = np.array([float(x) for x in num])
    return (
        np.where(np.abs(num_floats) <= num_noise, 0.0, num_floats),
        np.where(np.abs(den_floats) <= den_noise, 0.0, den_floats),
    )


def _fractions(matrix: Array) -> NDArray[Any]:
    exact = np.empty(matrix.shape, dtype=object)
    for index, value in np.ndenumerate(matrix):
        exact[index] = Fraction(float(value))
    return exact


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
