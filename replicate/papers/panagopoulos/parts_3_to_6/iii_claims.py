"""The checkable sentences of paper III on the norm and its weight."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from replicate.exhibits import Finding
from replicate.exhibits.evidence import listed, number
from replicate.exhibits.extrema import largest, smallest
from replicate.loops import PI, PID, Loop, Plant, Weight, chordal_distance, gamma_norm
from replicate.loops.frequency_domain.gamma_norm import singular_value
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.parts_3_to_6.iii_examples import smallest_weight
from replicate.papers.panagopoulos.parts_3_to_6.loop_shaping import PRINTED, PROCESS, TRUE_PROCESS, favourable_weight

claims = paper.claims("III-claims", "Claims made in the text of paper III")

FREQUENCIES = np.geomspace(1e-3, 1e3, 2001)
ROUNDING = 1e-12


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
    off = 2.0 * Loop(PROCESS, PRINTED).complementary_peak().value  # with the minus sign S + T - 1 = -2L/(1 + L)
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
    "insensitive-to-ki",
    "At low frequencies $\\gamma$ is insensitive to $k_i$, which the PI and PID methods maximise.",
    where="section 4, below (11)",
)
def insensitive_to_ki() -> Finding:
    low = np.array([0.01])
    gains = {factor: PI(PRINTED.k, PRINTED.ki * factor) for factor in (0.5, 1.0, 2.0)}
    sizes = {f: float(singular_value(PROCESS, c, low, favourable_weight(c))[0]) for f, c in gains.items()}
    spread = max(sizes.values()) / min(sizes.values()) - 1.0
    tops = [gamma_norm(PROCESS, gains[f], favourable_weight(gains[f])).value for f in (0.5, 1.0, 2.0)]
    return Finding(
        "holds" if spread < 0.1 else "fails",
        spread,
        f"Between half and twice the printed $k_i$ the singular value at $\\omega$ = {low[0]:g} changes by "
        f"{spread:.1%} in Example 1, and stays near one; its maximum, near the crossover, changes from "
        f"{number(tops[0], 3)} over {number(tops[1], 3)} to {number(tops[2], 3)}.",
    )


@claims.claim("ranges", "$b_{G,G_c}$ and $\\delta_\\nu$ lie between 0 and 1.", where="section 4, Classification")
def ranges() -> Finding:
    weights = (None, favourable_weight())
    log_w = np.log(FREQUENCIES[::10])

    def size(x: float, weight: Weight | None) -> float:
        return float(singular_value(PROCESS, PRINTED, np.array([np.exp(x)]), weight)[0])

    def distance(x: float, weight: Weight | None) -> float:
        return float(chordal_distance(PROCESS, TRUE_PROCESS, np.array([np.exp(x)]), weight)[0])

    least = min(smallest(lambda x, w=weight: size(x, w), log_w)[1] for weight in weights)  # type: ignore[misc]
    gap = max(largest(lambda x, w=weight: distance(x, w), log_w)[1] for weight in weights)  # type: ignore[misc]
    return Finding(
        "holds" if least > 1.0 - ROUNDING and gap < 1.0 else "fails",
        round(least, 12),
        "$\\gamma \\ge \\max(|S| + |T|) \\ge |S + T| = 1$, and the gap is the distance of two points on a sphere of "
        f"diameter one. In Example 2 the singular value is at least {number(least)} and the distance at most "
        f"{number(gap)}.",
    )
