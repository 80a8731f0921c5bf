"""How the tables of paper I are headed."""

from __future__ import annotations

from collections.abc import Iterable

from replicate.papers.panagopoulos.part_1.plants import label

COLUMNS = {
    "k": "$k$",
    "ki": "$k_i$",
    "Ti": "$T_i$",
    "b": "$b$",
    "IE": "IE",
    "IAE": "IAE",
    "IE/IAE": "IE/IAE",
    "w0": "$\\omega_0$",
    "w1": "$\\omega_1$",
    "w2": "$\\omega_2$",
    "ts": "$t_s$",
    "Ms": "$M_s$",
    "Mp": "$M_p$",
    "o": "$o$",
    "sigma": "$\\sigma$",
    "Ti/Tf": "$T_i/T_f$",
}


def design_rows(rows: Iterable[str]) -> dict[str, str]:
    """Return the display text of row keys such as ``G1 Ms=1.4``."""
    return {row: f"{label(row.split(' ')[0])}, $M_s = {row.partition('Ms=')[2]}$" for row in rows}
