"""Arguments checked once, in one line that names the argument, what was given and what is allowed.

Every real number is a number: int, float, numpy scalars, `fractions.Fraction`, `decimal.Decimal`, mpmath's mpf.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from replicate.loops.errors import LoopError
from replicate.loops.numerics.polynomials import trimmed

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

PROBE = np.array([1.0 + 1.0j, 2.0 + 1.0j, 3.0 + 1.0j])  # any points at all


def real(value: object) -> float:
    """Return a real number as a float; ``ValueError`` for anything else, ``nan`` and ``inf`` are let through."""
    if type(value) is float:  # by far the most frequent
        return value
    if isinstance(value, str | bytes | bool | np.bool_) or np.iscomplexobj(value) or np.ndim(value):  # type: ignore[arg-type]
        raise ValueError
    try:
        return float(value)  # type: ignore[arg-type]
    except (TypeError, OverflowError) as error:
        raise ValueError from error


def finite(name: str, value: object, *, allowed: str = "a finite number") -> float:
    """Return a finite real number as a float.

    Raises
    ------
    LoopError
        If it is not one.
    """
    return _within(name, value, allowed, -math.inf, closed=True)


def positive(name: str, value: object, *, allowed: str = "a finite number > 0") -> float:
    """Return a finite number > 0 as a float; LoopError otherwise."""
    return _within(name, value, allowed, 0.0, closed=False)


def non_negative(name: str, value: object, *, allowed: str = "a finite number >= 0") -> float:
    """Return a finite number >= 0 as a float; LoopError otherwise."""
    return _within(name, value, allowed, 0.0, closed=True)


def at_least(least: float, name: str, value: object) -> float:
    """Return a finite number that is not below another as a float; LoopError otherwise."""
    return _within(name, value, f"a finite number >= {least:g}", least, closed=True)


def settling_band(band: object) -> float:
    """Return half the width of a settling band as a float; LoopError unless it is a positive fraction."""
    return positive("the settling band", band, allowed="a positive fraction")


def nonzero(name: str, value: object, *, allowed: str = "a finite number other than 0") -> float:
    """Return a finite number other than 0 as a float; LoopError otherwise."""
    number = finite(name, value, allowed=allowed)
    if not number:
        raise LoopError(_message(name, value, allowed))
    return number


def instance(name: str, value: object, kind: type, allowed: str) -> None:
    """Check what kind of thing an argument is; LoopError otherwise."""
    if not isinstance(value, kind):
        msg = f"{name} must be {allowed}, not {type(value).__name__}"
        raise LoopError(msg)


def function(name: str, value: object) -> None:
    """Check that an argument maps complex arrays to numbers, one for each; LoopError otherwise."""
    allowed = "callable with a complex array s, with a number for each of its elements"
    if not callable(value):
        raise LoopError(_message(name, value, allowed))
    try:
        with np.errstate(all="ignore"):  # where it has values is another question
            found = value(PROBE)
        np.broadcast_to(points("its value", found), PROBE.shape)
    except Exception as error:
        msg = f"{_message(name, value, allowed)}: {type(error).__name__}: {shown(error)}"
        raise LoopError(msg) from error


def exactly(count: int, name: str, value: object, allowed: str) -> tuple[Any, ...]:
    """Return so many things as a tuple; LoopError otherwise."""
    if not isinstance(value, tuple | list) or len(value) != count:
        raise LoopError(_message(name, value, allowed))
    return tuple(value)


def several(name: str, values: object, allowed: str) -> list[Any]:
    """Return the items of anything but a text that can be gone through; LoopError otherwise."""
    if isinstance(values, Iterable) and not isinstance(values, str | bytes):
        try:
            return list(values)
        except TypeError:  # an array without dimensions
            pass
    raise LoopError(_message(name, values, allowed))


def times(name: str, values: object) -> Array:
    """Return real numbers of any shape as an array of floats; LoopError otherwise."""
    return np.asarray(_converted(name, values, float, "real numbers", kinds="biufO"), dtype=float)


def points(name: str, values: object) -> ComplexArray:
    """Return complex numbers of any shape as an array; LoopError otherwise."""
    return np.asarray(_converted(name, values, complex, "complex numbers", kinds="biufcO"), dtype=complex)


def _converted(name: str, values: object, to: type, allowed: str, *, kinds: str) -> NDArray[Any]:
    try:
        array: NDArray[Any] = np.asarray(values)
        known = array.dtype.kind in kinds and not (array.dtype == object and any(item is None for item in array.flat))
        if known:
            return array.astype(to)
    except (TypeError, ValueError):
        pass
    raise LoopError(_message(name, values, allowed))


def whole(name: str, value: object, *, most: float = math.inf) -> int:
    """Return an integer >= 1, and not above ``most``; LoopError otherwise."""
    if not isinstance(value, int | np.integer) or isinstance(value, bool) or not 1 <= value <= most:
        allowed = "at least 1 and whole" if math.isinf(most) else f"whole, from 1 to {most:g}"
        raise LoopError(_message(name, value, allowed))
    return int(value)


def coefficients(name: str, values: object) -> Array:
    """Return the coefficients of a polynomial, descending powers, without leading zeros; never empty.

    Raises
    ------
    LoopError
        If they are not a list of finite real numbers, or all zero.
    """
    allowed = "a list of finite real numbers, descending powers of s, not all zero"
    if isinstance(values, str | bytes) or not (isinstance(values, Iterable) or np.isscalar(values)):
        raise LoopError(_message(name, values, allowed))
    items = list(np.atleast_1d(np.asarray(values, dtype=object)))
    try:
        array = trimmed(np.array([real(item) for item in items], dtype=float))
    except ValueError:
        raise LoopError(_message(name, values, allowed)) from None
    if array.size == 0 or not np.isfinite(array).all():
        raise LoopError(_message(name, values, allowed))
    return array


def _within(name: str, value: object, allowed: str, low: float, *, closed: bool) -> float:
    try:
        number = real(value)
    except ValueError:
        raise LoopError(_message(name, value, allowed)) from None
    if not math.isfinite(number) or number < low or (number == low and not closed):
        raise LoopError(_message(name, value, allowed))
    return number


def _message(name: str, value: object, allowed: str) -> str:
    return f"{name} must be {allowed}, not {shown(value)}"


def exact(value: float) -> str:
    """Return a number in the shortest form that reads back as itself, without a needless decimal point."""
    short = f"{value:g}"
    return short if float(short) == value else repr(float(value))


def shown(value: object) -> str:
    """Return a value as a message shows it: on one line, and not at length."""
    number = isinstance(value, float | int | np.number | np.bool_)
    text = " ".join((str(value) if number else repr(value)).split())
    return text if len(text) <= 60 else text[:57] + "..."
