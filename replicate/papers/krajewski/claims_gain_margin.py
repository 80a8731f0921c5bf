"""The checkable sentences of section 7 on specifications in terms of phase and gain margin."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from replicate.exhibits import Finding
from replicate.exhibits.extrema import largest, smallest
from replicate.papers.krajewski.claims import claims
from replicate.papers.krajewski.loci import constant_phase_margin, corners, upper_end
from replicate.papers.krajewski.normalised_loop import frequency_response, gain_ratio, lag, phase_margin
from replicate.papers.krajewski.points import TAU, margins_at, metrics_at, named_points, text_point

MARGIN, RATIO = 60.0, 0.3


def _exact_corners() -> tuple[tuple[float, float], tuple[float, float]]:
    lower, upper = corners(TAU, MARGIN, RATIO)
    return (lower.a, lower.b), (upper.a, upper.b)


@claims.claim(
    "margins-compatible-iff-curves-cross",
    "Lower bound on the phase margin and upper bound on g are compatible iff their curves cross.",
    where="section 7",
)
def margins_compatible_iff_curves_cross() -> Finding:
    locus = constant_phase_margin(TAU, MARGIN)

    def ratio(u: float) -> float:
        ((a, b),) = locus.curve(np.array([u]))[0]
        return gain_ratio(float(a), float(b), TAU)

    grid = np.linspace(0.01, 0.99, 99)
    start = float(grid[np.argmin([ratio(u) for u in grid])])
    found = minimize_scalar(ratio, bounds=(start - 0.01, start + 0.01), method="bounded", options={"xatol": 1e-10})
    least = float(found.fun)
    most = upper_end(TAU, MARGIN) / upper_end(TAU, 0.0)
    # Half of the least g on the curve: the curves do not cross, but the integral controller with that g meets both.
    wanted = 0.5 * least
    a = wanted / gain_ratio(1.0, 0.0, TAU)
    margin, g = float(phase_margin(a, 0.0, TAU)), gain_ratio(a, 0.0, TAU)
    both = margin >= MARGIN and g <= wanted * (1.0 + 1e-12)
    return Finding(
        "fails" if both and not corners(TAU, MARGIN, wanted) else "holds",
        least,
        "For inequalities they are always compatible: a small enough loop gain meets any bounds. For τ = "
        f"{TAU} and {MARGIN:g} degrees the curves cross for {least:.5g} < g* < {most:.5g} only, but for g* "
        f"= {wanted:.3g} as well there are loops that meet both, for example a = {a:.3g}, b = 0 with "
        f"{margin:.4g} degrees.",
    )


@claims.claim(
    "fig-8-corners",
    "The curves of 60 degrees and g = 0.3 intersect at (1, 0.91666...) for $\\omega_A = 0.96$ and at (0.221, "
    "−0.200) for $\\omega_A = 0.21$.",
    where="section 7, Fig. 8",
)
def fig_8_corners() -> Finding:
    lower, upper = _exact_corners()
    printed = [text_point("fig-8", row) for row in ("lower", "upper")]
    off = max(float(np.hypot(x[0] - y[0], x[1] - y[1])) for x, y in zip((lower, upper), printed, strict=True))
    at = margins_at(*printed[0])
    return Finding(
        "holds-partly" if 0.001 < off < 0.05 else ("holds" if off <= 0.001 else "fails"),
        off,
        f"Close to them. They intersect at ({upper[0]:.4f}, {upper[1]:.4f}) and ({lower[0]:.4f}, "
        f"{lower[1]:.4f}). The printed lower point has {at['m_phi']:.4g} degrees, but g = {at['g']:.4g} "
        f"and $\\omega_A = {at['omega_A']:.4g}$.",
    )


@claims.claim(
    "fig-8-nyquist",
    "Except for the graduation in ω the Nyquist diagrams of the two corners practically coincide between "
    "their intersections with the unit circle and the real axis, and differ slightly outside.",
    where="section 7",
)
def fig_8_nyquist() -> Finding:
    start, end = np.pi - np.radians(MARGIN), np.pi  # from the unit circle to the real axis

    def frequency(at: tuple[float, float], angle: float) -> float:
        """Return the frequency at which the lag, which rises along the arc, has a value."""
        a, b = at
        return float(brentq(lambda w: np.pi / 2 - np.arctan2(b * w, a) + lag(TAU, w) - angle, 1e-6, 6.0, xtol=1e-14))

    def response(at: tuple[float, float], w: float) -> complex:
        return complex(frequency_response(*at, TAU, w))

    lower, upper = _exact_corners()
    ends = {at: np.linspace(frequency(at, start), frequency(at, end), 101) for at in (lower, upper)}

    arc = frequency_response(*upper, TAU, ends[upper])

    def distance(w: float) -> float:
        """Return how far a point of one arc is from the other."""
        here = response(lower, w)
        return smallest(lambda v: abs(here - response(upper, v)), ends[upper], np.abs(here - arc))[1]

    def ratio(angle: float) -> float:
        """Return the difference of the magnitudes at the same lag: the graduation in ω drops out."""
        sizes = [abs(response(at, frequency(at, angle))) for at in (lower, upper)]
        return abs(sizes[0] / sizes[1] - 1.0)

    _, inside = largest(distance, ends[lower])
    _, outside = largest(ratio, np.linspace(0.52 * np.pi, start, 101))
    return Finding(
        "holds" if inside < 0.03 else "fails",
        inside,
        f"On that arc no point of one is further than {inside:.2g} from the other; before it, from 94 "
        f"degrees of lag on, by up to {100 * outside:.2g} % of the magnitude.",
    )


@claims.claim("fig-8-overshoots", "The overshoots at the two corners are about the same.", where="section 7")
def fig_8_overshoots() -> Finding:
    lower, upper = (metrics_at(*at)["overshoot"] for at in _exact_corners())
    return Finding(
        "holds" if abs(upper - lower) < 0.01 else "fails",
        upper - lower,
        f"{100 * upper:.3g} % at the upper and {100 * lower:.3g} % at the lower corner.",
    )


@claims.claim(
    "fig-8-rise-times",
    "The ratio of the rise times at the two corners is almost the reciprocal of that of the crossover frequencies.",
    where="section 7",
)
def fig_8_rise_times() -> Finding:
    lower, upper = _exact_corners()
    rises = metrics_at(*lower)["rise_time"] / metrics_at(*upper)["rise_time"]
    crossovers = margins_at(*upper)["omega_A"] / margins_at(*lower)["omega_A"]
    return Finding(
        "holds" if abs(rises / crossovers - 1.0) < 0.05 else "fails",
        rises / crossovers,
        f"The rise times have the ratio {rises:.4g}, the crossover frequencies {crossovers:.4g}.",
    )


@claims.claim("not-too-small-g", "A not too small value of g is often preferable.", where="section 7")
def not_too_small_g() -> Finding:
    figures = (9, 10, 11, 12)
    slowest = []
    for figure in figures:
        at = {row: (named.a, named.b) for row, named in named_points(f"fig-{figure}").items()}
        least = min(at, key=lambda row: margins_at(*at[row])["g"])
        slowest.append(least == max(at, key=lambda row: metrics_at(*at[row])["settling_time"]))
    count = sum(slowest)
    return Finding(
        "holds" if count >= len(figures) / 2 else "fails",
        count,
        f"In {count} of the {len(figures)} figures with step responses the curve with the smallest g is the one that "
        "settles last; the exception is "
        f"{', '.join(f'Figure {figure}' for figure, ok in zip(figures, slowest, strict=True) if not ok) or 'none'}.",
    )
