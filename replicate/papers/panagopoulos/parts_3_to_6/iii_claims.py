"""The checkable sentences of paper III."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from replicate.exhibits import Finding
from replicate.loops import PI, PID, Circle, Loop, Plant, Weight, gamma_norm
from replicate.loops.gamma_norm import singular_value
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.parts_3_to_6.iii_examples import robustness, smallest_weight
from replicate.papers.panagopoulos.parts_3_to_6.iii_table_1 import printed_pairs
from replicate.papers.panagopoulos.parts_3_to_6.loop_shaping import (
    CONTOURS,
    PRINTED,
    PROCESS,
    TRUE_PROCESS,
    M,
    combined_circle,
    contour,
    contour_points,
    design,
    favourable_weight,
    gamma_at,
    gamma_of_m,
    m_of_gamma,
)
from replicate.papers.panagopoulos.wording import listed, number

claims = paper.claims("III-claims", "Claims made in the text of paper III")

FREQUENCIES = np.geomspace(1e-3, 1e3, 2001)
ROUNDING = 1e-12
LEVELS = (1.1, 1.4, 2.0, 3.0)  # of M, where a statement is checked for several


def _matrices(plant: Plant, controller: PID, scale: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Return the transfer matrix (4) or (6) at the check frequencies, shape (n, 2, 2)."""
    g, gc = plant(1j * FREQUENCIES), controller.feedback(1j * FREQUENCIES)
    rows = np.array([[-g * gc, g * scale], [-gc / scale, np.ones_like(g)]]) / (1.0 + g * gc)
    return np.asarray(np.moveaxis(rows, -1, 0))


@claims.claim(
    "eq-5", "$H$ of (4) has rank one, and its largest singular value is that of (5).", where="section 2, (4), (5)"
)
def eq_5() -> Finding:
    values = np.linalg.svd(_matrices(PROCESS, PRINTED, np.ones_like(FREQUENCIES)), compute_uv=False)
    off = float(np.max(np.abs(values[:, 0] / singular_value(PROCESS, PRINTED, FREQUENCIES) - 1.0)))
    second = float(np.max(values[:, 1]))
    return Finding(
        "holds" if max(off, second) < ROUNDING else "fails",
        round(off, 12),
        f"Singular value decomposition at {FREQUENCIES.size} frequencies for Example 1: formula (5) differs by "
        f"less than {ROUNDING:g}, and so does the second singular value from zero.",
    )


@claims.claim(
    "sign-of-T",
    "The complementary sensitivity function is $T = -G(I + GG_c)^{-1}G_c$, and $S + T = 1$.",
    where="section 2, below (1); section 4",
)
def sign_of_t() -> Finding:
    loop = PROCESS(1j * FREQUENCIES) * PRINTED.feedback(1j * FREQUENCIES)
    off = float(np.max(np.abs(1.0 / (1.0 + loop) - loop / (1.0 + loop) - 1.0)))
    return Finding(
        "holds-partly",
        off,
        f"The two statements exclude each other: with the minus sign $|S + T - 1|$ is up to {number(off)} for "
        "Example 1. $S + T = 1$ needs $T = GG_c/(1 + GG_c)$. Only $|T|$ enters the results, so nothing else is "
        "affected.",
    )


@claims.claim(
    "eq-8",
    "The weight $W = \\sqrt[4]{G_cG_c^*/GG^*}$ makes the weighted singular value smallest at every frequency.",
    where="section 4, (7), (8)",
)
def eq_8() -> Finding:
    best = singular_value(PROCESS, PRINTED, FREQUENCIES, favourable_weight())
    scale = favourable_weight().magnitude(FREQUENCIES)
    least = min(
        float(np.min(np.linalg.norm(_matrices(PROCESS, PRINTED, scale * factor), 2, axis=(1, 2)) / best))
        for factor in (0.5, 0.8, 0.99, 1.0, 1.01, 1.25, 2.0)
    )
    return Finding(
        "holds" if least > 1.0 - ROUNDING else "fails",
        round(least, 12),
        "With the weight multiplied by factors from 0.5 to 2 the singular value of (6) is never below that of (8) "
        f"(smallest ratio {number(least, 6)}). $|W|$ is the square root of $|G_c|/|G|$: the fourth root is of "
        "the squares.",
    )


@claims.claim(
    "eq-10-11",
    "With this weight $\\gamma = \\max(|S| + |T|)$: it depends only on the loop transfer function.",
    where="section 4, (10) to (12)",
)
def eq_10_11() -> Finding:
    found = gamma_norm(PROCESS, PRINTED, favourable_weight())
    loop = PROCESS(1j * found.frequency) * PRINTED.feedback(1j * found.frequency)
    direct = float(abs(1.0 / (1.0 + loop)) + abs(loop / (1.0 + loop)))
    # the same loop transfer function from another plant and controller
    plant, controller = Plant(PROCESS.num * 3.0, PROCESS.den), PI(PRINTED.k / 3.0, PRINTED.ki / 3.0)
    other = gamma_norm(plant, controller, Weight.balancing(plant, controller))
    off = max(abs(direct / found - 1.0), abs(other / found - 1.0))
    plain = [gamma_norm(PROCESS, PRINTED).value, gamma_norm(plant, controller).value]
    return Finding(
        "holds" if off < 1e-10 else "fails",
        found.value,
        f"$\\gamma$ = {number(found.value, 6)} for Example 1, the same from $|S| + |T|$, and the same when a "
        f"factor 3 moves from the controller to the process. Without weight it changes from {number(plain[0])} "
        f"to {number(plain[1])}.",
    )


@claims.claim("low-high", "The weight emphasises low and high frequencies.", where="section 4, Example 1, Figure 4")
def low_high() -> Finding:
    smallest, frequency = smallest_weight()
    slope = favourable_weight().log_slope
    ends = [float(w * slope(np.array([w]))[0]) for w in (1e-4, 1e4)]
    return Finding(
        "holds" if ends[0] < 0.0 < ends[1] else "fails",
        smallest,
        f"$|W|$ is smallest, {number(smallest)}, at $\\omega$ = {number(frequency)} and grows to both sides: in "
        f"double logarithmic scales with slope {number(ends[0], 3)} towards zero and {number(ends[1], 3)} "
        "towards infinity.",
    )


@claims.claim(
    "near-crossover",
    "The largest value of $\\gamma$ occurs near the crossover frequency.",
    where="section 4, above (7)",
)
def near_crossover() -> Finding:
    peaks = {"with $W$": favourable_weight(), "without": None}
    found = {name: gamma_norm(PROCESS, PRINTED, weight).frequency for name, weight in peaks.items()}
    margins = Loop(PROCESS, PRINTED).margins()
    low, high = margins.gain_crossover, margins.phase_crossover
    inside = all(low < w < high for w in found.values())
    return Finding(
        "holds" if inside else "holds-partly",
        found["with $W$"],
        f"In Example 1 the peak is at $\\omega$ = {listed(found)}, between the gain crossover {number(low)} and "
        f"the phase crossover {number(high)}.",
    )


@claims.claim(
    "contour",
    "The formula $r(\\varphi)$ describes the curve $(1+|L|)/|1+L| = \\gamma$.",
    where="section 4, below (12)",
)
def contour_formula() -> Finding:
    off = max(float(np.max(np.abs(gamma_at(contour(gamma)) / gamma - 1.0))) for gamma in CONTOURS)
    gamma = CONTOURS[0]
    phase = np.linspace(0.7 * np.pi, np.pi, 50)
    c = (gamma**2 * np.cos(phase) - 1.0) / (gamma**2 - 1.0)
    wrong = gamma_at((-c + np.sqrt(c**2) - 1.0) * np.exp(1j * phase))
    return Finding(
        "holds" if off < ROUNDING else "fails",
        round(off, 12),
        f"For the eight contours of Figure 5 all points satisfy it to {ROUNDING:g}, if the last “$-1$” stands "
        f"under the root. Taken as printed, outside, $(1+|L|)/|1+L|$ varies from {number(float(wrong.min()), 3)} to "
        f"{number(float(wrong.max()), 3)} for $\\gamma = 2$.",
    )


@claims.claim(
    "points",
    "$OA = 1$, $OB$, $OC$, $OD$, $AC$ are as given, and $OB\\cdot OD = 1$.",
    where="section 4, Figure 5",
    printed="1",
)
def points() -> Finding:
    worst, product = 0.0, 0.0
    for gamma in CONTOURS:
        found = contour_points(gamma)
        a = np.exp(1j * found.phase_of_a)
        ends = gamma_at(np.array([a, found.ob, found.od])) / gamma - 1.0
        worst = max(worst, float(np.max(np.abs(ends))), abs(abs(a - found.oc) / found.ac - 1.0))
        product = max(product, found.ob * found.od)
    return Finding(
        "holds" if worst < ROUNDING and abs(product - 1.0) < ROUNDING else "fails",
        round(product, 12),
        "For all contours of Figure 5: $A$ on the unit circle, $B$ and $D$ lie on the curve, and $AC$ is the "
        f"distance of $A$ from $C$, all to {ROUNDING:g}. $OB$, $OC$ and $OD$ are printed as signed coordinates. "
        "$C$ is the centre and $AC$ the radius of the combined circle $M(\\gamma)$.",
    )


@claims.claim("bounds", "$2M - 1 \\le \\gamma \\le 2M$.", where="section 4")
def bounds() -> Finding:
    grid = np.linspace(-4.0, 4.0, 401)
    loop = (grid[:, None] + 1j * (grid[None, :] + 1e-3)).ravel()
    m = np.maximum(1.0, np.abs(loop)) / np.abs(1.0 + loop)
    gamma = gamma_at(loop)
    slack = min(float(np.min(gamma - (2.0 * m - 1.0))), float(np.min(2.0 * m - gamma)))
    return Finding(
        "holds" if slack > -1e-9 else "fails",
        round(slack, 12) + 0.0,
        f"At {loop.size} points of the plane, with $M$ the larger of $|S|$ and $|T|$: the smallest distance to "
        f"a bound is {number(max(slack, 0.0), 2)}. Both are reached: the upper one on the unit circle, where "
        "$|S| = |T|$, the lower one on the real axis between $-1$ and 0.",
    )


@claims.claim(
    "combined-circle",
    "The combined circle with diameter $[-M_p/(M_p-1), -(M_s-1)/M_s]$ contains both circles.",
    where="section 3",
)
def combined() -> Finding:
    def inside(ms: float, mp: float) -> bool:
        both, outer = (Circle.of(ms=ms), Circle.of(mp=mp)), Circle.of(ms=ms, mp=mp)
        return all(abs(c.center - outer.center) + c.radius <= outer.radius * (1.0 + ROUNDING) for c in both)

    grid = [round(1.05 + 0.05 * i, 2) for i in range(60)]
    kept = {(ms, mp): inside(ms, mp) for ms in grid for mp in grid}
    rule = sum(kept[ms, mp] == (abs(ms - mp) <= 1.0 + 1e-9) for ms, mp in kept)
    equal = all(kept[m, m] for m in grid)
    return Finding(
        "holds-partly" if equal else "fails",
        rule / len(kept),
        f"For equal bounds always. For unequal ones only if $|M_s - M_p| \\le 1$: on a grid of {len(kept)} "
        f"pairs up to {grid[-1]} this rule decides {rule} of them rightly.",
    )


@claims.claim(
    "eq-13-14",
    "(13) gives the combined circle that encloses the $\\gamma$ curve, and (14) is its inverse.",
    where="section 4, (13), (14)",
)
def eq_13_14() -> Finding:
    back = max(abs(float(gamma_of_m(m_of_gamma(gamma))) / gamma - 1.0) for gamma in CONTOURS)
    out, slack = -np.inf, np.inf
    for gamma in CONTOURS:
        m = float(m_of_gamma(gamma))
        curve = contour(gamma)
        circle, smaller = combined_circle(m), combined_circle(m * 1.001)
        out = max(out, float(np.max(np.abs(curve + circle.center))) / circle.radius - 1.0)
        slack = min(slack, float(np.max(np.abs(curve + smaller.center))) / smaller.radius - 1.0)
    return Finding(
        "holds" if out < ROUNDING and back < ROUNDING and slack > 0.0 else "fails",
        round(out, 12) + 0.0,
        f"For the contours of Figure 5 no point leaves its circle (to {ROUNDING:g}), and the formulas are "
        "inverse to each other. The enclosure is sharp: circle and curve touch where $|L| = 1$, and with $M$ "
        f"larger by 0.1 % every curve leaves its circle (by at least {number(slack, 2)} of the radius).",
    )


@claims.claim(
    "table-1",
    "Table 1 lists corresponding values of $M$ and $\\gamma$.",
    where="section 4, Table 1",
)
def table_1() -> Finding:
    def fits(value: float, printed: float) -> bool:
        return abs(value - printed) <= 0.005 + 1e-12

    pairs = printed_pairs()
    forward = [c for c, (m, gamma) in pairs.items() if fits(float(gamma_of_m(m)), gamma)]
    backward = [c for c, (m, gamma) in pairs.items() if fits(float(m_of_gamma(gamma)), m)]
    other = [c for c in pairs if c not in forward]
    return Finding(
        "holds" if set(forward) | set(backward) == set(pairs) else "fails",
        len(forward),
        f"All {len(pairs)} columns fit one of the formulas. {len(forward)} fit $\\gamma(M)$; the columns "
        f"{', '.join(other)} were made the other way round, from the round values $\\gamma$ = "
        f"{', '.join(f'{pairs[c][1]:.2f}' for c in other)}, with $M(\\gamma)$ rounded.",
    )


@claims.claim(
    "guarantee-circle",
    "A controller designed with the combined circle for $M_s = M_p = M$ has a $\\gamma$ below that of (14).",
    where="section 4, below (14)",
)
def guarantee_circle() -> Finding:
    found = design()
    controller = PI(found.k, found.ki)
    gamma = gamma_norm(PROCESS, controller, favourable_weight(controller)).value
    ratios = [float(np.max(gamma_at(_circle_points(m)))) / float(gamma_of_m(m)) for m in LEVELS]
    return Finding(
        "holds" if max(ratios) <= 1.0 + ROUNDING and gamma <= float(gamma_of_m(M)) else "fails",
        gamma,
        f"Example 1 has $\\gamma$ = {number(gamma)}, below {number(float(gamma_of_m(M)))}. On the combined "
        f"circles of $M$ = {', '.join(f'{m:g}' for m in LEVELS)} the largest $\\gamma$ is that of (14), to "
        f"{ROUNDING:g}.",
    )


def _circle_points(m: float) -> NDArray[np.complex128]:
    """Return points of the combined circle, those on the unit circle among them."""
    circle = combined_circle(m)
    # |L| = 1 and |L + C| = R: cos(phi) = (R^2 - C^2 - 1)/(2 C)
    special = np.arccos((circle.radius**2 - circle.center**2 - 1.0) / (2.0 * circle.center))
    angles = np.linspace(0.0, 2.0 * np.pi, 20_001)
    return np.concatenate([-circle.center + circle.radius * np.exp(1j * angles), [np.exp(1j * special)]])


@claims.claim("sqrt-10", "$M = 2$ guarantees $\\gamma < \\sqrt{10}$.", where="section 4, below Table 1", printed="3.16")
def sqrt_10() -> Finding:
    value = float(gamma_of_m(M))
    return Finding(
        "holds" if abs(value**2 - 10.0) < ROUNDING else "fails",
        value,
        f"(14) gives $\\gamma(2) = {number(value, 7)} = \\sqrt{{10}}$ exactly; it is reached where the circle "
        "meets the unit circle.",
    )


@claims.claim(
    "guarantee-peaks",
    "A controller that satisfies $M_p < M_0$ and $M_s < M_0$ guarantees $\\gamma \\le \\gamma(M_0)$.",
    where="section 4, below the $\\nu$-gap",
)
def guarantee_peaks() -> Finding:
    # the point where both circles meet: |L| = 1 and |1 + L| = 1/M
    loop = np.exp(1j * np.arccos(0.5 / M**2 - 1.0))
    value = float(gamma_at(loop))
    return Finding(
        "fails" if value > float(gamma_of_m(M)) else "holds",
        value,
        "Two separate bounds allow the Nyquist curve to pass where the two circles meet. There $|S| = |T| = M_0$ and "
        f"$\\gamma = 2M_0$: {number(value)} for $M_0 = 2$, not {number(float(gamma_of_m(M)))}. The sentence is "
        "true for the combined circle.",
    )


@claims.claim(
    "not-conservative",
    "Designs with the combined circle are not much more conservative than with $\\gamma$, particularly for $M = 2$.",
    where="section 4, Figure 6",
)
def not_conservative() -> Finding:
    gaps = {}
    for m in (1.4, 2.0):
        gamma, circle = float(gamma_of_m(m)), combined_circle(m)
        curve = contour(gamma)
        inside = 0.5 * abs(float(np.sum((curve[:-1].conj() * curve[1:]).imag)))
        gaps[f"$M = {m:g}$"] = 1.0 - inside / (np.pi * circle.radius**2)
    values = list(gaps.values())
    return Finding(
        "holds" if values[1] < values[0] and values[1] < 0.1 else "holds-partly",
        values[1],
        "The share of the circle that lies outside the $\\gamma$ curve, and is forbidden needlessly, is "
        f"{', '.join(f'{value:.1%} ({name})' for name, value in gaps.items())}.",
    )


@claims.claim(
    "inside-and-outside",
    "The region is bounded internally and externally by circles related to $M_s$ and $M_p$.",
    where="section 1, section 5",
)
def inside_and_outside() -> Finding:
    deepest, farthest = -np.inf, -np.inf
    for gamma in CONTOURS:
        curve = contour(gamma)
        inner, outer = combined_circle(0.5 * (gamma + 1.0)), combined_circle(float(m_of_gamma(gamma)))
        deepest = max(deepest, 1.0 - float(np.min(np.abs(curve + inner.center))) / inner.radius)
        farthest = max(farthest, float(np.max(np.abs(curve + outer.center))) / outer.radius - 1.0)
    return Finding(
        "holds" if max(deepest, farthest) < ROUNDING else "fails",
        round(max(deepest, farthest), 12) + 0.0,
        "The combined circle of $M(\\gamma)$ encloses the curve and touches it at $A$; that of $M = "
        "(\\gamma+1)/2$ lies inside and touches it at $B$ and $D$. Neither is crossed by more than "
        f"{ROUNDING:g} for the contours of Figure 5.",
    )


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
        f"both numbers it does not decide: {number(weighted.gap)} > {number(weighted.b)}. The printed pair "
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
