"""The checkable sentences about the design: sections 1 and 2, and the conclusions."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

import cmath
import math
from fractions import Fraction

from replicate.exhibits import Finding
from replicate.exhibits.evidence import number
from replicate.loops import Loop
from replicate.papers.ali import paper
from replicate.papers.ali.sensitivities import designed, exact_peak
from replicate.papers.ali.stability import DESIGNS
from replicate.papers.ali.structures import d_filter, plant, series, unfiltered
from replicate.papers.ali.table_1 import table_1
from replicate.papers.ali.tangency import design_loop
from replicate.papers.ali.tuning import (
    INCREMENT,
    START,
    equation_9,
    gain_product,
    integral_time,
    smallest_sensitivity,
    specified_sensitivity,
)

claims = paper.claims()

TABLE_1 = tuple(Fraction(row) for row in table_1.rows)
WORST = Fraction(9, 10)  # the last row of Table 1


def true_peak(table: str, x: Fraction) -> float:
    """Return Ms of (2) with the exact dead time for a row of Table 1 or 2."""
    return exact_peak(float(x), series(designed(table, str(float(x)))))


@claims.claim(
    "minimum-distance",
    "The design keeps the minimum distance of the Nyquist curve from $-1$ at the specified value.",
    where="abstract, section 1, section 4",
    consequence="safety",
)
def minimum_distance() -> Finding:
    design = {x: design_loop(x, "printed").sensitivity_peak() for x in TABLE_1}
    touched = {x: design_loop(x, "tangency").sensitivity_peak().value for x in TABLE_1}
    specified = {x: float(specified_sensitivity(x)) for x in TABLE_1}
    touching = [x for x in TABLE_1 if abs(touched[x] / specified[x] - 1.0) < 1e-9]
    met = [x for x in TABLE_1 if abs(design[x] / specified[x] - 1.0) < 1e-9]
    ratio = {x: true_peak("table-1", x) / specified[x] for x in TABLE_1}
    worst = max(ratio, key=lambda x: ratio[x])
    return Finding(
        "holds" if ratio[worst] < 1.01 else "fails",
        ratio[worst],
        "The paper itself says that the true $M_s$ is larger, because of the dead time. But not even the design loop "
        "(3) keeps the distance: with the printed $T_i$ its $|S|$ only approaches $1/(1 - "
        f"\\sqrt{{\\theta/2T}})$ as $\\omega \\to \\infty$, which equals $M_s^*$ in {len(met)} of {len(TABLE_1)} rows, "
        "the one with $q = 0$. The cause is the sign of $q$: with $q < 0$ the design loop meets $M_s^*$ in "
        f"{len(touching)} of {len(TABLE_1)} rows. With the exact dead time and the controller (2) the true $M_s$ is "
        f"{number(min(ratio.values()))} to {number(ratio[worst])} times the specified one.",
    )


@claims.claim(
    "y-starts-at-1.2",
    "(9) is solved with $y = 1.2$, which is incremented by 0.1.",
    where="section 2, below (10)",
    printed="1.2",
)
def y_starts() -> Finding:
    largest = max(1.0 - math.sqrt(float(x) / 2.0) for x in TABLE_1)  # |b|/T, above which q is imaginary
    return Finding(
        "holds-partly" if largest < float(START) else "holds",
        largest,
        "True of $M_s^* = 1/y$, which gives the column $M_s^*$, not of $y$. By (7) and (8) $y$ is $1/|S|$, and $q$ is "
        f"real only for $y \\le 1 - \\sqrt{{\\theta/2T}}$, at most {number(largest)} in Table 1: with $y \\ge 1.2$ no "
        "$T_i$ "
        "is real.",
    )


@claims.claim(
    "negative-ti",
    "If the $T_i$ from (9) is negative, $y$ is increased until it is positive.",
    where="section 2, below (10)",
)
def negative_ti() -> Finding:
    tried = negative = negative_part = 0
    for x in TABLE_1:
        specified = START
        while specified < specified_sensitivity(x):
            distance, y = 1.0 - math.sqrt(float(x) / 2.0), float(1 / specified)
            a, b, c = equation_9(x, specified, gain_product(x), cmath.sqrt(distance**2 - y**2))
            spread = cmath.sqrt(b * b - 4.0 * a * c)
            roots = [(-b + sign * spread) / (2.0 * a) for sign in (1.0, -1.0)]
            tried += 1
            negative += any(root.imag == 0.0 and root.real < 0.0 for root in roots)
            negative_part += max(roots, key=abs).real < 0.0
            specified += INCREMENT
    return Finding(
        "holds" if negative == tried else "holds-partly",
        negative,
        "The increments do end at the first $T_i$ that is positive. But of the "
        f"{tried} rejected specifications of Table 1, {negative} give a negative $T_i$. All give complex roots, "
        f"because $q$ is imaginary; the real part of the larger one is positive in {tried - negative_part} cases and "
        f"negative in {negative_part}, so that is not the stop test either. The test that yields the table is “the "
        "roots are real”.",
    )


@claims.claim(
    "condition-10",
    "(10) is the stability condition of the design loop, and $KK_p = \\sqrt{2T/\\theta}$ satisfies it.",
    where="section 2, (10)",
)
def condition_10() -> Finding:
    inside, agree = [], 0
    for x in TABLE_1:
        ti, gain, theta = integral_time(x), gain_product(x), float(x)
        low, high = ti / (ti - theta / 2.0), 2.0 / theta  # (10)
        inside.append(min(gain / low, high / gain))
        loop = design_loop(x, "printed")
        margins = loop.margins()
        agree += bool(
            loop.is_stable()
            and math.isclose(gain * margins.gain_reduction, low, rel_tol=1e-6)
            and math.isclose(gain * margins.gain, high, rel_tol=1e-6)
        )
    return Finding(
        "holds" if agree == len(TABLE_1) and min(inside) > 1.0 else "fails",
        min(inside),
        f"In {agree} of {len(TABLE_1)} rows the gain limits of the design loop are those of (10), and $KK_p$ "
        f"is inside them by a factor of at least {number(min(inside))}. The condition also needs $T_i > "
        "\\theta/2$, which the paper does not say.",
    )


@claims.claim(
    "all-stable",
    "The proposed settings stabilise the plant (implied by Tables 1 and 2 and the summary with (11)).",
    where="section 2",
)
def all_stable() -> Finding:
    loops = {
        (id, structure.__name__): Loop(plant(float(x)), structure(settings))
        for id, (x, settings) in DESIGNS.items()
        for structure in (series, d_filter, unfiltered)
    }
    stable = sum(loop.is_stable() for loop in loops.values())
    rightmost = max(loop.rightmost_pole().real for loop in loops.values())
    return Finding(
        "holds" if stable == len(loops) else "fails",
        rightmost,
        f"{stable} of {len(loops)} loops ({len(DESIGNS)} designs: the rows of both tables and those with $T_i$ from "
        "(11); in (2), with the filter on D only and without filter) are stable with the exact dead time; the "
        f"rightmost pole of all is at Re $p$ = {number(rightmost)}.",
    )


@claims.claim(
    "delay-approximation",
    "True and specified sensitivity differ because of the approximation of the dead time.",
    where="section 2, below Table 1",
)
def delay_approximation() -> Finding:
    x = WORST
    design = designed("table-1", "0.9")
    peaks = {s.__name__: exact_peak(float(x), s(design)) for s in (unfiltered, series, d_filter)}
    return Finding(
        "holds-partly" if peaks["series"] > 1.1 * peaks["unfiltered"] else "holds",
        peaks["unfiltered"] / smallest_sensitivity(x),
        f"For $\\theta/T = 0.9$: specified {float(specified_sensitivity(x))}; the design loop with the 1/1 "
        f"Padé delay has {number(smallest_sensitivity(x))} (with $q > 0$), the exact dead time "
        f"raises it to {number(peaks['unfiltered'])}, and the neglected derivative filter to "
        f"{number(peaks['series'])} in the form (2) and {number(peaks['d_filter'])} with the "
        "filter on D only. Neglecting the filter matters as well.",
    )
