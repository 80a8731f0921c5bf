"""The Appendix: the closed-form ISE, its minimum, and the printed curve fits of the optimal gains."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import root

from replicate.loops import PI, Loop
from replicate.papers.khan import paper
from replicate.papers.khan.processes import case_gains, plant

if TYPE_CHECKING:
    import pandas as pd

Array = NDArray[np.float64]

POINTS = ((0.1, 0.5, 0.05), (0.5, 0.6, 0.25), (1.0, 0.8, 0.5), (2.0, 1.0, 1.0), (5.0, 2.0, 2.5), (10.0, 3.0, 4.0))
PH_FIT = (0.01, 0.05, 0.1, 0.2, 0.3, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0)

appendix_j = paper.table(
    "appendix-J",
    "The closed-form ISE against the integral",
    kind="formula",
    printed=False,
    caption="$J = \\int_0^\\infty e^2\\,dt$ of the unit set-point step for $h = 1$: the Appendix' formula, and the "
    "integral of the exact response.",
    labels={"formula": "formula", "integral": "integral", "ratio": "ratio"},
)
appendix_fit = paper.table(
    "appendix-fit",
    "The ISE-optimal gains against the printed curve fits",
    kind="formula",
    printed=False,
    caption="The true optimum for $h = 1$, the printed fits with their errors in per cent, the ISE lost by using them, "
    "and the estimate $J_{opt} = 1.577h + 0.025ph^2 - 0.209\\sqrt{ph^3}$.",
    labels={
        "KP_opt": "$K_P$, optimum", "KI_opt": "$K_I$, optimum", "KP_fit": "$K_P$, fit", "KI_fit": "$K_I$, fit",
        "KP_error": "$K_P$, error (%)", "KI_error": "$K_I$, error (%)", "J_opt": "$J$, optimum",
        "J_fit": "$J$ of the fit", "J_loss": "loss of the fit (%)", "J_estimate": "$J_{opt}$, estimate",
        "J_error": "estimate, error (%)",
    },
)  # fmt: skip


def closed_form(p: float, kp: float, ki: float, *, sign: float = -1.0) -> float:
    """Return J for h = 1 by the residues at the zeros of 1 - (loop)(s) (loop)(-s).

    Only for stable loops: the formula returns numbers for unstable ones, too.

    Parameters
    ----------
    sign
        That of K_P p in the second numerator: +1 as printed, -1 as the residues give.
    """
    return float(_closed_form(p, complex(kp), complex(ki), sign).real)


def _closed_form(p: float, kp: complex, ki: complex, sign: float = -1.0) -> complex:
    delta = np.sqrt((kp**2 - p**2) ** 2 + 4.0 * ki**2)
    rho, sigma = np.sqrt((delta + p**2 - kp**2) / 2.0), np.sqrt((delta - p**2 + kp**2) / 2.0)
    below, above = p**2 - rho**2, p**2 + sigma**2
    first = below * (ki - kp * p + below * np.cosh(rho)) / (kp * rho**2 - p * ki - rho * below * np.sinh(rho))
    second = (
        above * (ki + sign * kp * p + above * np.cos(sigma)) / (kp * sigma**2 + p * ki - sigma * above * np.sin(sigma))
    )
    return complex((first + second) / (2.0 * delta))


def _gradient(x: Array, p: float) -> Array:
    """Return dJ/dK_P, dJ/dK_I by complex steps, which lose no digits."""
    step = 1e-30
    kp, ki = complex(x[0]), complex(x[1])
    return np.array([_closed_form(p, kp + 1j * step, ki).imag, _closed_form(p, kp, ki + 1j * step).imag]) / step


def integral(p: float, kp: float, ki: float) -> float:
    """Return J for h = 1 from the exact response."""
    return Loop(plant(p, 1.0), PI(kp, ki)).step().ise()


@cache
def optimum(p: float) -> tuple[float, float, float]:
    """Return the ISE-optimal K_P, K_I and J for h = 1: the zero of the corrected closed form's gradient.

    Raises
    ------
    ValueError
        If the zero that is found is not a minimum, or its loop is not stable.
    """
    start = np.array(case_gains("ISE-I" if p < 0.2 else "ISE-II", p, 1.0))

    def slope(x: Array) -> Array:  # in units of the printed gains
        return np.asarray(_gradient(x * start, p) * start)

    found = root(slope, np.ones(2), tol=1e-14)
    kp, ki = (float(value) for value in found.x * start)
    # the Hessian from central differences of the exact gradient
    h = 1e-5 * np.array([kp, ki])
    columns = [
        (_gradient(np.array([kp, ki]) + d, p) - _gradient(np.array([kp, ki]) - d, p)) / (2.0 * d.sum())
        for d in np.diag(h)
    ]
    if not (np.all(np.linalg.eigvalsh(np.array(columns)) > 0.0) and Loop(plant(p, 1.0), PI(kp, ki)).is_stable()):
        msg = f"ph = {p:g}: no minimum of J near the printed gains ({found.message})"
        raise ValueError(msg)
    return kp, ki, closed_form(p, kp, ki)


def _j_frame(sign: float) -> pd.DataFrame:
    rows = {}
    for p, kp, ki in POINTS:
        formula, exact = closed_form(p, kp, ki, sign=sign), integral(p, kp, ki)
        rows[f"p={p:g}, KP={kp:g}, KI={ki:g}"] = {"formula": formula, "integral": exact, "ratio": formula / exact}
    return appendix_j.frame(rows)


@appendix_j.reading("as-written", "as printed")
def j_as_written() -> pd.DataFrame:
    """Evaluate the formula with the printed sign."""
    return _j_frame(+1.0)


@appendix_j.reading(
    "corrected", "second numerator $K_I - K_P p + \\dots$", "The residues give a minus sign before $K_P p$."
)
def j_corrected() -> pd.DataFrame:
    """Evaluate the formula with the sign that the residues give."""
    return _j_frame(-1.0)


def estimate(p: float) -> float:
    """Return the printed estimate of J_opt for h = 1."""
    return float(1.577 + 0.025 * p - 0.209 * np.sqrt(p))


@appendix_fit.reading("as-written", "Optimum and printed fits")
def fits() -> pd.DataFrame:
    """Compare optimum and fits over ph."""
    rows = {}
    for p in PH_FIT:
        cases = ["ISE-I"] if p < 0.2 else ["ISE-I", "ISE-II"] if p == 0.2 else ["ISE-II"]
        for case in cases:
            kp, ki = case_gains(case, p, 1.0)
            best_kp, best_ki, best = optimum(p)
            reached = closed_form(p, kp, ki)
            rows[f"{case.removeprefix('ISE-')}, ph={p:g}"] = {
                "KP_opt": best_kp, "KI_opt": best_ki, "KP_fit": kp, "KI_fit": ki,
                "KP_error": 100.0 * (kp / best_kp - 1.0), "KI_error": 100.0 * (ki / best_ki - 1.0),
                "J_opt": best, "J_fit": reached, "J_loss": 100.0 * (reached / best - 1.0),
                "J_estimate": estimate(p), "J_error": 100.0 * (estimate(p) / best - 1.0),
            }  # fmt: skip
    return appendix_fit.frame(rows)
