"""The checkable sentences of paper III on Example 2."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

import numpy as np

from replicate.exhibits import Finding
from replicate.exhibits.evidence import number
from replicate.loops import Loop
from replicate.papers.panagopoulos.parts_3_to_6.iii_claims import claims
from replicate.papers.panagopoulos.parts_3_to_6.iii_examples import robustness
from replicate.papers.panagopoulos.parts_3_to_6.loop_shaping import PRINTED, TRUE_PROCESS


@claims.claim("winding", "The winding condition of the $\\nu$-gap is fulfilled.", where="Example 2")
def winding() -> Finding:
    # (-1)^2: (2s+1)^2 mirrored; 1 + (s+1)^4 (1-2s)^2 by its coefficients, independent of the gap's own count
    polynomial = np.polyadd(np.polymul(np.poly([-1.0] * 4), [4.0, -4.0, 1.0]), [1.0])
    right = int(np.sum(np.roots(polynomial).real > 0.0))
    return Finding(
        "holds" if right == 2 else "fails",
        right,
        f"$1 + (s+1)^4(1-2s)^2$ has {right} zeros in the right half-plane, as many as the degree of $A_2$ requires.",
    )


@claims.claim(
    "gap-below-margin",
    "The $\\nu$-gap is smaller than the generalised stability margin, so stability of the other loop follows.",
    where="Example 2",
)
def gap_below_margin() -> Finding:
    plain, weighted = robustness("none"), robustness("favourable")
    return Finding(
        "holds-partly" if plain.gap < plain.b and weighted.gap >= weighted.b else "fails",
        weighted.b - weighted.gap,
        f"Without weight the test succeeds: {number(plain.gap)} < {number(plain.b)}. With the paper's weight in "
        f"both numbers it is inconclusive: {number(weighted.gap)} > {number(weighted.b)}. The printed pair "
        "mixes the weighted margin with a gap that belongs to neither. Compared frequency by frequency the "
        f"weighted numbers do certify stability (smallest difference {number(weighted.smallest_difference)}).",
    )


@claims.claim("stabilises", "The controller designed for $G$ stabilises $\\bar G = 1/(2s+1)^2$.", where="Example 2")
def stabilises() -> Finding:
    loop = Loop(TRUE_PROCESS, PRINTED)
    pole = loop.rightmost_pole().real
    return Finding(
        "holds" if loop.is_stable() else "fails",
        pole,
        f"The rightmost closed-loop pole has the real part {number(pole)}, and $M_s$ = "
        f"{number(loop.sensitivity_peak().value)}: the loop is even better damped than with $G$.",
    )
