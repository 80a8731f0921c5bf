"""The checkable sentences of sections 1 and 2: what a good design is."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

import math

import numpy as np

from replicate.exhibits import Finding
from replicate.exhibits.evidence import listed, number
from replicate.loops import PI, Loop, design_pi, sweep
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_1.designs import (
    BOUNDS,
    SIX,
    complementary_peak,
    design,
    load_response,
    setpoint_peak,
)
from replicate.papers.panagopoulos.part_1.errata import (
    PAIRS,
    corrected_circle,
    geometric_circle,
    printed_circle,
)
from replicate.papers.panagopoulos.part_1.plants import PLANTS
from replicate.papers.panagopoulos.part_1.simple_models import ziegler_nichols

claims = paper.claims("I-claims", "Claims made in the text of paper I")

ROUNDING = 1e-9


# ------------------------------------------------------------------------------------------------------------
# sections 1 and 2


@claims.claim("zn-damping", "Ziegler–Nichols gives a relative damping of about 0.2.", where="section 1", printed="0.2")
def zn_damping() -> Finding:
    damping = {}
    for plant in ("G1", "G2", "G3"):
        pole = Loop(PLANTS[plant], ziegler_nichols(plant)).rightmost_pole()
        damping[plant] = -pole.real / abs(pole)
    return Finding(
        "undecided",
        damping["G1"],
        "What is typical cannot be told from the three loops of Table 5. Damping of their rightmost poles: "
        f"{listed(damping, 3)}. The two plants without dead time are damped even less than 0.2; $G_3$ with its long "
        "dead time has a real rightmost pole.",
    )


@claims.claim("ie", "The integrated error of a unit load step is $1/k_i$.", where="section 2.1.1")
def ie() -> Finding:
    off = max(abs(load_response(plant, ms).ie() * design(plant, ms).ki - 1.0) for plant in SIX for ms in BOUNDS)
    return Finding(
        "holds" if off < ROUNDING else "fails",
        off,
        "Integrating the exact load responses of the 24 designs of Table 1 gives $1/k_i$ with a relative "
        f"difference of less than {ROUNDING:g}. So the IE of Table 4, which are not $1/k_i$, were "
        "integrated numerically.",
    )


@claims.claim(
    "ie-near-iae", "With the sensitivity constraint, IE and IAE are close to each other.", where="section 2.1.1"
)
def ie_near_iae() -> Finding:
    ratio = {
        f"{plant}, $M_s = {ms}$": 1.0 / design(plant, ms).ki / load_response(plant, ms).iae()
        for plant in SIX
        for ms in BOUNDS
    }
    lowest = min(ratio, key=lambda key: ratio[key])
    close = sum(value > 0.9 for value in ratio.values())
    return Finding(
        "holds-partly",
        ratio[lowest],
        f"IE/IAE exceeds 0.9 in {close} of {len(ratio)} designs of Table 1 and falls to {number(ratio[lowest], 3)} for "
        f"{lowest}. A bound of 2 on the sensitivity does not ensure it.",
    )


@claims.claim(
    "circle-criterion",
    "With $M_s$ the loop stays stable with any gain between $M_s/(M_s+1)$ and $M_s/(M_s-1)$ in it.",
    where="section 2.1.2",
)
def circle_criterion() -> Finding:
    unstable, tried = 0, 0
    for plant in SIX:
        for ms in BOUNDS:
            found = design(plant, ms)
            factors = np.linspace(ms / (ms + 1.0), ms / (ms - 1.0), 9)
            stable = sweep(PLANTS[plant], np.outer(factors, [found.k, found.ki]), "stable")["stable"]
            tried += stable.size
            unstable += int(np.sum(~stable))
    return Finding(
        "holds" if unstable == 0 else "fails",
        unstable,
        f"Of {tried} loops with a constant gain in this range (9 for each design of Table 1) {unstable} are "
        "unstable. For nonlinear gains it is the circle criterion: the circle through the two points "
        "$-1/\\mathrm{slope}$ is the $M_s$ circle.",
    )


@claims.claim("msp-below-mp", "$M_{sp} \\leq M_p$ for $0 \\leq b \\leq 1$.", where="sections 2.1.3 and 4.1")
def msp_below_mp() -> Finding:
    excess = -math.inf
    for plant in SIX:
        for ms in BOUNDS:
            peak = complementary_peak(plant, ms).value
            for b in np.linspace(0.0, 1.0, 11):
                excess = max(excess, setpoint_peak(plant, ms, float(b)) - max(peak, 1.0))
    return Finding(
        "holds" if excess < ROUNDING else "fails",
        round(max(excess, 0.0), 12),
        "In no design of Table 1 and for no $b = 0, 0.1, \\ldots, 1$ does $|G_{sp}|$ exceed $M_p$; the factor "
        "$(k_i + bks)/(k_i + ks)$ of (5) is never larger than 1.",
    )


@claims.claim(
    "ms-parameter",
    "$M_s$ is a suitable design parameter: smaller values give slower and less oscillatory responses.",
    where="section 2.2, Figure 1",
)
def ms_parameter() -> Finding:
    responses = {ms: Loop(PLANTS["G1"], design_pi(PLANTS["G1"], ms=ms).controller).step() for ms in (1.2, 1.4, 2.0)}
    rise = [response.rise_time() for response in responses.values()]
    overshoot = [response.overshoot() for response in responses.values()]
    ordered = rise == sorted(rise, reverse=True) and overshoot == sorted(overshoot)
    return Finding(
        "holds" if ordered else "fails",
        rise[0] / rise[-1],
        f"For $G_1$ and $M_s = 1.2$, 1.4, 2 the rise time is {', '.join(number(x, 3) for x in rise)} and the overshoot "
        f"{', '.join(f'{x:.1%}' for x in overshoot)}.",
    )


@claims.claim(
    "mp-parameter",
    "$M_p$ is not: between 1.2 and 2 the time responses do not vary significantly.",
    where="section 2.2, Figure 1",
)
def mp_parameter() -> Finding:
    by_mp = {mp: design_pi(PLANTS["G1"], mp=mp) for mp in (1.2, 2.0)}
    by_ms = {ms: design_pi(PLANTS["G1"], ms=ms) for ms in (1.2, 2.0)}
    gain_mp, gain_ms = by_mp[2.0].ki / by_mp[1.2].ki, by_ms[2.0].ki / by_ms[1.2].ki
    low, high = (Loop(PLANTS["G1"], PI(x.k, x.ki)).step().overshoot() for x in by_mp.values())
    return Finding(
        "holds-partly",
        gain_mp,
        f"For $G_1$ (the paper's plant is unnamed) $k_i$ grows by a factor of {number(gain_mp, 3)} from $M_p = "
        f"1.2$ to 2, by {number(gain_ms, 3)} from $M_s = 1.2$ to 2: $M_p$ has much less influence. But the "
        f"overshoot with $b = 1$ still goes from {low:.0%} to {high:.0%}.",
    )


@claims.claim(
    "eq-7",
    "The circle (7) contains the $M_s$ and the $M_p$ circle.",
    where="section 2.2, (7), and the errata",
    consequence="formula",
)
def eq_7() -> Finding:
    ms, mp = PAIRS["Ms=2.0 Mp=1.5"]
    ratio = {float(printed_circle(*pair)[0] / corrected_circle(*pair)[0]) for pair in PAIRS.values()}
    right = sum(corrected_circle(*pair) == geometric_circle(*pair) for pair in PAIRS.values())
    return Finding(
        "holds" if ratio == {1.0} else "fails",
        float(printed_circle(ms, mp)[0] / corrected_circle(ms, mp)[0]),
        f"The article's $C$ is {', '.join(number(x) for x in sorted(ratio))} times the right one in all pairs "
        "tried: it gives the coordinate of the center, not its distance; $R$ is right. The errata's $C$ "
        f"agrees exactly (in fractions) with the smallest circle around both in {right} of {len(PAIRS)} pairs; "
        "the other one violates $M_s - 1 < M_p < M_s + 1$, where one circle sticks out at the far side.",
    )
