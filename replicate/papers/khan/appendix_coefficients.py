"""The coefficients of the Appendix' curve fits against least squares on the true optima."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from replicate.papers.khan import paper
from replicate.papers.khan.appendix import optimum

if TYPE_CHECKING:
    import pandas as pd

Array = NDArray[np.float64]

POINTS = 40  # per range of ph
CASES = {"I": (0.01, 0.2), "II": (0.2, 20.0)}
WHOLE = (0.01, 20.0)
TERMS = {"I": "ab", "II": "abc", "": "abc"}
FITS = {"KP_I": ("I", 0), "KI_I": ("I", 1), "KP_II": ("II", 0), "KI_II": ("II", 1), "J": ("", 2)}
ROWS = tuple(f"{name}_{letter}" for name, (case, _) in FITS.items() for letter in TERMS[case])

_SYMBOLS = {"KP_I": "I, $K_{Popt}$", "KI_I": "I, $K_{Iopt}$", "KP_II": "II, $K_{Popt}$", "KI_II": "II, $K_{Iopt}$",
            "J": "$J_{opt}$"}  # fmt: skip

appendix_coefficients = paper.table(
    "appendix-coefficients",
    "The coefficients of the fits in the Appendix, fitted anew",
    kind="formula",
    rows=ROWS,
    columns=("value",),
    caption="Case I: $K_{Popt} = a/h + b\\,p$, $K_{Iopt} = a/h^2 + b\\,p/h$. Case II: $K_{Popt} = a/h + b\\,p + "
    "c\\sqrt{p/h}$, $K_{Iopt} = a/h^2 + b\\,p/h + c\\sqrt{p/h^3}$. $J_{opt} = a\\,h + b\\,p\\,h^2 + c\\sqrt{p\\,h^3}$. "
    f"Each is fitted to the true optima at {POINTS} values of $ph$ over its range.",
    labels={
        f"{name}_{letter}": f"{_SYMBOLS[name]}: ${letter}$"
        for name, (case, _) in FITS.items()
        for letter in TERMS[case]
    },
)  # fmt: skip


def _frame(spaced: Callable[[float, float], Array]) -> pd.DataFrame:
    values: list[float] = []
    for case, which in FITS.values():
        p = spaced(*CASES.get(case, WHOLE))
        target = np.array([optimum(float(x))[which] for x in p])
        basis = np.stack([np.ones_like(p), p, np.sqrt(p)][: len(TERMS[case])], axis=1)
        values += [float(f"{x:.6g}") for x in np.linalg.lstsq(basis, target, rcond=None)[0]]
    return appendix_coefficients.frame(dict(zip(ROWS, values, strict=True)))


@appendix_coefficients.reading("as-written", "least squares, $ph$ in equal ratios")
def equal_ratios() -> pd.DataFrame:
    """Fit at points that are evenly spaced in log ph."""
    return _frame(lambda low, high: np.geomspace(low, high, POINTS))


@appendix_coefficients.reading("equal-steps", "least squares, $ph$ in equal steps")
def equal_steps() -> pd.DataFrame:
    """Fit at points that are evenly spaced in ph."""
    return _frame(lambda low, high: np.linspace(low, high, POINTS))
