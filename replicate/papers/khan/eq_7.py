"""The proposed rule (7a), (7b): as printed, and as the tables and continuity require."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from replicate.papers.khan import paper
from replicate.papers.khan.processes import PRINTED, RESTORED, UNROUNDED, case_gains

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

eq_7 = paper.table(
    "eq-7",
    "The proposed gains over both cases",
    kind="formula",
    printed=False,
    columns=("KPh", "KIh2"),
    caption="$K_P h$ and $K_I h^2$ of (7a) and (7b). The two cases meet at $ph = 0.2$, where both are given; the jump "
    "is the relative difference of (7a) from (7b).",
    labels={"KPh": "$K_P h$", "KIh2": "$K_I h^2$"},
)

ROWS = (("7a", 0.01), ("7a", 0.05), ("7a", 0.1), ("7a", 0.2), ("7b", 0.2), ("7b", 0.5), ("7b", 1.0), ("7b", 2.0),
        ("7b", 5.0), ("7b", 10.0), ("7b", 20.0))  # fmt: skip


def _frame(variant: str) -> pd.DataFrame:
    rows = {f"{case} ph={ph:g}": case_gains(case, ph, 1.0, variant) for case, ph in ROWS}
    left, right = rows["7a ph=0.2"], rows["7b ph=0.2"]
    rows["jump at ph=0.2 (%)"] = tuple(100.0 * (a / b - 1.0) for a, b in zip(left, right, strict=True))  # type: ignore[assignment]
    return eq_7.frame(rows)


@eq_7.reading("as-written", "as printed")
def as_written() -> pd.DataFrame:
    """Evaluate the formulas as printed."""
    return _frame(PRINTED)


@eq_7.reading(
    "restored",
    "three lost zeros of (7a) restored",
    "$0.404 \\to 0.0404$, $0.723 \\to 0.0723$, $0.525 \\to 0.0525$ in (7a): with them the two cases meet, and Table II "
    "is reproduced for $ph = 0.1$.",
)
def restored() -> pd.DataFrame:
    """Evaluate (7a) with its zeros."""
    return _frame(RESTORED)


@eq_7.reading("unrounded", "(7b) from the Appendix, unrounded", "Half of $K_{Popt}$ and 0.85 of $K_{Iopt}$, case II.")
def unrounded() -> pd.DataFrame:
    """Evaluate (7b) without rounding."""
    return _frame(UNROUNDED)


@paper.figure(
    "gains",
    "The proposed gains against $ph$",
    caption="Restored, the two cases meet at $ph = 0.2$; as printed, (7a) jumps away from (7b).",
    alt="Two panels: K_P h and K_I h squared against ph from 0.01 to 20 on a logarithmic axis. The restored curves are "
    "continuous at 0.2, the printed ones jump there.",
    size=(7.4, 3.4),
)
def draw(fig: Figure) -> None:
    """Draw both gains over both cases."""
    low, high = np.geomspace(0.01, 0.2, 120), np.geomspace(0.2, 20.0, 160)
    for index, (axes, label) in enumerate(zip(fig.subplots(1, 2), ("$K_P h$", "$K_I h^2$"), strict=True)):
        for case, ph, variant, style, name in (
            ("7a", low, RESTORED, "-", "(7a), zeros restored"),
            ("7b", high, PRINTED, "-", "(7b)"),
            ("7a", low, PRINTED, "--", "(7a) as printed"),
        ):
            axes.plot(ph, [case_gains(case, x, 1.0, variant)[index] for x in ph], style, label=name)
        axes.set(xscale="log", yscale="log", xlabel="$ph$", ylabel=label)
        ticks = (0.4, 0.6, 1.0, 2.0, 4.0) if index == 0 else (0.01, 0.1, 1.0, 10.0)
        axes.set_yticks(ticks, [f"{tick:g}" for tick in ticks])
        axes.set_yticks([], minor=True)
        axes.set_xticks((0.01, 0.1, 0.2, 1.0, 10.0), ["0.01", "0.1", "0.2", "1", "10"])
        axes.axvline(0.2, color="0.6", lw=0.8, ls=":")
        axes.legend()
