"""VI, (10): the regression of the best gain on P_max/P_min, rebuilt on a batch of our own."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.parts_3_to_6.active_damping import k_b_from
from replicate.papers.panagopoulos.parts_3_to_6.damping_batch import OMEGA_P, ZETA_P, batch, fit, of

if TYPE_CHECKING:
    import pandas as pd

BATCH = (
    f"$\\omega_f = 1$; $\\omega_p$ = {', '.join(f'{w:g}' for w in OMEGA_P)}; $\\zeta_p$ = "
    f"{', '.join(f'{z:g}' for z in ZETA_P)}; unit impulse of the load, $r = 0$, all time"
)

regression = paper.table(
    "VI-eq-10",
    "The line for $k_b$ over $P_{max}/P_{min}$",
    kind="formula",
    rows=("intercept", "slope", "largest_residual"),
    columns=("value",),
    labels={"largest_residual": "largest distance from the line"},
    caption=f"Least-squares line through the gains of smallest IAE over a test batch: {BATCH}.",
)


@regression.reading(
    "as-written",
    "On a batch of our own",
    note="The paper says only $\\omega_f = 1$; neither its $\\omega_p$ and $\\zeta_p$ nor the disturbance or "
    "the horizon are given. For a load step the IAE is infinite, because $F(0) = 0$ leaves a constant "
    "deviation; an impulse is the simplest choice.",
)
def line() -> pd.DataFrame:
    """Fit the line to the whole batch."""
    import pandas as pd

    found = fit(batch())
    values = [found.intercept, found.slope, found.largest_residual]
    return pd.DataFrame({"value": values}, index=list(regression.rows))


lines = paper.table(
    "VI-kb-lines",
    "The line by resonance frequency",
    printed=False,
    rows=tuple(f"{omega_p:g}" for omega_p in OMEGA_P),
    columns=("slope", "intercept", "largest_residual"),
    labels={"largest_residual": "largest distance"},
    caption="The same fit for each $\\omega_p$ alone (rows). For each the law is a line with negative "
    "intercept, but not the same line: the best gain is not a function of $P_{max}/P_{min}$ alone.",
)


@lines.reading("as-written", "One line for each $\\omega_p$")
def by_frequency() -> pd.DataFrame:
    """Fit a line to the members of each resonance frequency."""
    rows = {f"{omega_p:g}": list(fit(of(omega_p))) for omega_p in OMEGA_P}
    return lines.frame(rows)


members = paper.table(
    "VI-kb-batch",
    "The test batch and its best gains",
    printed=False,
    rows=tuple(f"{omega_p:g}, {zeta_p:g}" for omega_p in OMEGA_P for zeta_p in ZETA_P),
    columns=("ratio", "k_b", "k_b_eq_10", "iae", "iae_eq_10", "iae_eq_6", "iae_without", "damping"),
    labels={
        "ratio": "$P_{max}/P_{min}$",
        "k_b": "best $k_b$",
        "k_b_eq_10": "by (10)",
        "iae": "IAE",
        "iae_eq_10": "IAE, (10)",
        "iae_eq_6": "IAE, $k_b = 1$",
        "iae_without": "IAE without",
        "damping": "damping, (10)",
    },
    caption=f"Rows: $\\omega_p$, $\\zeta_p$. Batch: {BATCH}. The last column is the smallest damping ratio of the "
    "inner loop with $k_b$ by (10).",
)


@members.reading("as-written", "Gain of smallest IAE")
def best_gains() -> pd.DataFrame:
    """Tabulate the batch."""
    rows = {
        f"{m.omega_p:g}, {m.zeta_p:g}": [
            m.ratio, m.k_b, k_b_from(m.ratio), m.iae, m.iae_by_formula_10, m.iae_by_formula_6, m.iae_without, m.damping,
        ]
        for m in batch()
    }  # fmt: skip
    return members.frame(rows)
