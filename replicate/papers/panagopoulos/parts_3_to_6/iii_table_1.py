"""III, Table 1: corresponding values of M and gamma."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.parts_3_to_6.loop_shaping import gamma_of_m, m_of_gamma

if TYPE_CHECKING:
    import pandas as pd

COLUMNS = ("1.37", "1.40", "1.50", "1.60", "1.65", "1.70", "1.80", "1.90", "1.91", "2.00")

LABELS = {"M": "$M$", "gamma": "$\\gamma$"}

table_1 = paper.table(
    "III-table-1",
    "Corresponding values of $M$ and $\\gamma$",
    rows=("M", "gamma"),
    columns=COLUMNS,
    labels=LABELS,
    cases="columns",
    caption="Each row is computed from the other one as printed: $M$ by (13), $\\gamma$ by (14).",
)


def printed_pairs() -> dict[str, tuple[float, float]]:
    """Return (M, gamma) as printed, by column."""
    printed = paper.printed_numbers("III-table-1")
    return {column: (printed["M", column], printed["gamma", column]) for column in COLUMNS}


@table_1.reading(
    "as-written",
    "Each row from the other",
    note="(13) and (14) are inverse to each other, but two-digit numbers are not: the table has columns in which only "
    "one of the two formulas gives the printed digits.",
    inputs=("M", "gamma"),
)
def as_written(_: str, given: Mapping[str, float]) -> dict[str, float]:
    """Compute M from the printed gamma and gamma from the printed M."""
    return {"M": float(m_of_gamma(given["gamma"])), "gamma": float(gamma_of_m(given["M"]))}


direction = paper.table(
    "III-table-1-direction",
    "Which way round each column of Table 1 was made",
    printed=False,
    rows=COLUMNS,
    columns=("gamma_of_M", "off_gamma", "M_of_gamma", "off_M"),
    labels={
        "gamma_of_M": "$\\gamma(M)$, (14)",
        "off_gamma": "off by",
        "M_of_gamma": "$M(\\gamma)$, (13)",
        "off_M": "off by",
    },
    caption="How far each formula is from the printed value, in units of the second decimal. More than half a unit "
    "means that the column was not made with this formula from the printed other value.",
)


@direction.reading("as-written", "Both formulas against the print")
def both_ways() -> pd.DataFrame:
    """Compare both directions with the print."""
    rows = {}
    for column, (m, gamma) in printed_pairs().items():
        forward, backward = float(gamma_of_m(m)), float(m_of_gamma(gamma))
        off = [round(100.0 * difference, 9) + 0.0 for difference in (forward - gamma, backward - m)]
        rows[column] = [forward, off[0], backward, off[1]]
    return direction.frame(rows)
