"""The checkable sentences of sections 1 to 3: the loop, its Nyquist diagram and its stability."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from replicate.exhibits import Finding
from replicate.papers.krajewski import paper
from replicate.papers.krajewski.chart_values import TAUS
from replicate.papers.krajewski.loci import constant_phase_margin, stability_boundary, upper_end
from replicate.papers.krajewski.normalised_loop import (
    crossover,
    end_frequency,
    frequency_response,
    gain_ratio,
    lag,
    loop,
    point,
)
from replicate.papers.krajewski.nyquist import asymptote, quadrant
from replicate.papers.krajewski.points import response, text_point

Array = NDArray[np.float64]

claims = paper.claims()

# Gains of both signs, and a frequency grid wide enough for every dead time of the paper.
A, B = (x.ravel() for x in np.meshgrid(np.linspace(-4.0, 4.0, 18), np.linspace(-4.0, 4.0, 18)))
W = np.geomspace(1e-4, 1e4, 4001)


def interior(count: int, seed: int, margins: tuple[float, float] = (1.0, 120.0)) -> Array:
    """Return random stable designs as rows of a, b, τ, phase margin, crossover; the seed makes them reproducible."""
    random = np.random.default_rng(seed)
    rows = []
    for _ in range(count):
        tau, margin = random.uniform(0.1, 1.0), random.uniform(*margins)
        w = end_frequency(tau, margin) * random.uniform(0.02, 0.98)
        a, b = point(tau, w, margin)
        rows.append([float(a), float(b), tau, margin, w])
    return np.array(rows)


@claims.claim("type-one", "The loop is of type one: no steady-state error in the step response.", where="section 1.2")
def type_one() -> Finding:
    y = response(*text_point("fig-11", "a"))
    error = abs(float(y(y.horizon)) - 1.0)
    return Finding(
        "holds" if error < 1e-12 else "fails",
        error,
        f"The integrator makes it so; the response of Fig. 11 (a) ends {error:.1g} from 1, which is rounding.",
    )


@claims.claim("monotone-magnitude", "|G(jω)| decreases monotonically as ω increases.", where="sections 1.2 and 3")
def monotone_magnitude() -> Finding:
    # With x = ω², d|G|²/dx has the numerator -(b²x² + 2a²x + a²): negative for every x > 0.
    x = W**2
    numerator = -(np.square(B)[:, None] * x**2 + np.square(A)[:, None] * (2.0 * x + 1.0))
    slope = numerator * x / ((np.square(A)[:, None] + np.square(B)[:, None] * x) * x * (1.0 + x))
    steepest, flattest = float(slope.min()), float(slope.max())
    return Finding(
        "holds" if flattest < 0.0 else "fails",
        flattest,
        "The derivative of |G|² with respect to x = ω² has the numerator −(b²x² + 2a²x + a²), which is "
        f"negative for all gains. In a log-log plot of |G|² against ω² the slope is between {steepest:.3g} "
        f"and {flattest:.3g}.",
    )


@claims.claim("pid-not-monotone", "With a PID controller the magnitude would not be monotone.", where="section 3")
def pid_not_monotone() -> Finding:
    # (a + b s + d s²)/s · 1/(1 + s): the derivative gain d of half the proportional gain is enough.
    a, b, d = 1.0, 1.0, 0.5
    magnitude = np.abs((a - d * W**2 + 1j * b * W) / (1j * W * (1.0 + 1j * W)))
    rise = float(np.max(magnitude[1:] / np.minimum.accumulate(magnitude)[:-1])) - 1.0
    return Finding(
        "holds" if rise > 1e-6 else "fails",
        rise,
        f"It need not be: with a = b = {a:g} and a derivative gain of {d:g} the magnitude rises by "
        f"{100 * rise:.3g} % after its least value.",
    )


@claims.claim("one-crossover", "The Nyquist diagram meets the unit circle at one point only.", where="section 3")
def one_crossover() -> Finding:
    w = crossover(A, B)
    exists = (A != 0.0) & (w > 0.0)
    below, above = (np.abs(frequency_response(A, B, 0.5, w * f)) for f in (1.0 - 1e-6, 1.0 + 1e-6))
    crosses = (below > 1.0) & (above < 1.0)
    share = float(np.mean(crosses[exists]))
    return Finding(
        "holds" if share == 1.0 else "fails",
        share,
        "(16) is quadratic in ω² with the product of its roots −a² < 0, so exactly one root is positive; "
        f"the magnitude crosses 1 there in {100 * share:.4g} % of {int(exists.sum())} loops.",
    )


@claims.claim(
    "eq-10-11", "(11a), (11b) are the unique solution of the interpolation conditions (10a), (10b).", where="section 2"
)
def eq_10_11() -> Finding:
    largest = 0.0
    for a, b, tau, margin, w in interior(500, seed=1):
        m, t = np.radians(margin), tau * w
        first = a * np.cos(t) + b * w * np.sin(t) - (w * w * np.cos(m) + w * np.sin(m))  # (10a)
        second = -a * np.sin(t) + b * w * np.cos(t) - (-w * np.cos(m) + w * w * np.sin(m))  # (10b)
        largest = max(largest, float(np.hypot(first, second)) / (w * np.hypot(1.0, w)))
    return Finding(
        "holds" if largest < 1e-12 else "fails",
        largest,
        f"They satisfy (10) to {largest:.1g}, relative, in 500 random cases; the determinant of (10) in a "
        "and b is $\\omega_A > 0$.",
    )


@claims.claim(
    "not-sufficient",
    "The interpolation conditions do not ensure the phase margin: the Nyquist diagram may encircle −1.",
    where="section 2",
)
def not_sufficient() -> Finding:
    tau = 0.5
    w = np.linspace(1.0001 * end_frequency(tau, 60.0), 40.0, 4001)
    a, b = point(tau, w, 60.0)
    first = int(np.argmax(a > 0.0))
    unstable = loop(float(a[first]), float(b[first]), tau).unstable_poles()
    left = loop(float(a[0]), float(b[0]), tau).unstable_poles()
    return Finding(
        "holds" if unstable > 0 and left > 0 else "fails",
        unstable,
        f"For τ = {tau}, 60 degrees and $\\omega_A$ above {end_frequency(tau, 60.0):.4g}, (11) gives a < 0 and an "
        f"unstable loop; from {w[first]:.4g} on it gives a > 0 again, and a loop with {unstable} unstable "
        "poles.",
    )


@claims.claim("eq-12", "For ω → 0 the abscissa of G tends to b − (1 + τ)a (12).", where="section 3")
def eq_12() -> Finding:
    w = 1e-5
    worst = max(float(np.max(np.abs(frequency_response(A, B, tau, w).real - asymptote(A, B, tau)))) for tau in TAUS)
    return Finding(
        "holds" if worst < 1e-8 else "fails", worst, f"At ω = {w:g} the two differ by {worst:.1g} at most, of order ω²."
    )


@claims.claim(
    "initial-quadrant",
    "The sign of Im G for ω → 0 is −sgn a (13), and the initial arc lies in the quadrants (i) to (iv).",
    where="section 3",
)
def initial_quadrant() -> Finding:
    wrong = 0
    for tau in TAUS:
        right = asymptote(A, B, tau)
        start = frequency_response(A, B, tau, 1e-7)
        expected = np.where(A < 0.0, np.where(right > 0.0, 1, 2), np.where(right < 0.0, 3, 4))  # (i) to (iv)
        wrong += sum(quadrant(complex(z)) != int(q) for z, q in zip(start, expected, strict=True))
    return Finding(
        "holds" if wrong == 0 else "fails",
        wrong,
        f"Of {len(TAUS) * A.size} loops with a of both signs {wrong} are elsewhere.",
    )


@claims.claim("negative-a-unstable", "Cases (i) and (ii), a < 0, are unstable.", where="section 3")
def negative_a_unstable() -> Finding:
    negative = A < 0.0
    counts = [
        loop(a, b, tau).unstable_poles()
        for tau in (0.1, 0.5, 1.0)
        for a, b in zip(A[negative][::3], B[negative][::3], strict=True)
    ]
    return Finding(
        "holds" if min(counts) > 0 else "fails",
        min(counts),
        "The characteristic function s(1 + s) + (a + bs)exp(−τs) is a < 0 at s = 0 and grows without "
        f"bound, so it has a positive real zero; the least number of unstable poles in {len(counts)} loops "
        f"is {min(counts)}.",
    )


@claims.claim(
    "stability-boundary",
    "The boundary of stability is a segment of the b axis and the curve of phase margin 0 (14).",
    where="section 3",
)
def stability_boundary_check() -> Finding:
    on_axis, wrong = 0.0, 0
    for tau in (0.1, 0.5, 1.0):
        for a, b in stability_boundary(tau).points(22)[1:-1]:
            on_axis = max(on_axis, abs(loop(a, b, tau).rightmost_pole().real))
            wrong += loop(0.999 * a, 0.999 * b, tau).unstable_poles() != 0
            wrong += loop(1.001 * a, 1.001 * b, tau).unstable_poles() == 0
        for b in np.linspace(-0.99, 0.99 * upper_end(tau, 0.0), 9):
            wrong += loop(1e-4, float(b), tau).unstable_poles() != 0
            wrong += loop(-1e-4, float(b), tau).unstable_poles() == 0
    return Finding(
        "holds" if on_axis < 1e-9 and wrong == 0 else "fails",
        on_axis,
        f"On the curve the rightmost poles are within {on_axis:.1g} of the imaginary axis. A thousandth "
        "inside it, and right of the b axis between −1 and its upper end, the loop is stable, a "
        f"thousandth outside and left of the axis unstable: {wrong} exceptions.",
    )


@claims.claim(
    "later-crossings-unstable",
    "Where the phase at $\\omega_A$ is −(2k + 1)π with k > 0 the loop is unstable.",
    where="section 3",
)
def later_crossings_unstable() -> Finding:
    counts = []
    for tau, k in ((tau, k) for tau in (0.2, 0.5, 1.0) for k in (1, 2)):
        w = np.linspace(0.01, 60.0, 6001)
        psi = lag(tau, w)
        # a > 0 where θ - 2kπ is between 0 and π: these are the points with phase -(2k + 1)π.
        for frequency in w[(psi > 2 * k * np.pi + 0.05) & (psi < (2 * k + 1) * np.pi - 0.05)][::25]:
            a, b = point(tau, float(frequency), 0.0, 1.0 - 1e-3)  # a thousandth inside, off the imaginary axis
            counts.append(loop(float(a), float(b), tau).unstable_poles())
    return Finding(
        "holds" if min(counts) > 0 else "fails",
        min(counts),
        f"The least number of unstable poles at {len(counts)} such points, with a thousandth less gain, is "
        f"{min(counts)}.",
    )


@claims.claim(
    "m-curves-inside",
    "The curves of constant phase margin lie inside the stability boundary and end on the b axis.",
    where="section 3",
)
def m_curves_inside() -> Finding:
    largest, ends = 0.0, 0.0
    for tau in (0.1, 0.5, 1.0):
        for margin in (15.0, 60.0, 120.0):
            points = constant_phase_margin(tau, margin).points(42)
            ends = max(ends, abs(float(points[0, 0])), abs(float(points[-1, 0])))
            largest = max(largest, *(gain_ratio(a, b, tau) for a, b in points[1:-1]))
    return Finding(
        "holds" if largest < 1.0 and ends < 1e-12 else "fails",
        largest,
        f"Along nine curves g stays below 1, at most {largest:.4g}; the ends are at $(0, -\\cos m)$ and "
        f"$(0, b_u)$, |a| < {1e-12:g}.",
    )
