"""The checkable sentences of paper VI."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

import numpy as np

from replicate.exhibits import Finding
from replicate.loops import PI, Loop, Plant
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.parts_3_to_6.active_damping import (
    EXAMPLE,
    EXAMPLE_EQ_3,
    K_B,
    PI_GAIN,
    PI_INTEGRAL_TIME,
    ZETA_B,
    allpass,
    bandpass,
    damping_ratio,
    k_b_from,
)
from replicate.papers.panagopoulos.parts_3_to_6.damping_batch import OMEGA_P, batch, fit, impulse_iae, of
from replicate.papers.panagopoulos.wording import number

claims = paper.claims("VI-claims", "Claims made in the text of paper VI")

W = np.geomspace(1e-3, 1e3, 4001)
ROUNDING = 1e-10


def _pi_loop(k_b: float) -> Loop:
    return Loop(EXAMPLE.damped(k_b), PI.from_integral_time(PI_GAIN, PI_INTEGRAL_TIME))


@claims.claim("allpass", "$F_a$ changes only the phase, at all frequencies.", where="“The New Approach”, Figure 4")
def all_pass() -> Finding:
    num, den = allpass(EXAMPLE.omega_a, 0.5)
    off = float(np.max(np.abs(np.abs(np.polyval(num, 1j * W) / np.polyval(den, 1j * W)) - 1.0)))
    return Finding(
        "holds" if off < ROUNDING else "fails", round(off, 12), "$|F_a|$ is one for every frequency and damping."
    )


@claims.claim("bandpass", "$F_b$ has no phase at its centre frequency.", where="“The New Approach”, Figure 4")
def band_pass() -> Finding:
    num, den = bandpass(EXAMPLE.omega_p, ZETA_B, 1.0)
    w = EXAMPLE.omega_p * np.array([0.9, 1.0, 1.1])
    phase = np.degrees(np.angle(np.polyval(num, 1j * w) / np.polyval(den, 1j * w)))
    return Finding(
        "holds" if abs(phase[1]) < 1e-9 else "fails",
        round(float(phase[1]), 9) + 0.0,
        f"There it is exactly zero; 10 % beside it, it is {number(phase[0], 3)} and {number(phase[2], 3)} degrees.",
    )


@claims.claim(
    "phase",
    "The choice of $\\omega_a$ makes the phase of $PF$ at $\\omega_p$ equal to $-360°$.",
    where="(4)",
    printed="-360",
)
def phase() -> Finding:
    w = np.geomspace(1e-4, EXAMPLE.omega_p, 20_001)
    num, den = allpass(EXAMPLE.omega_a, 0.5)
    values = EXAMPLE.plant(1j * w) * np.polyval(num, 1j * w) / np.polyval(den, 1j * w)
    angle = float(np.degrees(np.unwrap(np.angle(values)))[-1])
    return Finding(
        "holds" if abs(angle + 360.0) < 1e-8 else "fails",
        round(angle, 9),
        f"Followed from zero frequency, $\\arg P + \\arg F_a$ arrives at {number(angle, 9)}° for $\\omega_a$ = "
        f"{number(EXAMPLE.omega_a, 6)}. The inner loop is $P/(1+PF)$, so this is the phase that weakens the "
        "output most.",
    )


@claims.claim(
    "half", "The filter reduces the gain at the resonance at the most to half of $P_{max}$.", where="(8)", printed="0.5"
)
def half() -> Finding:
    s = 1j * EXAMPLE.omega_p
    gains = {k_b: float(abs(EXAMPLE.damped(k_b)(s))) / EXAMPLE.p_max for k_b in (1.0, K_B)}
    return Finding(
        "holds-partly",
        gains[1.0],
        f"With (6) the gain at $\\omega_p$ is {number(gains[1.0])} of $P_{{max}}$: (8) is an equality there, "
        f"because $PF = 1$ is real. With the refined (9) it is $1/(1+k_b)$ = {number(gains[K_B])} in the "
        "example, below the “bound”, which assumes $k_b = 1$.",
    )


@claims.claim("fb-at-resonance", "$|F_b(i\\omega_p)| = K_b/2\\zeta_b = 1/P_{max}$.", where="above (8)")
def fb_at_resonance() -> Finding:
    gain = EXAMPLE.band_gain(1.0)
    value = gain / (2.0 * ZETA_B)
    return Finding(
        "fails",
        value,
        f"$\\omega_p$ is missing: $K_b/2\\zeta_b$ = {number(value)}, $1/P_{{max}}$ = "
        f"{number(1.0 / EXAMPLE.p_max)}, and $K_b/(2\\zeta_b\\omega_p)$ = {number(value / EXAMPLE.omega_p)}. "
        "(6) has it.",
    )


@claims.claim(
    "structure", "The flexible shaft has the structure (3).", where="“Design of the Active Control System”, “Example”"
)
def structure() -> Finding:
    pi = PI.from_integral_time(PI_GAIN, PI_INTEGRAL_TIME)
    loop = Loop(EXAMPLE_EQ_3.plant, pi)
    return Finding(
        "fails",
        EXAMPLE.gain / EXAMPLE_EQ_3.gain,
        f"(3) has the numerator $\\omega_p^2$ = {number(EXAMPLE_EQ_3.gain)}, the example $\\kappa$ = "
        f"{number(EXAMPLE.gain)}. All printed numbers belong to $\\kappa$. With $\\omega_p^2$, $P_{{max}}$ "
        f"would be {number(EXAMPLE_EQ_3.p_max)}, and the PI loop without active control would be "
        f"{'stable' if loop.is_stable() else 'unstable'}. $PF$ does not depend on the numerator.",
    )


@claims.claim("notch", "A notch filter gives the mode no additional damping when a load excites it.", where="Figure 1")
def notch() -> Finding:
    mode = [1.0, 2.0 * EXAMPLE.zeta_p * EXAMPLE.omega_p, EXAMPLE.omega_p**2]
    broad = [1.0, 2.0 * EXAMPLE.omega_p, EXAMPLE.omega_p**2]
    plant = Plant(np.polymul(EXAMPLE.plant.num, mode), np.polymul(EXAMPLE.plant.den, broad))
    pi = PI.from_integral_time(PI_GAIN, PI_INTEGRAL_TIME)
    zeta = damping_ratio(Loop(plant, pi).poles(6))
    damped = damping_ratio(_pi_loop(K_B).poles(6))
    return Finding(
        "holds" if abs(zeta / EXAMPLE.zeta_p - 1.0) < 1e-6 else "fails",
        zeta,
        "With a notch that cancels the mode and the example's PI controller, the closed loop keeps a mode of damping "
        f"{number(zeta)}, the process's own; with active control the smallest damping is {number(damped)}.",
    )


@claims.claim("zeta-a", "The performance is quite insensitive to $\\zeta_a$.", where="“The Allpass Filter Design”")
def zeta_a() -> Finding:
    found = {zeta: damping_ratio(EXAMPLE.damped(K_B, zeta_a=zeta).poles()) for zeta in (0.2, 0.3, 0.5, 0.8, 1.2)}
    inner = [found[zeta] for zeta in (0.3, 0.5, 0.8)]
    return Finding(
        "holds" if max(inner) < 1.2 * min(inner) else "fails",
        max(inner) / min(inner),
        "In the example the smallest damping ratio of the inner loop is "
        f"{', '.join(f'{number(value, 3)} (for {zeta:g})' for zeta, value in found.items())}; the chosen 0.5 "
        "is the best of them.",
    )


@claims.claim("zeta-b", "Relatively large values of $\\zeta_b$ perform best.", where="“The Bandpass Filter Design”")
def zeta_b() -> Finding:
    found = {zeta: damping_ratio(EXAMPLE.damped(K_B, zeta_b=zeta).poles()) for zeta in (0.1, 0.3, 0.6, 0.9, 1.5)}
    return Finding(
        "holds" if found[0.9] > 0.95 * max(found.values()) else "fails",
        found[0.9],
        "In the example the smallest damping ratio of the inner loop is "
        f"{', '.join(f'{number(value, 3)} (for {zeta:g})' for zeta, value in found.items())}: flat from about 0.6 on.",
    )


@claims.claim("k-b", "(10) gives $k_b = 2.75$ for the flexible shaft.", where="“Example”", printed="2.75")
def k_b() -> Finding:
    value = k_b_from(EXAMPLE.ratio)
    spread = 0.005 * (1.0 + EXAMPLE.ratio)
    return Finding(
        "holds-partly" if abs(value - K_B) <= spread else "fails",
        value,
        f"It gives {number(value)}. The rounding of its coefficients leaves an uncertainty of "
        f"{number(spread, 2)}, so that the print is possible with unrounded ones.",
    )


@claims.claim("function-of-ratio", "The best $k_b$ is a function of $P_{max}/P_{min}$.", where="(9), (10), Figure 6")
def function_of_ratio() -> Finding:
    slopes = {omega_p: fit(of(omega_p)) for omega_p in OMEGA_P}
    worst = max(line.largest_residual for line in slopes.values())
    return Finding(
        "holds-partly",
        slopes[OMEGA_P[-1]].slope - slopes[OMEGA_P[0]].slope,
        f"On our batch it is, for each $\\omega_p$, nearly linear in the ratio (within {number(worst, 2)}), "
        f"with a negative intercept. But the slope grows from {number(slopes[OMEGA_P[0]].slope, 3)} at "
        f"$\\omega_p$ = {OMEGA_P[0]:g} to {number(slopes[OMEGA_P[-1]].slope, 3)} at {OMEGA_P[-1]:g}: the ratio "
        "alone does not determine the gain.",
    )


@claims.claim("not-optimal", "(6) does not give the smallest IAE for all processes of a batch.", where="below (8)")
def not_optimal() -> Finding:
    above = [m for m in batch() if m.k_b > 1.0]
    worst = max(m.iae_by_formula_6 / m.iae for m in batch())
    return Finding(
        "holds" if 0 < len(above) < len(batch()) else "fails",
        worst,
        f"On our batch the best $k_b$ is above one for {len(above)} of {len(batch())} processes and below for "
        f"the others; $k_b = 1$ costs up to a factor {number(worst, 3)} in IAE.",
    )


@claims.claim("iae", "The IAE measures how well the filter performs.", where="below (8)")
def iae() -> Finding:
    values = {k: impulse_iae(EXAMPLE, k) for k in (0.0, 1.0, K_B)}
    return Finding(
        "fails" if values[0.0] <= min(values.values()) else "holds",
        values[K_B] - values[0.0],
        "In the example the slow decay dominates: the IAE of an impulse is "
        f"{number(values[0.0], 5)} without active control, {number(values[1.0], 5)} with $k_b = 1$ and "
        f"{number(values[K_B], 5)} with $k_b = 2.75$. It cannot be less than $P(0)$ = "
        f"{number(EXAMPLE.plant.gain, 5)}, which an output without sign change has, however much it "
        "oscillates. For a load step it is infinite: $F(0) = 0$.",
    )


@claims.claim("improves-pulse", "Active control improves the response to a pulse.", where="“Example”, Figure 7")
def improves_pulse() -> Finding:
    before, after = (damping_ratio(EXAMPLE.damped(k).poles()) for k in (0.0, K_B))
    return Finding(
        "holds" if after > before else "fails",
        after,
        f"The smallest damping ratio rises from {number(before, 3)} to {number(after, 3)}. The inner loop is "
        f"stable up to $k_b$ = {number(EXAMPLE.largest_stable_gain())}.",
    )


@claims.claim(
    "improves-loop",
    "With active control the closed loop with the PI controller is well damped.",
    where="“Example”, Figure 8",
)
def improves_loop() -> Finding:
    loops = [_pi_loop(k) for k in (0.0, K_B)]
    zeta = [damping_ratio(loop.poles(6)) for loop in loops]
    ms = [loop.sensitivity_peak().value for loop in loops]
    return Finding(
        "holds" if ms[1] < 1.4 and zeta[1] > 10.0 * zeta[0] else "holds-partly",
        ms[1],
        f"$M_s$ falls from {number(ms[0])} to {number(ms[1])}, and the smallest damping ratio rises from "
        f"{number(zeta[0], 2)} to {number(zeta[1], 3)}. Both loops are stable.",
    )
