"""The plants of paper I, as named objects; paper II gives the same letters to other plants.

``G12`` and ``G14`` have a parameter a, which is part of the name: ``G12 a=0.2``.
"""

from __future__ import annotations

from collections.abc import Sequence
from types import MappingProxyType

import numpy as np

from replicate.loops import Plant


def _product(*factors: Sequence[float]) -> np.ndarray:
    product = np.array([1.0])
    for factor in factors:
        product = np.polymul(product, factor)
    return product


def resonant(a: float) -> Plant:
    """Return G12, a lag with two oscillatory poles of relative damping a/6 (example 5)."""
    return Plant([9.0], _product([1.0, 1.0], [1.0, a, 9.0]))


def unstable(a: float) -> Plant:
    """Return G14, an unstable pole at 1 and a stable one at -a (example 7)."""
    return Plant([a], _product([1.0, a], [1.0, -1.0]))


def filtered_dead_time(time_constant: float) -> Plant:
    """Return G7 behind the noise filter (2), ``e^{-s} / (1 + s Tf)`` (example 8)."""
    return Plant([1.0], [time_constant, 1.0], dead_time=1.0)


_LAGS = _product([1.0, 1.0], [1.0, 1.0], [1.0, 1.0])
FAST, MIDDLE, SLOW = 10.0, 1.0, 0.05  # the corner frequencies of G10
_FILTERED_LAG = _product([1.0, FAST], [1.0, FAST], [1.0, MIDDLE])
SLOW_TERM = Plant([0.5 * FAST**2], _product([1.0, FAST], [1.0, FAST], [1.0, SLOW]))  # the second term of (27)

PLANTS = MappingProxyType(
    {
        "G1": Plant([1.0], _LAGS),
        "G2": Plant([1.0], _product([1.0, 1.0], [0.2, 1.0], [0.04, 1.0], [0.008, 1.0])),
        "G3": Plant([1.0], _LAGS, dead_time=15.0),
        "G4": Plant([1.0], _product([1.0, 0.0], [1.0, 1.0], [1.0, 1.0])),
        "G5": Plant([-2.0, 1.0], _LAGS),
        "G6": resonant(2.0),
        "G7": Plant([1.0], [1.0], dead_time=1.0),
        "G8": Plant([1.0], [1.0, 0.0], dead_time=1.0),
        "G9": Plant.from_function(lambda s: np.exp(-np.sqrt(s))),
        "G10": Plant(  # (27), over one denominator
            FAST**2 * np.polyadd([1.0, SLOW], np.multiply(0.5, [1.0, MIDDLE])),
            np.polymul(_FILTERED_LAG, [1.0, SLOW]),
        ),
        "G11": Plant([150.0], _FILTERED_LAG),  # (28)
        **{f"G12 a={a}": resonant(a) for a in (0.0, 0.1, 0.2, 0.5, 1.0, 2.0)},
        "G13": Plant(_product([1.0, 6.0], [1.0, 6.0]), _product([1.0, 0.0], [1.0, 1.0], [1.0, 1.0], [1.0, 36.0])),
        **{f"G14 a={a:g}": unstable(a) for a in (4.0, 8.0)},
    }
)


def label(name: str) -> str:
    """Return a plant's name as the paper sets it, ``G12 a=0.2`` as $G_{12}$, $a = 0.2$."""
    letter, _, parameter = name.partition(" a=")
    return f"$G_{{{letter[1:]}}}$" + (f", $a = {parameter}$" if parameter else "")
