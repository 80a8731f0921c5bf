"""Table 2 of the errata, and what the printed controllers of both tables violate."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_2.designs import optimal, pi_design, pid_design, printed
from replicate.papers.panagopoulos.part_2.printed_gains import printed_number
from replicate.papers.panagopoulos.part_2.processes import NEAR_INTEGRATING, PLANTS, ROW_LABELS, ROWS, split
from replicate.papers.panagopoulos.part_2.shape import largest_gain, largest_over, stated_range
from replicate.papers.panagopoulos.part_2.tables import REPLACEMENT, SUPERSEDED, printed_properties, replacement

if TYPE_CHECKING:
    import pandas as pd

table_2 = replacement()

_SHAPE = {
    "Ms": "$M_s$",
    "curvature": r"largest $\kappa$",
    "phase": r"largest $d\arg L/d\ln\omega$",
    "ki_share": "$k_i$ / optimum",
    "ki_share_ms": "$k_i$ / optimum, circle alone",
    "k_share": "$k$ / largest $k$",
}


def _register(table: str, id: str, title: str) -> None:
    exhibit = paper.table(
        id,
        title,
        printed=False,
        rows=ROWS,
        columns=tuple(_SHAPE),
        caption="For the printed gains: $M_s$; the largest curvature and the largest slope of the phase on the stated "
        "frequency range (both should be negative); $k_i$ as a fraction of the optimum of the stated problem and of "
        "the optimum under the circle alone; $k$ as a fraction of the largest gain that any controller with this "
        "$M_s$ can have.",
        labels=ROW_LABELS | _SHAPE,
    )

    @exhibit.reading("as-written", "From the printed gains")
    def violations() -> pd.DataFrame:
        rows = {}
        for row in ROWS:
            name, ms = split(row)
            controller, span = printed(table, row), stated_range(row)
            rows[row] = {
                "Ms": printed_properties(table, row).Ms,
                "curvature": largest_over("curvature", PLANTS[name], controller, span),
                "phase": largest_over("phase", PLANTS[name], controller, span),
                "ki_share": controller.ki / optimal(row).ki,
                "ki_share_ms": controller.ki / optimal(row, "ms-only").ki,
                "k_share": controller.k / largest_gain(PLANTS[name], ms),
            }
        return exhibit.frame(rows)


_register(SUPERSEDED, "II-violations", "What the controllers of Table 1 violate")
_register(REPLACEMENT, "IIs-violations", "What the controllers of the errata violate")

TRIED_ROWS = tuple(row for row in ROWS if split(row)[0] in NEAR_INTEGRATING)
_TRIED = {
    "printed": "printed",
    "stated": "circle and phase",
    "curvature": "circle, phase, curvature",
    "ms-only": "circle alone",
    "PI": "PI design",
}
tried = paper.table(
    "IIs-tried",
    "Readings tried for $G_1$ and $G_3$",
    printed=False,
    rows=TRIED_ROWS,
    columns=tuple(_TRIED),
    caption="Integrated error $T_i/k$ of the optimum under each set of constraints, beside the printed one. An "
    "empty cell: no controller satisfies the constraints.",
    shared_labels=ROW_LABELS,
    labels=_TRIED,
)


@tried.reading("as-written", "Integrated error")
def readings_tried() -> pd.DataFrame:
    """Compare the printed integrated errors with those of all sets of constraints."""
    rows = {
        row: {
            "printed": printed_number(REPLACEMENT, row, "IE"),
            "stated": 1.0 / pid_design(row).ki,
            "curvature": 1.0 / pid_design(row, "curvature-phase").ki,
            "ms-only": 1.0 / pid_design(row, "ms-only").ki,
            "PI": 1.0 / pi_design(row).ki,
        }
        for row in TRIED_ROWS
    }
    return tried.frame(rows)
