"""VI: the flexible shaft, and the gain reduction (8)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from replicate.exhibits.extrema import largest
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.parts_3_to_6.active_damping import (
    EXAMPLE,
    EXAMPLE_EQ_3,
    INTERCEPT,
    K_B,
    SLOPE,
    Shaft,
    k_b_from,
)
from replicate.papers.panagopoulos.parts_3_to_6.damping_batch import impulse_iae

if TYPE_CHECKING:
    import pandas as pd

example = paper.table(
    "VI-example",
    "The flexible shaft: characteristics and filter parameters",
    kind="example",
    rows=(
        "omega_b", "P_max", "P_min", "omega_a", "k_b", "K_b", "K_b_eq_6", "K_b_printed_kb", "omega_min", "P_peak",
        "omega_peak", "P_0", "ratio", "gain", "omega_p_squared", "kb_limit",
        "zeta_p", "omega_p", "omega_f", "zeta_a", "zeta_b", "K_PI", "Ti_PI",
    ),
    columns=("value",),
    labels={
        "omega_b": "$\\omega_b = \\omega_p$",
        "P_max": "$P_{max} = |P(i\\omega_p)|$",
        "P_min": "$P_{min}$",
        "omega_a": "$\\omega_a$",
        "k_b": "$k_b$",
        "K_b": "$K_b$, (9)",
        "K_b_eq_6": "$K_b$, (6)",
        "K_b_printed_kb": "$K_b$ for $k_b = 2.75$",
        "omega_min": "frequency of $P_{min}$",
        "P_peak": "resonance peak of $|P|$",
        "omega_peak": "its frequency",
        "P_0": "$P(0)$",
        "ratio": "$P_{max}/P_{min}$",
        "gain": "numerator $\\kappa$ of $P$",
        "zeta_p": "$\\zeta_p$",
        "omega_p": "$\\omega_p$",
        "omega_f": "$\\omega_f$",
        "zeta_a": "$\\zeta_a$",
        "zeta_b": "$\\zeta_b$",
        "K_PI": "$K$ of the PI controller",
        "Ti_PI": "$T_i$ of the PI controller",
        "omega_p_squared": "$\\omega_p^2$",
        "kb_limit": "inner loop stable up to $k_b$",
    },
    caption="$\\kappa = 15.21$, $\\zeta_p = 0.02$, $\\omega_p = 7.66$, $\\omega_f = 0.10$. $P_{min}$ is the "
    "local minimum of $|P|$ between corner and resonance; at low frequency $|P|$ is larger than $P_{max}$.",
)  # fmt: skip


INPUTS = ("zeta_p", "omega_p", "omega_f", "zeta_a", "zeta_b", "K_PI", "Ti_PI")


def _frame(shaft: Shaft, ratio: float, *, given: bool = False) -> pd.DataFrame:
    """Return the table for a plant; what the example gives is an input and is not compared."""
    smallest, peak = shaft.extrema()
    k_b = k_b_from(ratio)
    values = {
        "omega_b": shaft.omega_p,
        "P_max": shaft.p_max,
        "P_min": smallest.value,
        "omega_a": shaft.omega_a,
        "k_b": k_b,
        "K_b": shaft.band_gain(k_b),
        "K_b_eq_6": shaft.band_gain(1.0),
        "K_b_printed_kb": shaft.band_gain(K_B),
        "omega_min": smallest.frequency,
        "P_peak": peak.value,
        "omega_peak": peak.frequency,
        "P_0": shaft.plant.gain,
        "ratio": ratio,
        "gain": np.nan if given else shaft.gain,
        "omega_p_squared": shaft.omega_p**2,
        "kb_limit": shaft.largest_stable_gain(),
    }
    return example.frame({**dict.fromkeys(INPUTS, np.nan), **values})


@example.reading(
    "as-written",
    "Exact, $\\kappa = 15.21$",
    note="$k_b$ by (10) from the exact $P_{max}/P_{min}$.",
)
def exact() -> pd.DataFrame:
    """Evaluate the example as stated."""
    return _frame(EXAMPLE, EXAMPLE.ratio, given=True)


@example.reading(
    "rounded-inputs",
    "$k_b$ from the printed $P_{max}$ and $P_{min}$",
    note="(10) applied to $0.85/0.088$, and (9) to the $k_b$ that it gives.",
    inputs=("P_max", "P_min"),
)
def rounded_inputs(_: str, given: Mapping[str, float]) -> dict[str, float]:
    """Evaluate k_b and the gain from the rounded characteristics."""
    ratio = given["P_max"] / given["P_min"]
    k_b = k_b_from(ratio)
    return {"k_b": k_b, "K_b": EXAMPLE.band_gain(k_b), "ratio": ratio}


@example.reading(
    "eq-3",
    "Numerator $\\omega_p^2$, as in (3)",
    note="The design is derived for (3), whose numerator is $\\omega_p^2$; the example has $\\kappa$ there. "
    "The gain scales $P_{max}$, $P_{min}$ and $K_b$, and nothing else.",
)
def as_in_eq_3() -> pd.DataFrame:
    """Evaluate the example with the numerator of (3)."""
    return _frame(EXAMPLE_EQ_3, EXAMPLE_EQ_3.ratio)


interval = paper.table(
    "VI-example-kb",
    "What the rounded coefficients of (10) allow for $k_b$",
    printed=False,
    rows=("lowest", "printed_coefficients", "highest"),
    columns=("value",),
    labels={"lowest": "lowest", "printed_coefficients": "with $-0.46$ and 0.33", "highest": "highest"},
    caption="The coefficients are printed to two decimals; each may be off by half a unit. The paper prints "
    "$k_b = 2.75$.",
)


@interval.reading("as-written", "Interval of $k_b$ in the example")
def coefficient_interval() -> pd.DataFrame:
    """Evaluate (10) with its coefficients at the ends of their rounding intervals."""
    import pandas as pd

    half = 0.005
    values = [(INTERCEPT + sign * half) + (SLOPE + sign * half) * EXAMPLE.ratio for sign in (-1, 0, 1)]
    return pd.DataFrame({"value": values}, index=list(interval.rows))


CASES = {"without": 0.0, "kb_1": 1.0, "kb_eq_10": k_b_from(EXAMPLE.ratio), "kb_printed": K_B}

reduction = paper.table(
    "VI-eq-8",
    "The gain at the resonance with active damping",
    kind="formula",
    printed=False,
    rows=tuple(CASES),
    columns=("k_b", "loop_gain", "gain", "reduction", "bound", "largest", "iae"),
    labels={
        "without": "without active control",
        "kb_1": "$K_b$ by (6)",
        "kb_eq_10": "$K_b$ by (9), (10)",
        "kb_printed": "$k_b$ as printed",
        "k_b": "$k_b$",
        "loop_gain": "$PF$ at $\\omega_p$",
        "gain": "$|P/(1+PF)|$ at $\\omega_p$",
        "reduction": "relative to $P_{max}$",
        "bound": "(8)",
        "largest": "largest above $\\omega_{min}$",
        "iae": "IAE",
    },
    caption="By construction $PF = k_b$ at $\\omega_p$, real and positive, so the gain falls to $1/(1+k_b)$ "
    "of $P_{max}$. Then the largest $|P/(1+PF)|$ at frequencies above that of $P_{min}$, relative to "
    "$P_{max}$, and the integrated absolute error of the response to a load impulse.",
)


@reduction.reading("as-written", "Flexible shaft")
def gain_reduction() -> pd.DataFrame:
    """Evaluate (7) for the three gains."""
    rows = {}
    s = 1j * EXAMPLE.omega_p
    grid = np.log(np.geomspace(EXAMPLE.extrema()[0].frequency, 100.0 * EXAMPLE.omega_p, 2001))
    for name, k_b in CASES.items():
        num, den = EXAMPLE.filter(k_b)
        loop_gain = complex(EXAMPLE.plant(s)) * np.polyval(num, s) / np.polyval(den, s)
        damped = EXAMPLE.damped(k_b)
        gain = float(abs(damped(s)))
        on_grid = np.abs(damped(1j * np.exp(grid)))
        _, highest = largest(lambda x, plant=damped: abs(plant(1j * np.exp(x))), grid, on_grid)  # type: ignore[misc]
        rows[name] = [
            k_b,
            float(loop_gain.real),
            gain,
            gain / EXAMPLE.p_max,
            0.5 if k_b else np.nan,
            highest / EXAMPLE.p_max,
            impulse_iae(EXAMPLE, k_b),
        ]
    return reduction.frame(rows)
