"""Formulas (13) to (16) of the supplement and the two filters for b = 1, put to the test."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.optimize import minimize_scalar

from replicate.loops import PID, Loop
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_2 import setpoint
from replicate.papers.panagopoulos.part_2.designs import optimal
from replicate.papers.panagopoulos.part_2.load_experiment import loop_of
from replicate.papers.panagopoulos.part_2.processes import PLANTS, ROW_LABELS, ROWS, split
from replicate.papers.panagopoulos.part_2.setpoint import Resonance

if TYPE_CHECKING:
    import pandas as pd


def weight_peak(controller: PID, b: float) -> float:
    """Return the largest ``|(ki + i b k w)/(ki + i k w - kd w^2)|`` over all frequencies, the left side of (14).

    Its square is a ratio of polynomials in w^2, so the maximum is at a root of the derivative.
    """
    k, ki, kd = controller.k, controller.ki, controller.kd
    top: Any = np.array([(b * k) ** 2, ki**2])  # in x = w^2
    bottom: Any = np.array([kd**2, k**2 - 2.0 * ki * kd, ki**2])
    slope: Any = np.polysub(np.polymul(np.polyder(top), bottom), np.polymul(top, np.polyder(bottom)))
    real = [x.real for x in np.roots(slope) if abs(x.imag) < 1e-12 * (1.0 + abs(x)) and x.real > 0.0]
    return max([1.0, *(float(np.sqrt(np.polyval(top, x) / np.polyval(bottom, x))) for x in real)])


def setpoint_peak(row: str, controller: PID, b: float, filter_time: float) -> float:
    """Return the largest ``|G_sp|`` over all frequencies, (11)."""
    plant = PLANTS[split(row)[0]]
    loop = Loop(plant, controller)
    w0 = loop.sensitivity_peak().frequency

    def size(w: np.ndarray) -> np.ndarray:
        s = 1j * np.asarray(w)
        forward = (b * controller.k + controller.ki / s) * plant(s) / (1.0 + s * filter_time)
        return np.asarray(np.abs(forward / (1.0 + loop(s))))

    w = np.geomspace(1e-3 * w0, 1e2 * w0, 6000)
    sampled = size(w)
    i = int(np.argmax(sampled))
    if i in (0, w.size - 1):
        return max(1.0, float(sampled[i]))
    found = minimize_scalar(
        lambda x: -float(size(np.array([x]))[0]),
        bounds=(w[i - 1], w[i + 1]),
        method="bounded",
        options={"xatol": 1e-10 * w[i]},
    )
    return max(1.0, -float(found.fun))


COLUMNS = ("b13", "b_limit", "peak14", "Tsp", "gain16", "Tsp_b1", "gain_b1", "Msp")

table = paper.table(
    "IIs-eq-13-16",
    "Set-point weight and filter: (13) to (16) put to the test",
    kind="formula",
    printed=False,
    rows=ROWS,
    columns=COLUMNS,
    caption=r"For the optimal controllers. $b$ of (13) (empty: $|T|$ has no resonance, (13) is 0/0); the limit "
    r"on $b$ that (15) or the exact condition gives, and the largest value of the left side of (14) with that $b$, "
    r"which should not exceed one; $T_{sp}$ of (16) where $b = 0$, and $|F_{sp}G_{sp}|$ at $\omega_{mp}$ with it, "
    r"which should be one; the same for the filter of a controller with $b = 1$; and the true peak $M_{sp}$ of "
    r"$|F_{sp}G_{sp}|$ over all frequencies.",
    labels=ROW_LABELS
    | {
        "b13": "$b$ (13)",
        "b_limit": r"$b \leq$",
        "peak14": "(14)",
        "Tsp": "$T_{sp}$ (16)",
        "gain16": r"$|F_{sp}G_{sp}|$",
        "Tsp_b1": "$T_{sp}$, $b=1$",
        "gain_b1": r"$|F_{sp}G_{sp}|$",
        "Msp": "$M_{sp}$",
    },
)


def _frame(
    limit: Callable[[PID], float],
    filter_time: Callable[[PID, Resonance], float],
    full_filter: Callable[[PID, Resonance], float],
) -> pd.DataFrame:
    nan = float("nan")
    rows = {}
    for row in ROWS:
        c = optimal(row)
        peak = Resonance.of(loop_of(split(row)[0], c))
        wanted, bound = setpoint.weight_from_peak(c, peak), limit(c)
        time, full = filter_time(c, peak), full_filter(c, peak)
        b = 0.0 if np.isnan(bound) else min(wanted, bound)
        rows[row] = {
            "b13": nan if np.isinf(wanted) else wanted,
            "b_limit": bound,
            "peak14": weight_peak(c, 0.0 if np.isnan(bound) else bound),
            "Tsp": time,
            "gain16": nan if wanted > 0.0 else setpoint.setpoint_gain(c, peak, 0.0, time),
            "Tsp_b1": full,
            "gain_b1": setpoint.setpoint_gain(c, peak, 1.0, full),
            "Msp": setpoint_peak(row, c, b, time),
        }
    return table.frame(rows)


@table.reading("as-written", "As printed", r"(15) as the limit, (16) and the filter for $b = 1$ as printed.")
def as_written() -> pd.DataFrame:
    """Return what the printed formulas give."""
    return _frame(setpoint.weight_limit, setpoint.filter_as_printed, setpoint.full_weight_filter_as_printed)


@table.reading(
    "corrected",
    "Put right",
    r"$b \leq \sqrt{1-2T_d/T_i}$ in place of (15) (no $b$ at all if $T_i < 2T_d$; then $M_{sp}$ is with $b = 0$); "
    r"$T_{sp} = \sqrt{k_i^2M_p^2/A-1}/\omega_{mp}$; and for $b = 1$ $T_{sp} = "
    r"\sqrt{((k_i^2+k^2\omega_{mp}^2)M_p^2-A)/A}/\omega_{mp}$.",
)
def corrected() -> pd.DataFrame:
    """Return what the corrected formulas give."""
    return _frame(setpoint.exact_weight_limit, setpoint.filter_corrected, setpoint.full_weight_filter_corrected)
