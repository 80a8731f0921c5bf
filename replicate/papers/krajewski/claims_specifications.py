"""The checkable sentences of sections 5 and 6: compatibility, Table 1, the design procedure and robustness."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from replicate.exhibits import Finding
from replicate.exhibits.evidence import listed, share
from replicate.loops import PI, Loop, Plant
from replicate.papers.krajewski.chart_values import TAUS
from replicate.papers.krajewski.claims import claims, interior
from replicate.papers.krajewski.design import design
from replicate.papers.krajewski.loci import constant_crossover, constant_phase_margin
from replicate.papers.krajewski.normalised_loop import (
    end_frequency,
    gain_ratio,
    lag,
    phase_margin,
)
from replicate.papers.krajewski.points import TAU
from replicate.papers.krajewski.robustness import (
    LABELS,
    PAPERS_VERTEX,
    POINTS,
    SPREADS,
    at_vertices,
    changed,
    designs,
    worst_in_box,
    worst_vertices,
)
from replicate.papers.krajewski.table_1 import MARGINS, hyperbola_fit, printed_coefficients, upper_ends
from replicate.papers.krajewski.table_1_errors import errors, residuals, sign_changes, single_digit_slips


def _largest_margin(points: NDArray[np.float64], tau: float) -> float:
    return float(np.max(phase_margin(points[:, 0], points[:, 1], tau)))


@claims.claim(
    "compatible-iff-arc",
    "A phase margin and a crossover frequency are compatible iff an arc of the ellipse lies left of the "
    "curve of the phase margin.",
    where="section 5",
)
def compatible_iff_arc() -> Finding:
    random = np.random.default_rng(3)
    wrong = 0
    for _ in range(300):
        tau, margin = random.uniform(0.1, 1.0), random.uniform(10.0, 120.0)
        w = end_frequency(tau, margin) * random.uniform(0.5, 1.5)
        # Brute force: the margins of the stable loops on the ellipse, against the curve's highest frequency.
        ellipse = constant_crossover(tau, w)
        best = -1.0 if ellipse is None else _largest_margin(ellipse.points(4001), tau)
        wrong += (best >= margin) != (w < end_frequency(tau, margin))
    return Finding(
        "holds" if wrong == 0 else "fails",
        wrong,
        "Along an ellipse the phase margin rises steadily towards the b axis, so the two statements are "
        f"the same; {wrong} exceptions in 300 random pairs.",
    )


@claims.claim(
    "omega-2-and-75",
    "For τ = 0.5 the crossover frequency 2 is not compatible with 75 degrees: its arc is outside that curve.",
    where="section 5, Fig. 5",
)
def omega_2_and_75() -> Finding:
    highest = end_frequency(TAU, 75.0)
    return Finding(
        "holds" if highest < 2.0 else "fails",
        highest,
        f"75 degrees allow at most {highest:.5g}. (60 degrees allow {end_frequency(TAU, 60.0):.5g}, so "
        "they are not compatible either, though just.)",
    )


@claims.claim(
    "omega-2-and-45", "For τ = 0.5 the crossover frequency 2 is compatible with 45 degrees.", where="section 5, Fig. 5"
)
def omega_2_and_45() -> Finding:
    highest = end_frequency(TAU, 45.0)
    return Finding("holds" if highest > 2.0 else "fails", highest, f"45 degrees allow up to {highest:.5g}.")


@claims.claim(
    "omega-1.5",
    "For τ = 0.5 the crossover frequency 1.5 is compatible with 45, 60 and 75 degrees.",
    where="Fig. 5, section 8",
)
def omega_1_5() -> Finding:
    highest = {f"{margin:g} degrees": end_frequency(TAU, margin) for margin in (45.0, 60.0, 75.0)}
    verdict, _, _ = share(limit > 1.5 for limit in highest.values())
    return Finding(verdict, min(highest.values()), f"The highest crossover frequencies are {listed(highest, 5)}.")


@claims.claim(
    "arc-p1-p2",
    "Along the arc P1 P2 the phase margin ranges from 45 degrees to almost 60.",
    where="section 5",
)
def arc_p1_p2() -> Finding:
    arc = constant_crossover(TAU, 2.0, 45.0)
    assert arc is not None  # noqa: S101  -- the claim above
    points = arc.points(201)[:-1]
    margins = phase_margin(points[:, 0], points[:, 1], TAU)
    largest = 180.0 - float(np.degrees(lag(TAU, 2.0)))
    rising = bool(np.all(np.diff(margins) > 0.0))
    return Finding(
        "holds" if rising and abs(margins[0] - 45.0) < 1e-9 and 59.0 < largest < 60.0 else "fails",
        largest,
        f"It rises steadily from 45 to {largest:.6g} degrees, the limit at P2, where the integral action is gone.",
    )


@claims.claim(
    "very-well-approximated",
    "For τ between 0.1 and 1 the dependence of $b_u$ on τ is very well approximated by the hyperbola (22).",
    where="section 5",
)
def very_well_approximated() -> Finding:
    fits = {margin: errors(margin, hyperbola_fit(upper_ends(margin))) for margin in MARGINS}
    of_b = {margin: abs(found[0].value) for margin, found in fits.items()}
    of_omega = {margin: abs(found[1].value) for margin, found in fits.items()}
    worst = max(of_omega.values())
    percent_b, percent_omega = (listed([100.0 * error for error in of.values()], 2) for of in (of_b, of_omega))
    return Finding(
        "holds-partly" if min(of_omega.values()) < 0.01 < worst else "holds",
        worst,
        f"For {', '.join(MARGINS)} degrees the least-squares hyperbola is off by up to {percent_b} % in "
        f"$b_u$, and by up to {percent_omega} % in the crossover frequency it is made for. Good for 30 "
        "and 45 degrees; for more solve arctan ω + τω = π − m instead.",
    )


@claims.claim("table-1-least-squares", "Table 1 gives the mean square values of μ and ν.", where="section 5, Table 1")
def table_1_least_squares() -> Finding:
    wrong = []
    for margin in MARGINS:
        off = np.abs(np.array(hyperbola_fit(upper_ends(margin))) - printed_coefficients(margin))
        if np.any(off > 1.5e-4):
            wrong.append(margin)
    r = residuals("45")
    ((tau, right, slip),) = single_digit_slips("75")
    return Finding(
        "holds-partly" if wrong else "holds",
        len(wrong),
        "Least squares over τ = 0.1, ..., 1 give the columns of 30, 60, 90 and 120 degrees. The column of "
        "45 degrees cannot be a fit of correct values with any weights: its residuals change sign "
        f"{sign_changes(r)} time instead of at least twice, and add up to {r.sum():.3g} instead of 0; "
        f"{len(single_digit_slips('45'))} single wrong digits explain it. For 75 degrees ν is off; of all "
        f"single wrong digits in the ten values one gives both printed coefficients, {slip} for {right} at "
        f"τ = {tau:g}.",
    )


@claims.claim(
    "design-procedure",
    "The steps (i) to (iv) with (23) give a controller that meets the specifications.",
    where="section 6",
)
def design_procedure() -> Finding:
    random = np.random.default_rng(4)
    worst = 0.0
    for _ in range(60):
        K, T, tau = random.uniform(0.2, 5.0), random.uniform(0.1, 50.0), random.uniform(0.1, 1.0)
        margin = random.uniform(30.0, 110.0)
        w = end_frequency(tau, margin) * random.uniform(0.05, 0.95) / T
        plant = Plant.foptd(K, T, tau * T)
        margins = Loop(plant, design(plant, margin, w).controller()).margins()
        worst = max(worst, abs(margins.phase - margin) / margin, abs(margins.gain_crossover / w - 1.0))
    return Finding(
        "holds" if worst < 1e-9 else "fails",
        worst,
        "The finished loops of 60 random processes have the specified phase margin and crossover "
        f"frequency to {worst:.1g}, relative.",
    )


@claims.claim(
    "nearest-chart",
    "The chart whose τ is closest to the actual normalised delay serves for the design.",
    where="section 6, step (i)",
)
def nearest_chart() -> Finding:
    # Half a step beyond a chart: the phase lost is ω Δτ, the crossover frequency does not change.
    losses = {tau: float(np.degrees(0.05 * end_frequency(tau, 60.0))) for tau in TAUS}
    first, last = losses[TAUS[0]], losses[TAUS[-1]]
    return Finding(
        "holds-partly" if first > 5.0 > last else "holds",
        first,
        "For τ half a step above the chart's, the phase margin is smaller by $\\omega_A \\Delta\\tau$. At the upper "
        f"end of the curve of 60 degrees that is {first:.3g} degrees on the chart τ = 0.1 and {last:.3g} degrees "
        "on τ = 1: charts for small τ must be interpolated, or drawn for the actual τ.",
    )


@claims.claim(
    "eq-24",
    "A changed process moves the loop to $a' = K'K_I T'$, $b' = K'K_P$, $\\tau' = L'/T'$ (24).",
    where="section 6",
)
def eq_24() -> Finding:
    random = np.random.default_rng(5)
    worst = 0.0
    for a, b, tau, _, _ in interior(60, seed=5, margins=(50.0, 100.0)):
        K, L, T = random.uniform(0.9, 1.1, 3)
        there = changed((a, b, tau), K, L, T)
        margins = Loop(Plant.foptd(K, T, tau * L), PI(k=b, ki=a)).margins()
        gain_crossover = float(there.crossover)
        worst = max(
            worst,
            abs(margins.phase / float(there.phase_margin) - 1.0),
            abs(margins.gain_crossover / gain_crossover - 1.0),
        )
    return Finding(
        "holds" if worst < 1e-9 else "fails",
        worst,
        "Phase margin and crossover frequency from (24) and those of the changed loops agree to "
        f"{worst:.1g} in 60 random cases.",
    )


@claims.claim(
    "worst-vertex",
    "For the phase margin the worst case usually is the vertex $[K_M, L_M, T_m]$.",
    where="section 6",
)
def worst_vertex() -> Finding:
    shares = {spread: worst_vertices(spread)[0].count(PAPERS_VERTEX) / len(designs()) for spread in SPREADS}
    own = {
        key: np.argmin(at_vertices((a, b, TAU), 20).phase_margin) == list(LABELS).index(PAPERS_VERTEX)
        for key, (a, b) in POINTS.items()
    }
    too_high = [
        float(at_vertices((a, b, TAU), 20).phase_margin[list(LABELS).index(PAPERS_VERTEX)])
        - worst_in_box((a, b, TAU), 20)
        for key, (a, b) in POINTS.items()
        if not own[key]
    ]
    return Finding(
        "holds-partly" if 0.25 < shares[20] < 0.75 else ("holds" if shares[20] >= 0.75 else "fails"),
        shares[20],
        f"In {100 * shares[10]:.3g}, {100 * shares[20]:.3g} and {100 * shares[30]:.3g} % of "
        f"{len(designs())} designs for ±10, 20 and 30 %. $L_M$ is always worst; the shortest T is worst for "
        "fast designs only (for b = a and small deviations iff $\\tau\\omega_A^2 > 1$), otherwise the longest is. Of "
        f"the paper's own points {sum(own.values())} of {len(own)} have their worst case there; for the "
        f"others the vertex overstates the worst phase margin by {min(too_high):.2g} to "
        f"{max(too_high):.2g} degrees at ±20 %.",
    )


@claims.claim(
    "extremes-at-vertices",
    "The worst case can be found from the vertices and edges of the box.",
    where="section 6",
)
def extremes_at_vertices() -> Finding:
    excess = [float(at_vertices(design, 30).phase_margin.min()) - worst_in_box(design, 30) for design in designs()[::5]]
    return Finding(
        "holds" if max(excess) < 1e-3 else "fails",
        max(excess),
        f"For the phase margin the vertices are enough: in {len(excess)} designs, ±30 %, no point of the "
        f"box is more than {max(excess):.1g} degrees worse than the worst vertex.",
    )


@claims.claim(
    "large-margin-acceptable-gain",
    "In general a rather large phase margin implies an acceptable gain margin too.",
    where="section 1.2",
)
def large_margin_acceptable_gain() -> Finding:
    lower_end = float(np.cos(np.radians(60.0)))  # where the curve begins, G is real and negative
    largest = {
        tau: max(lower_end, *(gain_ratio(a, b, tau) for a, b in constant_phase_margin(tau, 60.0).points(202)[1:]))
        for tau in TAUS
    }
    worst = max(largest, key=lambda tau: largest[tau])
    return Finding(
        "holds-partly" if largest[worst] > 0.6 else "holds",
        1.0 / largest[worst],
        f"With 60 degrees or more g is at most {largest[TAUS[0]]:.3g} for τ = 0.1, {largest[TAU]:.3g} for "
        f"0.5 and {largest[1.0]:.3g} for 1: the gain margin 1/g is at least 2 for short dead times, but "
        f"can be as low as {1.0 / largest[worst]:.3g} at the upper end of the curve for τ = {worst:g}, "
        "where almost no integral action is left.",
    )
