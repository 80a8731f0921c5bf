"""The checkable sentences of section 5.1: the typical process control problems."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

from replicate.exhibits import Finding
from replicate.exhibits.evidence import listed, number
from replicate.exhibits.matching import meets
from replicate.loops import Loop
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_1.claims_specifications import claims
from replicate.papers.panagopoulos.part_1.designs import (
    BOUNDS,
    SIX,
    complementary_peak,
    controller,
    design,
    load_response,
    weight,
)
from replicate.papers.panagopoulos.part_1.plants import PLANTS
from replicate.papers.panagopoulos.part_1.settling import one_sided, two_sided

LOW, HIGH = 1.4, 2.0
STABLE = tuple(plant for plant in SIX if plant != "G4")


@claims.claim(
    "similar-responses",
    "The responses of $G_1$ to $G_6$ become similar for each $M_s$.",
    where="section 5.1, Figure 4",
)
def similar_responses() -> Finding:
    spread = {}
    for ms in (LOW, HIGH):
        rise = [
            design(plant, ms).frequency * Loop(PLANTS[plant], controller(plant, ms, "w_0")).step().rise_time()
            for plant in SIX
        ]
        spread[ms] = (min(rise), max(rise))
    (low_1, high_1), (low_2, high_2) = spread.values()
    return Finding(
        "holds" if high_2 / low_2 < 1.5 and high_1 / low_1 < 1.5 else "holds-partly",
        high_2 / low_2,
        f"In units of $1/\\omega_0$ the rise times are between {number(low_1, 3)} and {number(high_1, 3)} for "
        f"$M_s = {LOW}$, between {number(low_2, 3)} and {number(high_2, 3)} for $M_s = {HIGH:g}$: similar for "
        "the larger $M_s$, less so for the smaller one.",
    )


@claims.claim(
    "little-overshoot", "Responses with $M_s = 1.4$ show little or no overshoot.", where="section 5.1, Figure 4"
)
def little_overshoot() -> Finding:
    printed = {p: Loop(PLANTS[p], controller(p, LOW, "w_0")).step().overshoot() for p in SIX}
    stated = {p: Loop(PLANTS[p], controller(p, LOW, "w_mp")).step().overshoot() for p in SIX}
    return Finding(
        "holds" if max(printed.values()) < 0.05 else "holds-partly",
        max(printed.values()),
        "With the printed $b$ the overshoot is "
        + ", ".join(f"{value:.1%} ({plant})" for plant, value in printed.items() if value > 0.02)
        + f" and below 2 % otherwise; with $b$ as the text says it is at most {max(stated.values()):.1%}.",
    )


@claims.claim(
    "larger-overshoot",
    "Responses with $M_s = 2$ are faster and more oscillatory, with a larger overshoot.",
    where="section 5.1, Figure 4",
)
def larger_overshoot() -> Finding:
    faster, larger, flips = 0, 0, []
    for plant in SIX:
        slow, fast = (Loop(PLANTS[plant], controller(plant, ms, "w_0")).step() for ms in (LOW, HIGH))
        faster += fast.rise_time() < slow.rise_time()
        larger += fast.overshoot() > slow.overshoot()
        if fast.overshoot() <= slow.overshoot():
            flips.append(f"{plant} ({slow.overshoot():.1%}, then {fast.overshoot():.1%})")
    return Finding(
        "holds" if faster == larger == len(SIX) else "holds-partly",
        larger,
        f"The rise is faster for {faster} of {len(SIX)} plants; the overshoot with the printed $b$ is larger "
        f"for {larger}" + (f", not for {', '.join(flips)}." if flips else "."),
    )


@claims.claim(
    "settling-shorter",
    "The settling time at load disturbances is significantly shorter with $M_s = 2$.",
    where="section 5.1, Table 1",
)
def settling_shorter() -> Finding:
    ratios: dict[str, dict[str, float]] = {"print": {}, "one": {}, "five": {}, "two": {}}
    for plant in SIX:
        slow, fast = load_response(plant, LOW), load_response(plant, HIGH)
        dead_time = PLANTS[plant].dead_time
        ratios["one"][plant] = one_sided(fast, dead_time) / one_sided(slow, dead_time)
        ratios["five"][plant] = two_sided(fast) / two_sided(slow)
        ratios["two"][plant] = two_sided(fast, 0.02) / two_sided(slow, 0.02)
    times = paper.printed_numbers("I-table-1")
    ratios["print"] = {p: times[f"{p} Ms={HIGH}", "ts"] / times[f"{p} Ms={LOW}", "ts"] for p in SIX}
    shorter = {kind: sum(value < 0.8 for value in found.values()) for kind, found in ratios.items()}
    worst = max(ratios["five"], key=lambda plant: ratios["five"][plant])
    return Finding(
        "holds" if shorter["five"] == len(SIX) else "holds-partly",
        ratios["five"][worst],
        f"The printed times are shorter by a fifth or more for {shorter['print']} of {len(SIX)} plants. Exact ones are "
        f"for {shorter['one']} if only what is above $+5$ % of a unit load counts, which is the definition that fits "
        f"the print; for {shorter['five']} with a band of $\\pm 5$ % (the ratios are {listed(ratios['five'], 3)}); for "
        f"{shorter['two']} with $\\pm 2$ % ({listed(ratios['two'], 3)}). The faster loops undershoot zero, which the "
        "one-sided definition ignores.",
    )


@claims.claim(
    "ie-iae-falls",
    "IE/IAE shows that the responses for $M_s = 2$ are more oscillatory.",
    where="section 5.1, Table 1",
)
def ie_iae_falls() -> Finding:
    ratio = {
        plant: [1.0 / design(plant, ms).ki / load_response(plant, ms).iae() for ms in (LOW, HIGH)] for plant in SIX
    }
    fall = {plant: high - low for plant, (low, high) in ratio.items()}
    return Finding(
        "holds" if max(fall.values()) < 0.0 else "fails",
        max(fall.values()),
        "IE/IAE falls from $M_s = 1.4$ to 2 for every plant, by "
        + ", ".join(f"{number(-value, 2)} ({plant})" for plant, value in fall.items())
        + ".",
    )


@claims.claim(
    "ti-constant",
    "$k$ varies significantly with $M_s$, but $T_i$ is fairly constant except for $G_4$.",
    where="section 5.1",
)
def ti_constant() -> Finding:
    ti = {p: design(p, HIGH).integral_time / design(p, LOW).integral_time for p in SIX}
    k = {p: design(p, HIGH).k / design(p, LOW).k for p in SIX}
    furthest = min(STABLE, key=lambda plant: ti[plant])
    holds = min(k.values()) > 1.4 and 0.75 < ti[furthest] < 1.0 and ti["G4"] < ti[furthest]
    return Finding(
        "holds" if holds else "fails",
        ti[furthest],
        f"From $M_s = 1.4$ to 2, $k$ grows by factors of {number(min(k.values()), 3)} to "
        f"{number(max(k.values()), 3)}, while $T_i$ of the stable plants falls by at most "
        f"{1.0 - ti[furthest]:.0%} ({furthest}); for $G_4$ by {1.0 - ti['G4']:.0%}.",
    )


@claims.claim(
    "mp-below-ms",
    "$M_p$ is smaller than $M_s$, except for $G_4$ with $M_s = 1.4$, where they are equal.",
    where="section 5.1",
    printed="1.40",
)
def mp_below_ms() -> Finding:
    above = [(p, ms) for p in SIX for ms in BOUNDS if complementary_peak(p, ms).value >= ms]
    peak = complementary_peak("G4", LOW).value
    equal = meets(f"{LOW:.2f}", peak)
    return Finding(
        "holds" if equal and not above else "holds-partly",
        peak,
        f"$M_p \\geq M_s$ in {len(above)} of {len(SIX) * len(BOUNDS)} designs. For $G_4$ with $M_s = 1.4$ it "
        f"is {number(peak)}: equal at the two decimals that Table 1 prints.",
    )


@claims.claim(
    "mp-near-one",
    "For $M_s = 1.4$, $M_p$ and therefore $b$ are close to 1 except for $G_4$.",
    where="section 5.1",
)
def mp_near_one() -> Finding:
    peaks = {plant: complementary_peak(plant, LOW).value for plant in STABLE}
    stated = {plant: weight(plant, LOW, "w_mp") for plant in STABLE}
    used = {plant: weight(plant, LOW, "w_0") for plant in STABLE}
    return Finding(
        "holds" if min(stated.values()) > 0.85 else "holds-partly",
        min(stated.values()),
        f"$M_p$ is at most {number(max(peaks.values()))}. The printed $b$ are at least "
        f"{number(min(used.values()), 3)}; by the rule of the text they are {listed(stated, 3)}, so that $b$ "
        "need not be near 1 when $M_p$ is.",
    )
