"""The checkable sentences of paper VI on the gain k_b."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

from replicate.exhibits import Finding
from replicate.exhibits.evidence import number
from replicate.exhibits.matching import meets
from replicate.exhibits.printed import PrintedValue
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.parts_3_to_6.active_damping import EXAMPLE, K_B, k_b_from
from replicate.papers.panagopoulos.parts_3_to_6.damping_batch import OMEGA_P, batch, fit, of
from replicate.papers.panagopoulos.parts_3_to_6.vi_claims import claims

ROUNDING = 1e-6  # of ratios of two IAE


@claims.claim("k-b", "(10) gives $k_b = 2.75$ for the flexible shaft.", where="“Example”", printed="2.75")
def k_b() -> Finding:
    value = k_b_from(EXAMPLE.ratio)
    cells = paper.printed_cells("VI-example")
    (max_low, max_high), (min_low, min_high) = (
        PrintedValue(cells[row, "value"]).interval for row in ("P_max", "P_min")
    )
    # (10) rises with P_max and falls with P_min, so its range has its ends at two corners
    low, high = k_b_from(float(max_low / min_high)), k_b_from(float(max_high / min_low))
    return Finding(
        "holds" if meets(cells["k_b", "value"], value) or low <= K_B <= high else "fails",
        value,
        f"It gives {number(value)} from the exact $P_{{max}}/P_{{min}}$, and {number(low)} to {number(high)} from what "
        "rounds to the two printed numbers.",
    )


@claims.claim("function-of-ratio", "The best $k_b$ is a function of $P_{max}/P_{min}$.", where="(9), (10), Figure 6")
def function_of_ratio() -> Finding:
    slopes = {omega_p: fit(of(omega_p)) for omega_p in OMEGA_P}
    worst = max(line.largest_residual for line in slopes.values())
    return Finding(
        "holds-partly",
        slopes[OMEGA_P[-1]].slope - slopes[OMEGA_P[0]].slope,
        f"On our batch it is, for each $\\omega_p$, nearly linear in the ratio (within {number(worst, 2)}), "
        f"with a negative intercept. But the slope grows from {number(slopes[OMEGA_P[0]].slope, 3)} at "
        f"$\\omega_p$ = {OMEGA_P[0]:g} to {number(slopes[OMEGA_P[-1]].slope, 3)} at {OMEGA_P[-1]:g}: the ratio "
        "alone does not determine the gain.",
    )


@claims.claim("not-optimal", "(6) does not give the smallest IAE for all processes of a batch.", where="below (8)")
def not_optimal() -> Finding:
    above = [m for m in batch() if m.k_b > 1.0]
    worst = max(m.iae_by_formula_6 / m.iae for m in batch())
    return Finding(
        "holds" if 0 < len(above) < len(batch()) else "fails",
        worst,
        f"On our batch the best $k_b$ is above one for {len(above)} of {len(batch())} processes and below for "
        f"the others; $k_b = 1$ costs up to a factor {number(worst, 3)} in IAE.",
    )


@claims.claim(
    "refined", "The filter performs better if its gain depends on $P_{max}/P_{min}$, by (10).", where="(9), (10)"
)
def refined() -> Finding:
    costs = [(m.iae_by_formula_10 / m.iae, m.iae_by_formula_6 / m.iae) for m in batch()]
    better = sum(line < one for line, one in costs)
    worst = [max(column) for column in zip(*costs, strict=True)]
    return Finding(
        "holds" if better > len(costs) / 2 and worst[0] < worst[1] else "holds-partly",
        worst[0],
        f"On our batch, which is not the one (10) was fitted to, the IAE with (10) is smaller than with $k_b = 1$ for "
        f"{better} of {len(costs)} processes, and at most {number(worst[0], 3)} times the smallest possible, against "
        f"{number(worst[1], 3)} times. So (10) is useful although its coefficients belong to another batch.",
    )


@claims.claim("variety", "The filter works well for a variety of undamped systems.", where="“Conclusions”")
def variety() -> Finding:
    gains = [m.damping / m.zeta_p for m in batch()]
    shares = [m.iae_by_formula_10 / m.iae_without for m in batch()]
    unchanged = [m for m, share in zip(batch(), shares, strict=True) if share > 1.0 - ROUNDING]
    exceptions = " and ".join(f"$\\omega_p$ = {m.omega_p:g}, $\\zeta_p$ = {m.zeta_p:g}" for m in unchanged)
    return Finding(
        "holds" if min(gains) > 1.0 and max(shares) < 1.0 + ROUNDING else "holds-partly",
        min(gains),
        f"With (10) the inner loop is stable for all {len(gains)} processes of our batch, and its smallest damping "
        f"ratio is {number(min(gains), 2)} to {number(max(gains), 2)} times that of the process. The IAE falls to "
        f"{min(shares):.0%} in the best case; it never rises"
        + (f", and stays what it is for {exceptions}, where the output does not change sign." if unchanged else "."),
    )
