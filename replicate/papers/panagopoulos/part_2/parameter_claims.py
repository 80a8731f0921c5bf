"""The checkable sentences on the controller parameters, and whether the tables hold what they claim to hold."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

from collections.abc import Mapping

from replicate.exhibits import Finding
from replicate.exhibits.evidence import listed, share
from replicate.papers.panagopoulos.part_2.claims import PROCESSES, REGULAR, claims, row_of
from replicate.papers.panagopoulos.part_2.designs import optimal, printed
from replicate.papers.panagopoulos.part_2.processes import PLANTS, ROWS, split
from replicate.papers.panagopoulos.part_2.shape import largest_over, stated_range
from replicate.papers.panagopoulos.part_2.tables import REPLACEMENT, SUPERSEDED

CLOSE = 0.015  # relative: what the rounding of k and Ti and a finite tolerance may cost
ROUNDED = 0.02  # curvature that the rounding of the gains may leave


def _is_optimal(table: str, row: str) -> bool:
    c, best = printed(table, row), optimal(row)
    close = (
        abs(c.ki / best.ki - 1.0),
        abs(c.k / best.k - 1.0),
        abs(c.derivative_time / best.derivative_time - 1.0),
    )
    return max(close) <= CLOSE


@claims.claim(
    "errata-optimal",
    "The controllers of the errata are the optimum of the stated problem.",
    where="IIs, errata",
)
def errata_optimal() -> Finding:
    verdict, kept, total = share(_is_optimal(REPLACEMENT, row) for row in ROWS)
    good = [row for row in ROWS if _is_optimal(REPLACEMENT, row)]
    shares = {row: printed(REPLACEMENT, row).ki / optimal(row).ki for row in ROWS}
    inside = [shares[row] for row in good]
    return Finding(
        verdict,
        kept,
        f"True for {kept} of {total} rows, with {100 * min(inside):.4g} to {100 * max(inside):.4g} % of the largest "
        f"$k_i$; $k$, $T_i$ and $T_d$ within {100 * CLOSE:g} %. The other $k_i$ are "
        f"{listed({row: value for row, value in shares.items() if row not in good}, 3)} times that of the stated "
        "problem.",
    )


@claims.claim("table-1-feasible", "The controllers of Table 1 satisfy the curvature constraint.", where="II, Table 1")
def table_1_feasible() -> Finding:
    rows = [row for row in ROWS if split(row)[0] in REGULAR]
    found = {
        row: largest_over("curvature", PLANTS[split(row)[0]], printed(SUPERSEDED, row), stated_range(row))
        for row in rows
    }
    verdict, kept, total = share(value <= ROUNDED for value in found.values())
    return Finding(
        verdict,
        kept,
        f"Of the {total} rows with this constraint {kept} satisfy it; largest curvatures {listed(found, 3)}.",
    )


@claims.claim("k-larger", "The gain $k$ is larger for $M_s = 2.0$ than for 1.4.", where="II, section 4")
def gain_larger() -> Finding:
    ratios = {n: optimal(row_of(n, 2.0)).k / optimal(row_of(n, 1.4)).k for n in PROCESSES}
    verdict, kept, total = share(value > 1.0 for value in ratios.values())
    return Finding(verdict, min(ratios.values()), f"True for {kept} of {total}; ratios {listed(ratios, 3)}.")


@claims.claim(
    "ti-constant", "The integral time is fairly constant for all processes except $G_1$.", where="II, section 4"
)
def integral_time() -> Finding:
    ratios = {n: optimal(row_of(n, 1.4)).integral_time / optimal(row_of(n, 2.0)).integral_time for n in PROCESSES}
    verdict, kept, total = share(ratios[n] < 1.25 for n in PROCESSES if n != "G1")
    return Finding(
        verdict,
        max(value for n, value in ratios.items() if n != "G1"),
        f"$T_i$ for $M_s = 1.4$ over that for 2.0: {listed(ratios, 3)}; within a quarter for {kept} of {total}.",
    )


@claims.claim("td-larger", "The derivative time is usually larger for $M_s = 1.4$ than for 2.0.", where="II, section 4")
def derivative_time() -> Finding:
    def larger(of: Mapping[str, tuple[float, float]]) -> int:
        return sum(low > high for low, high in of.values())

    exact = {n: (optimal(row_of(n, 1.4)).derivative_time, optimal(row_of(n, 2.0)).derivative_time) for n in PROCESSES}
    tables = [
        {n: (printed(t, row_of(n, 1.4)).derivative_time, printed(t, row_of(n, 2.0)).derivative_time) for n in PROCESSES}
        for t in (SUPERSEDED, REPLACEMENT)
    ]
    count = larger(exact)
    return Finding(
        "holds" if count > 5 else "fails" if count < 4 else "holds-partly",
        count,
        f"True for {larger(tables[0])} of {len(PROCESSES)} in Table 1, for {larger(tables[1])} in the errata that "
        f"replace it, and for {count} of the optimal designs: the sentence belongs to the superseded table.",
    )


@claims.claim("complex-zeros", "All designs with $M_s = 2.0$ have complex controller zeros.", where="II, section 4")
def complex_zeros() -> Finding:
    ratios = {n: optimal(row_of(n, 2.0)).integral_time / optimal(row_of(n, 2.0)).derivative_time for n in PROCESSES}
    errata = {n: printed(REPLACEMENT, row_of(n, 2.0)) for n in PROCESSES}
    verdict, kept, total = share(value < 4.0 for value in ratios.values())
    also = sum(c.integral_time < 4.0 * c.derivative_time for c in errata.values())
    return Finding(
        verdict,
        max(ratios.values()),
        f"$T_i/T_d$ must be below 4: true for {kept} of {total} optimal designs ({listed(ratios, 3)}) and for {also} "
        f"of {total} printed ones.",
    )
