"""The checkable sentences of sections 1.2 and 8 on step responses."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq

from replicate.exhibits import Finding
from replicate.exhibits.evidence import listed
from replicate.loops import Plant, sweep
from replicate.papers.krajewski.claims import claims
from replicate.papers.krajewski.modal_models import modes, second_order_error, three_mode_error
from replicate.papers.krajewski.points import TAU, margins_at, metrics_at, named_points, response, text_point


def _points(exhibit: str) -> dict[str, tuple[float, float]]:
    return {row: (named.a, named.b) for row, named in named_points(exhibit).items()}


def _metric(exhibit: str, name: str) -> list[float]:
    return [metrics_at(*at)[name] for at in _points(exhibit).values()]


def _margin(exhibit: str, name: str) -> list[float]:
    return [margins_at(*at)[name] for at in _points(exhibit).values()]


def _rising(values: list[float]) -> bool:
    return all(x < y for x, y in pairwise(values))


@claims.claim(
    "not-rigidly-related",
    "The overshoot is not rigidly related to the phase margin, nor the rise time to the crossover frequency.",
    where="section 1.2",
)
def not_rigidly_related() -> Finding:
    same_margin = [
        metrics_at(*text_point(figure, row))["overshoot"] for figure, row in (("fig-10", "b"), ("fig-11", "a"))
    ]
    products = [w * t for w, t in zip(_margin("fig-12", "omega_A"), _metric("fig-12", "rise_time"), strict=True)]
    return Finding(
        "holds" if same_margin[0] > 1.5 * same_margin[1] and max(products) > 1.5 * min(products) else "fails",
        same_margin[0] / same_margin[1],
        f"With 60 degrees Fig. 10 (b) overshoots by {100 * same_margin[0]:.3g} %, Fig. 11 (a) by "
        f"{100 * same_margin[1]:.3g} %; along Fig. 12 the product of crossover frequency and rise time "
        f"goes from {products[0]:.3g} to {products[-1]:.3g}.",
    )


@claims.claim(
    "fig-9-third-order",
    "For t > τ all responses of Fig. 9 are well approximated by a third-order system with two complex poles.",
    where="section 8",
)
def fig_9_third_order() -> Finding:
    points = _points("fig-9").values()
    late = max(three_mode_error(a, b, 2.0 * TAU) for a, b in points)
    early = max(three_mode_error(a, b, TAU) for a, b in points)
    complex_pair = all([bool(pole.imag) for pole, _ in modes(a, b, 3)] == [False, True] for a, b in points)
    return Finding(
        "holds" if late < 0.01 and complex_pair else "fails",
        late,
        f"The real pole and the complex pair closest to the imaginary axis give the response to {late:.2g} "
        f"from t = 2τ on, and to {early:.2g} right after the dead time.",
    )


@claims.claim(
    "fig-9-slow-mode", "From P1 to P2 the importance of the slow aperiodic mode increases.", where="section 8"
)
def fig_9_slow_mode() -> Finding:
    slow = [modes(a, b, 3)[0] for a, b in _points("fig-9").values()]
    weights, rates = [abs(residue) for _, residue in slow], [-pole.real for pole, _ in slow]
    return Finding(
        "holds" if _rising(weights) and _rising(rates[::-1]) else "fails",
        weights[-1],
        f"Its weight grows, {listed(weights, 3)}, and its rate of decay falls, {listed(rates, 3)} (in 1/T).",
    )


@claims.claim(
    "fig-9-delay-unchanged",
    "From P1 to P2 the time to reach half the final value remains practically unchanged.",
    where="section 8",
)
def fig_9_delay_unchanged() -> Finding:
    values = _metric("fig-9", "delay_time")
    change = values[-1] / values[0] - 1.0
    return Finding(
        "holds" if abs(change) < 0.02 else "fails",
        change,
        f"It goes from {values[0]:.4g} to {values[-1]:.4g}, by {100 * change:.2g} %.",
    )


@claims.claim("fig-9-rise-unchanged", "From P1 to P2 the rise time remains practically unchanged.", where="section 8")
def fig_9_rise_unchanged() -> Finding:
    values = _metric("fig-9", "rise_time")
    change = values[-1] / values[0] - 1.0
    return Finding(
        "holds" if abs(change) < 0.05 else "holds-partly",
        change,
        f"From 10 to 90 % it takes {listed(values)}: {100 * change:.2g} % longer next to P2 than at P1. "
        "Small beside the change of the settling time, but not nothing.",
    )


@claims.claim("fig-9-overshoot-falls", "From P1 to P2 the overshoot decreases.", where="section 8")
def fig_9_overshoot_falls() -> Finding:
    values = [100.0 * value for value in _metric("fig-9", "overshoot")]
    return Finding("holds" if _rising(values[::-1]) else "fails", values[-1] / 100.0, f"{listed(values)} %.")


@claims.claim("fig-9-settling-grows", "From P1 to P2 the settling time increases.", where="section 8")
def fig_9_settling_grows() -> Finding:
    values = _metric("fig-9", "settling_time")
    return Finding(
        "holds" if _rising(values) else "fails",
        values[-1],
        f"To 2 %: {listed(values)}. Next to P2 far beyond any time axis that shows the rise.",
    )


@claims.claim(
    "fig-10-position",
    "On the ellipse $\\omega_A = 1.5$ the points of 60 and 75 degrees lie above the line b = a, that of 45 "
    "degrees below but close to it.",
    where="section 8",
)
def fig_10_position() -> Finding:
    exact = [named.exact() for named in named_points("fig-10").values()]
    ratios = [b / a for a, b in exact]
    return Finding(
        "holds" if 0.9 < ratios[0] < 1.0 < ratios[1] < ratios[2] else "fails",
        ratios[0],
        f"b/a is {listed(ratios)} for 45, 60 and 75 degrees.",
    )


@claims.claim(
    "fig-10-c-coordinates",
    "The ellipse $\\omega_A = 1.5$ and the curve of 75 degrees meet at (0.2842, 1.7859).",
    where="section 8, Fig. 10",
)
def fig_10_c_coordinates() -> Finding:
    named = named_points("fig-10")["c"]
    a, b = named.exact()
    at = margins_at(named.a, named.b)
    off = math.hypot(a - named.a, b - named.b)
    return Finding(
        "fails" if off > 1e-3 else "holds",
        off,
        f"They meet at ({a:.4f}, {b:.4f}). The printed point is on the curve of 75 degrees "
        f"({at['m_phi']:.5g}) but has the crossover frequency {at['omega_A']:.5g}.",
    )


@claims.claim(
    "cancellation",
    "For a = b the controller's zero cancels the pole at −1 and two dominant poles remain.",
    where="section 8",
)
def cancellation() -> Finding:
    residues = []
    for row in ("b", "c"):
        found = modes(*text_point("fig-11", row), 3)
        residues += [abs(residue) for pole, residue in found if abs(pole + 1.0) < 1e-9]
    error = max(second_order_error(*text_point("fig-11", row)) for row in ("b", "c"))
    return Finding(
        "holds" if max(residues) < 1e-12 and error < 0.01 else "fails",
        error,
        f"The mode of the pole −1 has the weight {max(residues):.1g}. The best second-order response with "
        f"a zero is within {error:.2g} of the responses of Fig. 11 (b) and (c).",
    )


@claims.claim(
    "second-order-like",
    "Fig. 10 (a) and the responses of Fig. 11 are very similar to second-order responses for t > τ; the "
    "others of Figs. 9 and 10 are not.",
    where="section 8",
)
def second_order_like() -> Finding:
    like = [
        second_order_error(*text_point("fig-10", "a")),
        *(second_order_error(*at) for at in _points("fig-11").values()),
    ]
    unlike = [second_order_error(*text_point("fig-10", row)) for row in ("b", "c")]
    unlike += [second_order_error(*at) for at in _points("fig-9").values()]
    return Finding(
        "holds" if max(like) < 0.02 and min(unlike) > 5.0 * max(like) else "fails",
        max(like),
        f"The best second-order response with a zero is within {listed(like, 2)} of them, but off by "
        f"{min(unlike):.2g} to {max(unlike):.2g} for the other responses of Figs. 9 and 10.",
    )


@claims.claim("fig-11-near-line", "The point (1, 0.91666...) is very near the line b = a.", where="section 8")
def fig_11_near_line() -> Finding:
    a, b = text_point("fig-11", "a")
    return Finding(
        "holds" if abs(b / a - 1.0) < 0.1 else "fails",
        b / a,
        f"b/a = {b / a:.4g}, and the response is within {second_order_error(a, b):.2g} of a second-order one.",
    )


@claims.claim(
    "almost-minimal-settling", "For a = b = 0.75 the settling time is almost minimal.", where="section 8, Fig. 11"
)
def almost_minimal_settling() -> Finding:
    def settling(a: float, band: float) -> float:
        return response(a, a).settling_time(band)

    best = {}
    for band in (0.02, 0.05):
        # The settling time falls with a until the overshoot reaches the band, and then jumps.
        best[band] = float(brentq(lambda a, band=band: response(a, a).overshoot() - band, 0.6, 1.3, xtol=1e-13))
        grid = np.linspace(0.4, 1.3, 91)
        plant, gains = Plant([1.0], [1.0, 1.0], dead_time=TAU), np.column_stack([grid, grid])
        least = float(np.min(sweep(plant, gains, "settling_time", band=band)["settling_time"]))
        if least < settling(best[band] * (1.0 - 1e-9), band):
            msg = f"the least settling time of the sweep, {least:g}, is below that at overshoot {band:g}"
            raise ArithmeticError(msg)
    here = settling(0.75, 0.02)
    least = settling(best[0.02] * (1.0 - 1e-9), 0.02)
    drawn = _metric("fig-11", "settling_time")
    return Finding(
        "holds-partly" if here == min(drawn) and here > 1.2 * least else ("holds" if here <= 1.2 * least else "fails"),
        here / least,
        f"It is the smallest of the three drawn ({listed(drawn)}), and close to critical damping, a = "
        f"1/(eτ) = {1.0 / (math.e * TAU):.4g}. Along b = a the least 2 % settling time is {least:.4g}, at "
        f"a = {best[0.02]:.4g}, and the least 5 % settling time is at a = {best[0.05]:.4g}; a = 0.75 needs "
        f"{here:.4g}, {here / least:.3g} times the least.",
    )


@claims.claim(
    "fig-11-trend",
    "Towards the origin along b = a the phase margin rises from 60 to 75.7 degrees and $\\omega_A$ falls from 0.96 to "
    "0.5.",
    where="section 8",
)
def fig_11_trend() -> Finding:
    margins, crossovers = _margin("fig-11", "m_phi"), _margin("fig-11", "omega_A")
    return Finding(
        "holds" if _rising(margins) and _rising(crossovers[::-1]) else "fails",
        margins[-1],
        f"{listed(margins)} degrees, $\\omega_A$ = {listed(crossovers)}.",
    )


@claims.claim(
    "fig-11-monotone",
    "Towards the origin along b = a the responses become monotonically increasing with longer rise times.",
    where="section 8",
)
def fig_11_monotone() -> Finding:
    overshoots, rises = _metric("fig-11", "overshoot"), _metric("fig-11", "rise_time")
    return Finding(
        "holds" if overshoots[1] < 1e-4 and overshoots[2] == 0.0 and _rising(rises) else "fails",
        overshoots[1],
        f"Rise times {listed(rises)}. Strictly, (b) still overshoots, by {100 * overshoots[1]:.2g} %, "
        f"since aτ = {0.75 * TAU:g} is above 1/e; no graph shows it.",
    )


@claims.claim(
    "fig-12-slow-mode",
    "Towards the b axis along b = 0.91666... the aperiodic mode gains importance and the settling time becomes longer.",
    where="section 8",
)
def fig_12_slow_mode() -> Finding:
    times = _metric("fig-12", "settling_time")
    slow = {row: modes(*at, 3)[0] for row, at in _points("fig-12").items()}
    rates = [-pole.real for pole, _ in slow.values()]
    errors = [second_order_error(*at) for at in _points("fig-12").values()]
    return Finding(
        "holds" if _rising(times) and _rising(rates[::-1]) and _rising(errors) else "fails",
        times[-1],
        f"Settling times {listed(times)}; the slowest mode decays with {listed(rates, 3)}; the distance "
        f"from a second-order response grows, {listed(errors, 2)}.",
    )
