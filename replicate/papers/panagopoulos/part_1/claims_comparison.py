"""The checkable sentences of section 6: the comparison with Ziegler-Nichols and lambda tuning."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

from functools import cache

from replicate.exhibits import Finding
from replicate.exhibits.evidence import number, share
from replicate.loops import Loop, Signal
from replicate.papers.panagopoulos.part_1.claims_specifications import claims
from replicate.papers.panagopoulos.part_1.plants import PLANTS
from replicate.papers.panagopoulos.part_1.settling import two_sided
from replicate.papers.panagopoulos.part_1.simple_models import ultimate_point, ziegler_nichols
from replicate.papers.panagopoulos.part_1.table_5 import authors_controller, overshoot_of_peak, responses


@cache
def _responses(plant: str, method: str) -> tuple[Signal, Signal]:
    pi = authors_controller(plant, method)
    return responses(plant, pi.k, pi.ki, pi.b)


def _overshoot(plant: str, method: str, claimed: int) -> Finding:
    step, _ = _responses(plant, method)
    true, printed = 100.0 * step.overshoot(), 100.0 * overshoot_of_peak(step)
    return Finding(
        share([round(true) == claimed, round(printed) == claimed]).verdict,
        true,
        f"As in Table 5, of the overshoot divided by the peak, {number(printed, 3)} %, and not by the final value, as "
        "is "
        f"usual: the peak is {number(step.peak().value)}, an overshoot of {number(true, 3)} %.",
    )


@claims.claim("overshoot-g1-zn", "Ziegler–Nichols on $G_1$ overshoots by 36 %.", where="section 6", printed="36")
def overshoot_g1() -> Finding:
    return _overshoot("G1", "ZN", 36)


@claims.claim("overshoot-g2-zn", "Ziegler–Nichols on $G_2$ overshoots by 47 %.", where="section 6", printed="47")
def overshoot_g2() -> Finding:
    return _overshoot("G2", "ZN", 47)


@claims.claim("overshoot-g3-lambda", "Lambda tuning on $G_3$ overshoots by 21 %.", where="section 6", printed="21")
def overshoot_g3() -> Finding:
    return _overshoot("G3", "Lambda", 21)


@claims.claim(
    "ms-g2-zn",
    "Ziegler–Nichols on $G_2$ is close to the stability limit, $M_s = 11$.",
    where="section 6",
    printed="11",
)
def ms_g2() -> Finding:
    peak = Loop(PLANTS["G2"], ziegler_nichols("G2")).sensitivity_peak().value
    return Finding("holds" if round(peak) == 11 else "fails", peak, f"$M_s$ = {number(peak)}.")


@claims.claim(
    "lambda-g1-slower",
    "On $G_1$ settling time and IAE of lambda tuning are three times those of the new design.",
    where="section 6",
    printed="3",
)
def lambda_g1() -> Finding:
    (_, sluggish), (_, new) = _responses("G1", "Lambda"), _responses("G1", "New")
    iae, settling = sluggish.iae() / new.iae(), two_sided(sluggish) / two_sided(new)
    return Finding(
        "holds" if round(iae) == round(settling) == 3 else "holds-partly",
        iae,
        f"IAE is {number(iae, 3)} times as large, the settling time to $\\pm 5$ % {number(settling, 3)} times as long.",
    )


@claims.claim(
    "lambda-g2-slower",
    "On $G_2$ IAE and settling time of lambda tuning are almost a magnitude larger than those of the new design.",
    where="section 6",
)
def lambda_g2() -> Finding:
    (_, sluggish), (_, new) = _responses("G2", "Lambda"), _responses("G2", "New")
    iae, settling = sluggish.iae() / new.iae(), two_sided(sluggish) / two_sided(new)
    return Finding(
        "holds" if min(iae, settling) > 5.0 else "holds-partly",
        iae,
        f"IAE is {number(iae, 3)} times as large, the settling time to $\\pm 5$ % {number(settling, 3)} times as long.",
    )


@claims.claim(
    "zn-g3",
    "On $G_3$ Ziegler–Nichols has too high a gain, too long an integral time, a large $M_s$ and a very long "
    "settling time.",
    where="section 6",
)
def zn_g3() -> Finding:
    zn, new = ziegler_nichols("G3"), authors_controller("G3", "New")
    peak = Loop(PLANTS["G3"], zn).sensitivity_peak().value
    (_, load), (_, other) = _responses("G3", "ZN"), _responses("G3", "New")
    return Finding(
        "holds-partly",
        peak,
        f"Gain and integral time are {number(zn.k / new.k, 3)} and {number(zn.integral_time / new.integral_time, 3)} "
        f"times those of the new design, the settling time {number(two_sided(load) / two_sided(other), 3)} times. But "
        f"$M_s$ = {number(peak, 3)} is not large: the loop is sluggish, not close to instability.",
    )


@claims.claim(
    "k-zero-zn",
    "Ziegler–Nichols gives $k = 0$ for $e^{-s}$.",
    where="section 6",
    printed="0",
)
def k_zero_zn() -> Finding:
    gain, period = ultimate_point("G7")
    pi = ziegler_nichols("G7")
    return Finding(
        "holds" if pi.k == 0.0 else "undecided",
        pi.k,
        "The sentence does not say which of the two methods it means. By the step-response method $k$ is 0.9 over dead "
        "time times steepest slope, which goes to zero as the step response becomes steeper. By the "
        f"frequency-response method, that of Table 5, $e^{{-s}}$ has $K_u$ = {number(gain)} and $T_u$ = "
        f"{number(period)}, and so $k$ = {number(pi.k)}, $T_i$ = {number(pi.integral_time)}.",
    )


@claims.claim("k-zero-lambda", "Lambda tuning gives $k = 0$ for $e^{-s}$.", where="section 6", printed="0")
def k_zero_lambda() -> Finding:
    return Finding(
        "holds",
        0.0,
        "A pure dead time has the time constant $T = 0$, and $k = T/(L + 3T)$ vanishes with it; what is left "
        "is an integral controller with $k_i = 1/L$.",
    )
