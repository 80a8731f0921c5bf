"""The checkable sentences of section 4 and of section 7 on the shape of the loci."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from replicate.exhibits import ClaimVerdict, Finding
from replicate.papers.krajewski.chart_values import FREQUENCIES, TAUS
from replicate.papers.krajewski.claims import claims, interior
from replicate.papers.krajewski.loci import (
    Array,
    constant_gain_ratio,
    constant_phase_margin,
    crossover_ellipse,
    stability_boundary,
    upper_end,
)
from replicate.papers.krajewski.normalised_loop import (
    end_frequency,
    frequency_response,
    gain_ratio,
    lag,
    loop,
    phase_crossover,
    point,
)
from replicate.papers.krajewski.table_1 import MARGINS


@claims.claim(
    "ellipses",
    "The curves of constant $\\omega_A$ are the ellipses (16), with the half axes (17) and (18).",
    where="section 4",
)
def ellipses() -> Finding:
    worst = 0.0
    for w in FREQUENCIES:
        for a, b in crossover_ellipse(w).points(31):
            worst = max(worst, abs(float(np.abs(frequency_response(a, b, 0.5, w))) - 1.0))
        for a, b in ((0.0, np.sqrt(1.0 + w * w)), (w * np.sqrt(1.0 + w * w), 0.0)):  # (17), (18)
            worst = max(worst, abs(float(np.abs(frequency_response(a, b, 0.5, w))) - 1.0))
    return Finding(
        "holds" if worst < 1e-12 else "fails",
        worst,
        f"On them, and at their vertices, $|G(j\\omega_A)|$ is 1 to {worst:.1g}.",
    )


@claims.claim(
    "ellipse-shape",
    "$\\omega_A = 1$ gives a circle of radius √2; below it the horizontal axis is the smaller one, above it the "
    "vertical one.",
    where="section 4",
)
def ellipse_shape() -> Finding:
    circle = np.hypot(*crossover_ellipse(1.0).points(101).T)
    off = float(np.max(np.abs(circle - np.sqrt(2.0))))
    flat = all(
        (crossover_ellipse(w).points(3)[1, 0] < crossover_ellipse(w).points(3)[2, 1]) == (w < 1.0)
        for w in FREQUENCIES
        if w != 1.0
    )
    return Finding(
        "holds" if off < 1e-14 and flat else "fails",
        off,
        f"The radius is √2 to {off:.1g}; the half axes ω√(1 + ω²) and √(1 + ω²) have the ratio ω.",
    )


@claims.claim("bisector", "The ellipse of $\\omega_A$ meets the line b = a at $a = b = \\omega_A$.", where="section 4")
def bisector() -> Finding:
    worst = max(abs(float(np.abs(frequency_response(w, w, 0.5, w))) - 1.0) for w in FREQUENCIES)
    return Finding(
        "holds" if worst < 1e-14 else "fails",
        worst,
        "With a = b the controller's zero cancels the pole at −1 and |G| = a/ω exactly; "
        f"the largest error of $|G(j\\omega_A)| = 1$ is {worst:.1g}.",
    )


@claims.claim("ellipses-without-tau", "The curves of constant $\\omega_A$ do not depend on τ.", where="section 4")
def ellipses_without_tau() -> Finding:
    a, b = 0.3, 0.5
    found = [loop(a, b, tau).margins().gain_crossovers[0] for tau in TAUS]
    spread = float(np.ptp(found))
    return Finding(
        "holds" if spread < 1e-14 else "fails",
        spread,
        f"The crossover frequency of a = {a:g}, b = {b:g} is the same for all ten dead times, to {spread:.1g}.",
    )


@claims.claim(
    "infinitely-many-crossings",
    "The Nyquist diagram crosses the negative real semiaxis infinitely often.",
    where="section 7",
)
def infinitely_many_crossings() -> Finding:
    tau, a, b = 0.5, 1.0, 11 / 12
    counts = []
    for end in (100.0, 200.0, 400.0):
        w = np.linspace(0.01, end, int(200 * end))
        response = frequency_response(a, b, tau, w)
        turned = response.imag[:-1] * response.imag[1:] < 0.0
        counts.append(int(np.count_nonzero(turned & (response.real[1:] < 0.0))))
    return Finding(
        "holds" if counts[0] < counts[1] < counts[2] else "fails",
        counts[-1],
        "The dead time turns the phase without end, once around every 2π/τ: for Fig. 11 (a) "
        f"{counts[0]}, {counts[1]} and {counts[2]} crossings below ω = 100, 200 and 400.",
    )


@claims.claim(
    "omega-b-above-a", "The phase crossover frequency is above the gain crossover frequency.", where="section 7"
)
def omega_b_above_a() -> Finding:
    ratios = [phase_crossover(a, b, tau) / w for a, b, tau, _, w in interior(400, seed=2)]
    least = min(ratios)
    return Finding(
        "holds" if least > 1.0 else "fails",
        least,
        "In every stable loop, since |G| falls and is 1 at $\\omega_A$ and g < 1 at $\\omega_B$; the least ratio of "
        f"400 random designs is {least:.4g}.",
    )


@claims.claim("g-1-is-m-0", "The curve g = 1 coincides with the curve of phase margin 0.", where="section 7")
def g_1_is_m_0() -> Finding:
    worst = max(
        float(np.max(np.abs(constant_gain_ratio(tau, 1.0).points() - stability_boundary(tau).points()))) for tau in TAUS
    )
    return Finding(
        "holds" if worst == 0.0 else "fails", worst, f"(28) with g = 1 is (11) with m = 0; difference {worst:.1g}."
    )


@claims.claim(
    "g-curves-are-scaled",
    "The curves of constant g are roughly similar in form to those of constant phase margin.",
    where="section 7",
)
def g_curves_are_scaled() -> Finding:
    worst = 0.0
    for tau in (0.1, 0.5, 1.0):
        scaled = 0.5 * stability_boundary(tau).points(41)
        worst = max(worst, *(abs(gain_ratio(a, b, tau) - 0.5) for a, b in scaled[1:-1]))
    # Place of the rightmost point: b/b_u there, for both families.
    shapes = {}
    for name, locus in (("m", constant_phase_margin(0.5, 60.0)), ("g", constant_gain_ratio(0.5, 0.5))):
        points = locus.points(2001)
        shapes[name] = float(points[np.argmax(points[:, 0]), 1] / points[-1, 1])
    return Finding(
        "holds",
        shapes["m"] - shapes["g"],
        "More than that: every curve of g is the stability boundary shrunk by g towards the origin (g on "
        f"the halved boundary is 0.5 to {worst:.1g}), and the curves of phase margin resemble it: for τ = "
        f"0.5 the rightmost point is at {shapes['m']:.3g} of the upper end for 60 degrees and at "
        f"{shapes['g']:.3g} for every g.",
    )


def _between_ends(ends: list[Array], b: float) -> tuple[ClaimVerdict, float]:
    """Judge whether b is among the ends of curves on the b axis, or only between them; and how near they come."""
    enclose = all(low < b < high for low, high in ends)
    nearest = min(float(np.min(np.abs(end - b))) for end in ends)
    return "holds-partly" if enclose and nearest > 0.0 else "fails", nearest


@claims.claim(
    "ends-include-origin",
    "The two intersections of every curve g = const with the b axis include the point (0, 0).",
    where="section 7",
)
def ends_include_origin() -> Finding:
    ends = [constant_gain_ratio(tau, g).points(2)[:, 1] for tau in TAUS for g in (0.1, 0.5, 0.9)]
    verdict, nearest = _between_ends(ends, 0.0)
    return Finding(
        verdict,
        nearest,
        "True if it means that the origin lies between them: they are $(0, -g)$ and $(0, g\\,b_u)$. It is not "
        f"one of them: on 30 curves the nearest is {nearest:.3g} away.",
    )


@claims.claim(
    "ends-include-0-1",
    "The two intersections of every curve of constant phase margin with the b axis include the point (0, 1).",
    where="section 7",
)
def ends_include_0_1() -> Finding:
    ends = [constant_phase_margin(tau, float(m)).points(2)[:, 1] for tau in TAUS for m in MARGINS]
    verdict, nearest = _between_ends(ends, 1.0)
    return Finding(
        verdict,
        nearest,
        "True if it means that (0, 1) lies between them: they are $(0, -\\cos m)$ and $(0, b_u)$. No curve "
        f"passes through (0, 1): the nearest end of 60 curves is {nearest:.3g} away.",
    )


@claims.claim(
    "omega-b-lines",
    "The curves of constant $\\omega_B$ are lines b = pa through the origin (29), (30); p depends on τ but not on g.",
    where="section 7",
)
def omega_b_lines() -> Finding:
    w, worst, slopes = 2.0, 0.0, []
    for tau in TAUS:
        numerator = w * np.sin(tau * w) - np.cos(tau * w)
        p = float(numerator / (w * (np.sin(tau * w) + w * np.cos(tau * w))))  # (30)
        slopes.append(p)
        for g in (0.2, 0.5, 0.9):
            a, b = (float(x) for x in point(tau, w, 0.0, g))
            worst = max(worst, abs(b - p * a) / abs(p * a), abs(phase_crossover(a, p * a, tau) / w - 1.0))
    return Finding(
        "holds" if worst < 1e-10 and np.all(np.diff(slopes) > 0.0) else "fails",
        worst,
        f"For $\\omega_B = 2$ and ten dead times b = pa and $\\omega_B = 2$ on the line hold to {worst:.1g}; p rises "
        f"from {slopes[0]:.3g} at τ = 0.1 to {slopes[-1]:.3g} at τ = 1.",
    )


@claims.claim(
    "highest-crossover",
    "The highest crossover frequency compatible with a phase margin is that of the upper end of its curve, (21).",
    where="section 5",
)
def highest_crossover() -> Finding:
    worst = 0.0
    for tau in (0.1, 0.5, 1.0):
        for margin in (45.0, 60.0, 75.0):
            formula = float(np.sqrt(upper_end(tau, margin) ** 2 - 1.0))  # (21)

            def excess(w: float, tau: float = tau, margin: float = margin) -> float:
                # On the ellipse of ω the phase margin is largest on the b axis, π - θ(ω); it falls as ω grows.
                return float(np.degrees(np.pi - lag(tau, w))) - margin

            worst = max(worst, abs(float(brentq(excess, 0.5 * formula, 1.5 * formula, xtol=1e-14)) / formula - 1.0))
    highest = end_frequency(0.5, 60.0)
    return Finding(
        "holds" if worst < 1e-12 else "fails",
        highest,
        f"The frequency at which the largest phase margin is the required one is the same, to rounding. For τ = "
        "0.5: "
        f"{end_frequency(0.5, 45.0):.5g} for 45 degrees, {highest:.5g} for 60 and "
        f"{end_frequency(0.5, 75.0):.5g} for 75.",
    )
