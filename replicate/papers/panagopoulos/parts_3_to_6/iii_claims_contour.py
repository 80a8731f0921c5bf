"""The checkable sentences of paper III on the circles, the gamma contour and Table 1."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

import numpy as np

from replicate.exhibits import Finding
from replicate.exhibits.evidence import number
from replicate.exhibits.extrema import largest, smallest
from replicate.loops import PI, Circle, Loop, design_pi, gamma_norm
from replicate.papers.panagopoulos.parts_3_to_6.iii_claims import ROUNDING, claims
from replicate.papers.panagopoulos.parts_3_to_6.iii_table_1 import printed_pairs
from replicate.papers.panagopoulos.parts_3_to_6.loop_shaping import (
    CONTOURS,
    PROCESS,
    M,
    combined_circle,
    contour,
    contour_points,
    design,
    distances,
    enclosed_area,
    favourable_weight,
    gamma_at,
    gamma_of_m,
    m_of_gamma,
)

LEVELS = (1.1, 1.4, 2.0, 3.0)  # of M, where a statement is checked for several


@claims.claim(
    "contour",
    "The formula $r(\\varphi)$ describes the curve $(1+|L|)/|1+L| = \\gamma$.",
    where="section 4, below (12)",
)
def contour_formula() -> Finding:
    off = max(float(np.max(np.abs(gamma_at(contour(gamma)) / gamma - 1.0))) for gamma in CONTOURS)
    gamma = CONTOURS[0]
    phases = np.linspace(0.7 * np.pi, np.pi, 51)

    def wrong(phase: float) -> float:
        c = (gamma**2 * np.cos(phase) - 1.0) / (gamma**2 - 1.0)
        return float(gamma_at((-c + np.sqrt(c**2) - 1.0) * np.exp(1j * phase)))

    return Finding(
        "holds" if off < ROUNDING else "fails",
        round(off, 12),
        f"For the eight contours of Figure 5 all points satisfy it to {ROUNDING:g}, if the last “$-1$” stands "
        f"under the root. Taken as printed, outside, $(1+|L|)/|1+L|$ varies from "
        f"{number(smallest(wrong, phases)[1], 3)} to {number(largest(wrong, phases)[1], 3)} for $\\gamma = 2$.",
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
        f"pairs up to {grid[-1]} this rule decides {rule} of them correctly.",
    )


@claims.claim(
    "not-more-stringent",
    "In practice the combined circle is not much more stringent than $M_s$ and $M_p$ together.",
    where="section 3",
)
def not_more_stringent() -> Finding:
    lost = {}
    for m in (1.4, M):
        both, single = design_pi(PROCESS, ms=m, mp=m), design_pi(PROCESS, ms=m)
        peak = Loop(PROCESS, PI(single.k, single.ki)).complementary_peak().value
        # where the design for Ms alone meets Mp too, it is the design for both
        lost[m] = 1.0 - both.ki / single.ki if peak <= m else float("nan")
    worst = max(lost.values())
    shares = ", ".join(f"{share:.1%} of it ($M = {m:g}$)" for m, share in lost.items())
    return Finding(
        "holds" if worst < 0.1 else "holds-partly",
        worst,
        "For the process of Example 1 the largest $k_i$ within both bounds is that for $M_s$ alone, since its $M_p$ is "
        f"smaller; the combined circle costs {shares}.",
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
        out = max(out, distances(gamma, combined_circle(m))[1] - 1.0)
        slack = min(slack, distances(gamma, combined_circle(m * 1.001))[1] - 1.0)
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
    ratios = [_largest_on_circle(m) / float(gamma_of_m(m)) for m in LEVELS]
    return Finding(
        "holds" if max(ratios) <= 1.0 + ROUNDING and gamma <= float(gamma_of_m(M)) else "fails",
        gamma,
        f"Example 1 has $\\gamma$ = {number(gamma)}, below {number(float(gamma_of_m(M)))}. On the combined "
        f"circles of $M$ = {', '.join(f'{m:g}' for m in LEVELS)} the largest $\\gamma$ is that of (14), to "
        f"{ROUNDING:g}.",
    )


def _largest_on_circle(m: float) -> float:
    """Return the largest gamma on the combined circle, whose lower half mirrors the upper one."""
    circle = combined_circle(m)

    def gamma(angle: float) -> float:
        return float(gamma_at(-circle.center + circle.radius * np.exp(1j * angle)))

    return largest(gamma, np.linspace(0.0, np.pi, 201))[1]


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
    consequence="safety",
)
def guarantee_peaks() -> Finding:
    # the point where both circles meet: |L| = 1 and |1 + L| = 1/M
    loop = np.exp(1j * np.arccos(0.5 / M**2 - 1.0))
    value = float(gamma_at(loop))
    return Finding(
        "holds-partly" if value > float(gamma_of_m(M)) else "holds",
        value,
        "True of the combined circle, of which the text speaks before. Two separate bounds allow the Nyquist curve to "
        "pass where the two circles meet. There $|S| = |T| = M_0$ and "
        f"$\\gamma = 2M_0$: {number(value)} for $M_0 = 2$, not {number(float(gamma_of_m(M)))}.",
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
        gaps[f"$M = {m:g}$"] = 1.0 - enclosed_area(gamma) / (np.pi * circle.radius**2)
    values = list(gaps.values())
    return Finding(
        "holds" if values[1] < values[0] and values[1] < 0.1 else "holds-partly",
        values[1],
        "The share of the circle that lies outside the $\\gamma$ curve, and is excluded needlessly, is "
        f"{', '.join(f'{value:.1%} ({name})' for name, value in gaps.items())}.",
    )


@claims.claim(
    "fig-6",
    "The $\\gamma$ curves of 2.06 and 3.16 are enclosed by the combined circles of $M = 1.40$ and 2.00.",
    where="Figure 6",
)
def figure_6() -> Finding:
    pairs = printed_pairs()

    def outside(m: float, gamma: float) -> float:
        return distances(gamma, combined_circle(m))[1] - 1.0

    values = [outside(*pairs[column]) for column in ("1.40", "2.00")]
    # a larger gamma has the smaller curve: is one that rounds to the print enclosed?
    rounded = [outside(m, gamma + 0.005) for m, gamma in (pairs["1.40"], pairs["2.00"])]
    return Finding(
        "holds" if max(rounded) <= 0.0 else "fails",
        max(values),
        f"With the two digits of the caption the first curve stays inside, and the second leaves its circle by "
        f"{number(values[1], 2)} of the radius: $\\gamma(2) = \\sqrt{{10}}$ is a little more than 3.16. With the "
        "unrounded $\\gamma$ both curves touch their circles from within.",
    )


@claims.claim(
    "inside-and-outside",
    "The region is bounded internally and externally by circles related to $M_s$ and $M_p$.",
    where="section 1, section 5",
)
def inside_and_outside() -> Finding:
    deepest, farthest = -np.inf, -np.inf
    for gamma in CONTOURS:
        inner, outer = combined_circle(0.5 * (gamma + 1.0)), combined_circle(float(m_of_gamma(gamma)))
        deepest = max(deepest, 1.0 - distances(gamma, inner)[0])
        farthest = max(farthest, distances(gamma, outer)[1] - 1.0)
    return Finding(
        "holds" if max(deepest, farthest) < ROUNDING else "fails",
        round(max(deepest, farthest), 12) + 0.0,
        "The combined circle of $M(\\gamma)$ encloses the curve and touches it at $A$; that of $M = "
        "(\\gamma+1)/2$ lies inside and touches it at $B$ and $D$. Neither is crossed by more than "
        f"{ROUNDING:g} for the contours of Figure 5.",
    )
